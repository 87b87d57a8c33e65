#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/drawing/canvas.hpp"
#include "compiler/measure/rehearsal.hpp"
#include "compiler/preview/exhibit.hpp"
#include "wale/program.hpp"
#include "wale/result.hpp"

namespace wale {

/// The words of a preview. Words that are too long for their place end in an ellipsis.
struct PreviewText {
  /// One figure of the strip at the foot: a word and, larger, its value: "roughness", "0.60".
  struct Figure {
    std::string word;
    std::string value;
  };
  std::string title;            ///< "Wide-wale corduroy"
  std::string names;            ///< one line below the title, "corduroy · deep wale corduroy · ribbed cotton"
  std::vector<Figure> figures;  ///< up to six are shown
  std::string evidence;         ///< one line at the very foot: the evidence and the source of each percept
  /// The level of the strongest percept that a force down the slopes of a relief carries; empty if there is none.
  std::optional<double> felt;
};

/// A drawn material.
struct Preview {
  std::unique_ptr<Canvas> page;
  /// The side, in pixels of a placed picture (`Canvas::fineness`), of the squares in which the surface is drawn: 1
  /// unless the program costs so much that each pixel of its own would take minutes.
  int coarseness = 1;
};

/// What a person chooses of a picture.
struct PreviewChoice {
  SectionChoice section;
  std::optional<double> seconds;  ///< of the hand's rubbing and of the spectrum; by default one to five, and two
  bool small = false;             ///< the surface and its force alone, without words
};

/// The words that the program itself gives: title and names of its representative layer, the level of each percept, the
/// maximum force, its wall if it has one, and the parameters at the bank's values, and the evidence of its maps. The
/// maximum force is always among the first six figures, and a last one says how many are left out.
PreviewText preview_text(const Bank& bank, const Declarations& declarations);

/// A picture of a material, 1600 x 1330 pixels: shaded relief with a scale bar; height and force along a line; the
/// words; and the spectrum and the spectrogram of the whole force on a hand that strokes to and fro along that line. A
/// pad has no spectrum, nor has a program whose force on such a hand does not change, and then the foot says so; their
/// page is 1600 x 1000 pixels.
///
/// A program with a constant relief shows its force field as arrows instead; one that only resists motion shows the
/// force against velocity. A program with colours, marks or memory always shows its surface. With marks or memory, a
/// simulated hand has rubbed it for a short time before; with memory, the page also shows the hand and its force over
/// that time. Forces are the commanded ones, in N or mN. A relief is drawn the steeper the stronger it is
/// felt. The same bank, text and choice give the same pixels. A small picture, for a page that says the rest, has the
/// surface or the field and the plot of the force beside it, in 760 x 300 pixels.
///
/// Error: `Code::missing_library`.
Result<Preview> draw_preview(const Bank& bank, const PreviewText& text, const Declarations& declarations,
                             const PreviewChoice& choice = {});

/// A plot of a preview on a page of its own, 560 x 280 pixels.
struct PlotPage {
  std::string name;   ///< "height", "force", "velocity", "shaking", "hand", "time", "spectrum": once in a preview
  std::string title;  ///< "Force along x"
  std::unique_ptr<Canvas> page;
};

/// What a preview is made of, for a page that has a layout of its own.
struct PreviewParts {
  Exhibit exhibit;
  Rehearsal rehearsal;              ///< after which the picture was taken
  bool surface = false;             ///< the picture is the lit surface; otherwise it is the field of the force
  std::unique_ptr<Canvas> picture;  ///< 320 x 320 pixels, without words
  std::vector<PlotPage> plots;
};

/// Draws them as `draw_preview` does; `felt` is that of its text. Error: `Code::missing_library`.
Result<PreviewParts> draw_preview_parts(const Bank& bank, std::optional<double> felt, const Declarations& declarations);

}  // namespace wale
