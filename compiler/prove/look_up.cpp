#include "compiler/prove/look_up.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/prove/rounding.hpp"

namespace wale {
namespace {

/// Relative to the largest coefficient: the rounding of weights, products and sums. In each of two directions there are
/// four weights, each wrong by a few units in the last place of a float, four products and three sums: 22 units
/// together.
constexpr double table_rounding = 32 * 0x1p-24;
/// Relative to the largest cell: the same for two weights in each direction.
constexpr double grid_rounding = 16 * 0x1p-24;
/// The error from products and sums that are flushed to zero.
constexpr double flushed_sums = 32 * 1.1754943508222875e-38;
/// The most coefficients that are read for one instruction.
constexpr double most_coefficients = 4096;

}  // namespace

TableRanges::TableRanges(const Spline& spline) : spline_(spline), largest_(0) {
  for (const float coefficient : spline.coefficients) {
    largest_ = std::max(largest_, std::abs(static_cast<double>(coefficient)));
  }
  whole_ = extremes({0, spline.width + 3, 0, spline.height + 3}, true);
}

ResultRanges TableRanges::extremes(const Rectangle& part, bool may_run_backwards) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double low = infinity, high = -infinity;
  double low_a = infinity, high_a = -infinity, low_b = infinity, high_b = -infinity;
  for (std::size_t j = part.first_row; j < part.first_row + part.rows; ++j) {
    const float* row = spline_.coefficients.data() + j * spline_.stride;
    for (std::size_t i = part.first_column; i < part.first_column + part.columns; ++i) {
      const double c = row[i];
      low = std::min(low, c);
      high = std::max(high, c);
      if (i > part.first_column) {
        low_a = std::min(low_a, c - row[i - 1]);
        high_a = std::max(high_a, c - row[i - 1]);
      }
      if (j > part.first_row) {
        const double before = row[static_cast<std::ptrdiff_t>(i) - static_cast<std::ptrdiff_t>(spline_.stride)];
        low_b = std::min(low_b, c - before);
        high_b = std::max(high_b, c - before);
      }
    }
  }
  if (may_run_backwards) {
    high_a = std::max(high_a, -low_a);
    low_a = -high_a;
    high_b = std::max(high_b, -low_b);
    low_b = -high_b;
  }
  const double rounding = table_rounding * largest_ + flushed_sums;
  return {outward(low - rounding, high + rounding), outward(low_a - rounding, high_a + rounding),
          outward(low_b - rounding, high_b + rounding)};
}

ResultRanges TableRanges::at(const Interval& a, const Interval& b) const {
  const auto inside = [](const Interval& coordinate, std::uint32_t samples) {
    return !coordinate.maybe_nan && coordinate.low >= 0 && coordinate.high <= static_cast<float>(samples - 1);
  };
  if (!inside(a, spline_.width) || !inside(b, spline_.height)) return whole_;
  // Within the table the machine's computation of the cell is exact, and a cell has four coefficients on either axis.
  const auto first = [](float low) { return static_cast<std::size_t>(low); };
  const auto count = [](float low, float high) {
    return static_cast<std::size_t>(high) - static_cast<std::size_t>(low) + 4;
  };
  const Rectangle part{first(a.low), count(a.low, a.high), first(b.low), count(b.low, b.high)};
  if (static_cast<double>(part.columns) * static_cast<double>(part.rows) > most_coefficients) return whole_;
  return extremes(part, false);
}

ResultRanges recall_ranges(const Grid& grid) {
  const double low = grid.low, high = grid.high;
  const double rounding = grid_rounding * std::max(std::abs(low), std::abs(high)) + flushed_sums;
  const double difference = high - low + rounding;
  const bool overflows = difference + rounding > std::numeric_limits<float>::max();
  if (overflows) return {Interval::everything(true), Interval::everything(true), Interval::everything(true)};
  const Interval slope = outward(-difference, difference);
  return {outward(low - rounding, high + rounding), slope, slope};
}

Interval cell_range(const Grid& grid) { return Interval::between(grid.low, grid.high); }

}  // namespace wale
