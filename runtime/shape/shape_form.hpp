#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "wale/shape.hpp"

namespace wale {

/// Computes with doubles, by operations that IEEE 754 rounds alike everywhere. `edge` and `contains` are real-time,
/// as those of `Shape`.
class EllipseForm {
 public:
  /// Half axes, m, positive.
  EllipseForm(double half_width, double half_height) : half_(half_width, half_height) {}

  EdgeDistance edge(glm::dvec2 point) const noexcept;
  bool contains(glm::dvec2 point) const noexcept;
  glm::dvec2 half() const { return half_; }
  EllipseForm stretched(glm::dvec2 factors) const { return {half_.x * factors.x, half_.y * factors.y}; }

 private:
  glm::dvec2 half_;
};

class PolygonForm {
 public:
  /// Corners that `Shape::polygon` accepts.
  explicit PolygonForm(std::vector<glm::dvec2> corners);

  EdgeDistance edge(glm::dvec2 point) const noexcept;
  bool contains(glm::dvec2 point) const noexcept;
  const std::vector<glm::dvec2>& corners() const { return corners_; }
  PolygonForm stretched(glm::dvec2 factors) const;

 private:
  struct Side {
    glm::dvec2 from, along;  ///< m; its other end is from + along
    double inverse_square;   ///< 1 / length^2
    glm::dvec2 inward;       ///< unit vector
  };

  std::vector<glm::dvec2> corners_;
  std::vector<Side> sides_;
};

/// The cells of a mask, with a ring of cells around it that are not set, row by row from the lower left.
struct MaskCells {
  /// Bits that `Shape::mask` accepts.
  MaskCells(std::span<const std::uint8_t> bits, std::size_t columns, std::size_t rows);

  struct Cell {
    std::uint16_t first, last;  ///< columns of the run of equal cells in its row that it belongs to
    bool is_set;
  };
  const Cell& cell(std::size_t column, std::size_t row) const noexcept { return cells[row * wide + column]; }

  std::size_t wide, high;
  std::vector<Cell> cells;
};

class MaskForm {
 public:
  /// The width and height of a cell in m.
  MaskForm(std::shared_ptr<const MaskCells> cells, glm::dvec2 cell) : cells_(std::move(cells)), cell_(cell) {}

  EdgeDistance edge(glm::dvec2 point) const noexcept;
  bool contains(glm::dvec2 point) const noexcept;
  const MaskCells& cells() const { return *cells_; }
  glm::dvec2 cell_size() const { return cell_; }
  MaskForm stretched(glm::dvec2 factors) const {
    return {cells_, glm::dvec2(cell_.x * factors.x, cell_.y * factors.y)};
  }

 private:
  /// The column and row of the cell at a point, or of the nearest one.
  std::pair<std::size_t, std::size_t> cell_at(glm::dvec2 point) const noexcept;

  std::shared_ptr<const MaskCells> cells_;
  glm::dvec2 cell_;
};

struct ShapeForm {
  std::variant<EllipseForm, PolygonForm, MaskForm> form;
  glm::vec2 size;                           ///< m
  std::shared_ptr<const ShapeForm> origin;  ///< what it was stretched from, if it was
};

}  // namespace wale
