#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <variant>
#include <vector>

#include "wale/shape.hpp"

namespace wale {

/// What the makers of `Shape` take, m.
struct EllipseFigures {
  float half_width = 0, half_height = 0;
};
struct PolygonFigures {
  std::vector<glm::vec2> corners;
};
struct MaskFigures {
  std::vector<std::uint8_t> bits;  ///< row by row from the top left
  std::size_t columns = 0, rows = 0;
  float side = 0;
};
struct RectangleFigures {};
using ShapeFigures = std::variant<RectangleFigures, EllipseFigures, PolygonFigures, MaskFigures>;

/// The figures of a shape, before it was stretched. Allocates.
ShapeFigures figures_of(const Shape& shape);
/// The shape with these figures, which gives the same bits everywhere. Errors: those of its maker.
Result<Shape> shape_of(const ShapeFigures& figures);

}  // namespace wale
