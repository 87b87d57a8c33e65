#pragma once

#include <string>
#include <vector>

#include "compiler/image/drawing.hpp"
#include "wale/program.hpp"

namespace wale {

/// The words of a preview; what has no room is shortened with an ellipsis.
struct PreviewText {
  /// One figure of the strip at the foot: a word and, larger, its value: "roughness", "0.60".
  struct Figure {
    std::string word;
    std::string value;
  };
  std::string title;            ///< "Wide-wale corduroy"
  std::string names;            ///< one line below the title, "corduroy · deep wale corduroy · ribbed cotton"
  std::vector<Figure> figures;  ///< up to six are shown
  std::string evidence;         ///< one line at the very foot: on what evidence the percepts stand, and their source
};

/// What the program itself knows to say: title and names of its representative layer, each percept's level, the maximum
/// force and the parameters at the bank's values, and the evidence of its maps.
PreviewText preview_text(const Bank& bank);

/// The picture a designer would pin to the wall, 1600 x 1330: shaded relief with a scale bar, height and force along a
/// line through the centre, the words, and the spectrum and the spectrogram of the force on a hand that strokes to and
/// fro along that line. A pad, and what does not push such a hand, has no spectrum, and a page of 1600 x 1000.
///
/// A program whose relief is constant shows its force field as arrows instead; one that only resists motion shows the
/// force against velocity. A program that says colours, shows marks or remembers shows its surface whatever its relief;
/// the last two after a simulated hand has rubbed it for a short while, and one that remembers shows the hand and its
/// force over that time. Forces are those commanded, in N or mN. The same bank and text give the same pixels.
/// Throws `NoImageLibrary` (compiler/image/image_library.hpp).
Drawing draw_preview(const Bank& bank, const PreviewText& text);

}  // namespace wale
