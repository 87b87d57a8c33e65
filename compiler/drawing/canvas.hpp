#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/drawing/drawing.hpp"
#include "wale/result.hpp"

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

/// A page to draw on. What is drawn is kept as lines, letters and pictures, and becomes pixels or an SVG file at last.
/// A page belongs to one thread at a time.
class Canvas {
 public:
  static constexpr int fineness = 2;  ///< pixels of a placed picture for one of the page, each way

  virtual ~Canvas() = default;

  virtual void fill(const PageBox& box, Colour colour) = 0;
  void outline(const PageBox& box, const Pen& pen);
  /// A line through the points, with round joints. Where it crosses itself, opacity counts once.
  virtual void stroke(std::span<const PagePoint> points, const Pen& pen) = 0;
  void line(PagePoint from, PagePoint to, const Pen& pen);
  /// The area between the points, given from left to right, and the height `base`.
  void shade(std::span<const PagePoint> points, double base, Colour colour, float opacity);
  /// The inside of a shape, given by its corners in either direction.
  virtual void area(std::span<const PagePoint> corners, Colour colour, float opacity) = 0;
  /// Limits drawing to `box` until `unclip`.
  virtual void clip(const PageBox& box) = 0;
  virtual void unclip() = 0;
  /// A line of text with its baseline at `at.y`; nothing is drawn if no font is installed. Control characters are
  /// spaces, and bytes that are not UTF-8 question marks.
  virtual void write(PagePoint at, std::string_view text, const Type& type, Align align = Align::left) = 0;
  /// The same, shortened with an ellipsis if it is wider than `width`.
  virtual void write_within(PagePoint at, double width, std::string_view text, const Type& type,
                            Align align = Align::left) = 0;
  virtual double width_of(std::string_view text, const Type& type) const = 0;
  /// The pixels of `box`, rows from the top, `fineness` to a page pixel each way.
  void place(const PageBox& box, std::span<const Colour> pixels);
  /// The same for a square box, of `side` * `side` squares, each of one colour.
  void place_squares(const PageBox& box, std::span<const Colour> squares, int side);

  /// False if no font is installed (Debian: fonts-dejavu-core): the page is then complete but for its text.
  virtual bool has_text() const = 0;
  /// The page as pixels.
  virtual Drawing pixels() const = 0;
  /// The page as an SVG file, in which letters are shapes. The same drawing gives the same bytes.
  virtual std::vector<std::byte> svg() const = 0;

 private:
  /// A picture of `columns` by `rows` in a box; with `squares`, each of its pixels has sharp edges.
  virtual void place_picture(const PageBox& box, std::span<const Colour> pixels, int columns, int rows,
                             bool squares) = 0;
};

/// An empty page of this size in pixels. Error: `Code::missing_library`.
Result<std::unique_ptr<Canvas>> new_canvas(int width, int height, Colour paper);

/// The bytes of a picture file with this page in the format that the extension of `name` says: svg, or one of
/// `encode_drawing`, whose errors it has.
Result<std::vector<std::byte>> encode_page(const Canvas& page, const std::string& name);

}  // namespace wale
