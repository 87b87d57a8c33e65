#pragma once

#include <cstddef>
#include <cstdint>

#include "runtime/machine/arithmetic.hpp"

namespace wale {

/// A grid's cells among all cells of a program, row by row from the lower left. Each side has at least one cell.
struct GridShape {
  std::size_t first;  ///< its first cell
  std::uint32_t columns, rows;
};

/// A grid's value between four cells, and its derivatives along each coordinate, per cell.
struct GridSample {
  float value, along_a, along_b;
};

/// A coordinate between two neighbouring cells.
struct HeldCoordinate {
  std::uint32_t cell, next;  ///< 0 .. cells - 1
  float fraction;            ///< 0 at `cell`, 1 at `next`
  float slope;               ///< derivative of the clamped coordinate: 0 beyond the edges, else 1
};

/// `coordinate` clamped to the grid's edges; not-a-number counts as 0.
inline HeldCoordinate held(float coordinate, std::uint32_t cells) {
  const float last = static_cast<float>(cells - 1);
  const float least = coordinate > 0.0f ? coordinate : 0.0f;
  const float u = least < last ? least : last;
  const auto whole = static_cast<std::uint32_t>(static_cast<std::int32_t>(u));
  const std::uint32_t before_last = cells > 1 ? cells - 2 : 0;
  const std::uint32_t cell = whole < before_last ? whole : before_last;
  const bool within = coordinate >= 0.0f && coordinate <= last && cells > 1;
  return {cell, cells > 1 ? cell + 1 : cell, u - static_cast<float>(cell), within ? 1.0f : 0.0f};
}

/// The number of the cell nearest to `coordinate`, which is clamped to the edges; 0 for not-a-number.
inline std::uint32_t nearest(float coordinate, std::uint32_t cells) {
  const float last = static_cast<float>(cells - 1);
  const float least = coordinate > 0.0f ? coordinate : 0.0f;
  const float u = least < last ? least : last;
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(u + 0.5f));
}

/// The value between the four cells nearest to (a, b), in cells from the centre of the first one.
inline GridSample recall_of(const GridShape& shape, const float* cells, float a, float b) {
  const HeldCoordinate column = held(a, shape.columns);
  const HeldCoordinate row = held(b, shape.rows);
  const float* low = cells + shape.first + std::size_t{row.cell} * shape.columns;
  const float* high = cells + shape.first + std::size_t{row.next} * shape.columns;
  const float f = column.fraction, g = row.fraction;
  using namespace arithmetic;
  const auto between = [](float from, float to, float share) {
    return sum(product(1.0f - share, from), product(share, to));
  };
  const float below = between(low[column.cell], low[column.next], f);
  const float above = between(high[column.cell], high[column.next], f);
  const float across_below = difference(low[column.next], low[column.cell]);
  const float across_above = difference(high[column.next], high[column.cell]);
  return {between(below, above, g), column.slope * between(across_below, across_above, g),
          row.slope * difference(above, below)};
}

/// The index, among all cells of the program, of this grid's cell nearest to (a, b).
inline std::size_t cell_at(const GridShape& shape, float a, float b) {
  return shape.first + std::size_t{nearest(b, shape.rows)} * shape.columns + nearest(a, shape.columns);
}

}  // namespace wale
