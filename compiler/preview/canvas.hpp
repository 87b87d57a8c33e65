#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "compiler/image/image_library.hpp"
#include "compiler/preview/lettering.hpp"

namespace wale {

/// sRGB, 0 .. 1.
struct Colour {
  float red = 0, green = 0, blue = 0;
};

/// A mixture of two colours: `part` 0 is the first, 1 the second.
Colour mixed(Colour first, Colour second, float part);

/// A point of the page, in pixels from its upper left corner, y downwards.
using PagePoint = glm::dvec2;

struct PageBox {
  double left = 0, top = 0, right = 0, bottom = 0;
  double width() const { return right - left; }
  double height() const { return bottom - top; }
};

enum class Face { serif, sans };
enum class Align { left, centre, right };

/// The style of a text: letters of `size` pixels.
struct Type {
  Face face = Face::sans;
  double size = 18;
  Colour colour;
};

/// The style of a line. With a dash, `dash` pixels of line alternate with `dash` pixels of gap.
struct Pen {
  double width = 1.5;
  Colour colour;
  float opacity = 1;
  double dash = 0;
};

/// A page to draw on, twice as fine as the final drawing, which makes letters and lines smooth.
class Canvas {
 public:
  static constexpr int fineness = 2;  ///< canvas pixels per page pixel

  Canvas(int width, int height, Colour paper);

  void fill(const PageBox& box, Colour colour);
  void outline(const PageBox& box, const Pen& pen);
  /// A line through the points, with round joints. Where it crosses itself, opacity counts once.
  void stroke(std::span<const PagePoint> points, const Pen& pen);
  void line(PagePoint from, PagePoint to, const Pen& pen);
  /// The area between the points, given from left to right, and the height `base`.
  void shade(std::span<const PagePoint> points, double base, Colour colour, float opacity);
  /// The inside of a convex shape, given by its corners in either direction.
  void area(std::span<const PagePoint> corners, Colour colour, float opacity);
  /// Limits drawing to `box` until `unclip`.
  void clip(const PageBox& box);
  void unclip() { clip_ = {0, 0, width_, height_}; }
  /// A line of text with its baseline at `at.y`; nothing is drawn if no font is installed.
  void write(PagePoint at, std::string_view text, const Type& type, Align align = Align::left);
  /// The same, shortened with an ellipsis if it is wider than `width`.
  void write_within(PagePoint at, double width, std::string_view text, const Type& type, Align align = Align::left);
  double width_of(std::string_view text, const Type& type) const;
  /// The pixels of `box`, rows from the top, `fineness` to a page pixel each way.
  void place(const PageBox& box, std::span<const Colour> pixels);
  /// The same for a square box, of `side` * `side` squares, each of one colour.
  void place_squares(const PageBox& box, std::span<const Colour> squares, int side);

  /// The page as a drawing, reduced by `images`.
  Drawing finish(const ImageLibrary& images) const;

 private:
  const Font& font_of(const Type& type) const { return type.face == Face::serif ? serif_ : sans_; }
  void blend(int x, int y, Colour colour, float opacity);

  /// In canvas pixels; right and bottom are the first pixels outside.
  struct Clip {
    int left = 0, top = 0, right = 0, bottom = 0;
  };

  int width_ = 0, height_ = 0;  // canvas pixels
  Clip clip_;
  std::vector<float> pixels_;  // rows from the top, three channels
  Font serif_, sans_;
};

}  // namespace wale
