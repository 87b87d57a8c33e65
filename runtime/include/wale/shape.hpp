#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <vector>

#include "wale/result.hpp"

namespace wale {

struct ShapeForm;

/// A point's distance to the edge of a shape, and how it changes.
struct EdgeDistance {
  float metres = 0;       ///< positive inside, negative outside
  glm::vec2 slope{0.0f};  ///< its change along x and y: towards the inside
};

/// What part of its rectangle a patch covers: all of it, an ellipse, a polygon, or the set bits of a mask. Coordinates
/// are in m from the patch's centre; y grows towards the top. Immutable; copies share it; any number of threads may use
/// it at once.
///
/// A shape has a size, that of the smallest rectangle around the patch's centre that holds it. On a patch of another
/// size it is stretched.
class Shape {
 public:
  static constexpr std::size_t most_corners = 256;
  static constexpr std::size_t most_along_a_side = 4096;  ///< cells of a mask

  /// The whole rectangle of the patch.
  Shape() = default;
  /// An ellipse with these half axes, m. Error: `malformed_value` if one is not positive, or more than 10 m.
  static Result<Shape> ellipse(float half_width, float half_height);
  /// A polygon, convex or not, in either sense of rotation. Errors: `malformed_value` for fewer than 3 corners or more
  /// than `most_corners`, a corner that is not finite or further than 10 m from the centre on an axis, an edge that
  /// touches another one except at their common corner, or two edges that go back on each other.
  static Result<Shape> polygon(std::span<const glm::vec2> corners);
  /// The set bits of a picture, row by row from the top left, each of which stands for a square with this side, m. The
  /// picture's middle is the patch's centre. Bits that only touch at a corner are joined there, for a hand that is
  /// exactly on it. Errors: `malformed_value` if there are not columns times rows bits, more than `most_along_a_side`
  /// in a row or column, or none is set, or the side is not positive, or the picture is more than 20 m wide or high.
  static Result<Shape> mask(std::span<const std::uint8_t> bits, std::size_t columns, std::size_t rows, float side);

  /// Whether it is the whole rectangle of any patch.
  bool is_rectangle() const noexcept { return form_ == nullptr; }
  /// Full width and height, m; 0 for a rectangle, which takes those of its patch.
  glm::vec2 size() const noexcept;
  /// This shape stretched to another width and height, m. It is the same shape if they are its own, or if they are not
  /// positive. Allocates; a mask shares its cells.
  Shape stretched(glm::vec2 size) const;

  /// The distance of a point to the edge. Not for a rectangle, which gives 0: its edges follow from its patch.
  ///
  /// It is exact but for the rounding of doubles, so it changes by no more than the way that the point goes (it is
  /// 1-Lipschitz), and `slope` is its derivative wherever it has one. The edge of a mask is that of its cells' squares.
  /// The same bits on every machine.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw. Its work is bounded: it looks
  /// at each side of a polygon, and at the rows of a mask that are not further than the edge.
  EdgeDistance edge(glm::vec2 point) const noexcept;
  /// Whether a point belongs to it: whether its distance is positive. Points on the edge itself may belong to it or
  /// not. Real-time as `edge`, and faster.
  bool contains(glm::vec2 point) const noexcept { return is_rectangle() || form_contains(point, size()); }
  /// Whether a point belongs to this shape stretched to a size: as `stretched(size).contains(point)`, bit for bit.
  bool contains(glm::vec2 point, glm::vec2 size) const noexcept { return is_rectangle() || form_contains(point, size); }
  /// The shape that this one was stretched from; else this one. Shapes that were stretched from one share it.
  Shape unstretched() const noexcept;
  /// Whether all points of a disc certainly belong to it. Real-time as `edge`.
  bool covers(glm::vec2 centre, float radius) const noexcept;

  /// The same for shapes that compare equal, and for no others that exist at the time.
  const void* identity() const noexcept { return form_.get(); }
  /// Whether both are the same value: copies of one, or both rectangles.
  friend bool operator==(const Shape&, const Shape&) = default;

  /// For the runtime itself.
  friend const ShapeForm* form_of(const Shape& shape) noexcept { return shape.form_.get(); }

 private:
  bool form_contains(glm::vec2 point, glm::vec2 size) const noexcept;
  explicit Shape(std::shared_ptr<const ShapeForm> form) : form_(std::move(form)) {}
  std::shared_ptr<const ShapeForm> form_;
};

}  // namespace wale
