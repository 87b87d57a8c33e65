#pragma once

#include <array>

#include "compiler/prove/interval.hpp"
#include "runtime/machine/spline.hpp"
#include "wale/patch_program.hpp"

namespace wale {

/// The ranges of the results of one instruction; unused ones are zero.
using ResultRanges = std::array<Interval, 3>;

/// The values that `sample` can read from one table.
///
/// The value of a B-spline is a weighted mean of its coefficients, and its derivative along an axis is a weighted mean
/// of the differences of neighbours, so their extremes bound both. The machine's rounding is added.
class TableRanges {
 public:
  /// Reads all coefficients. `spline` must outlive this object.
  explicit TableRanges(const Spline& spline);

  /// For coordinates in `a` and `b`. If these stay in a part of the table with few samples, the extremes of that part
  /// are used.
  ResultRanges at(const Interval& a, const Interval& b) const;

 private:
  struct Rectangle {
    std::size_t first_column, columns, first_row, rows;
  };
  ResultRanges extremes(const Rectangle& part, bool may_run_backwards) const;

  const Spline& spline_;
  double largest_;  ///< largest absolute coefficient
  ResultRanges whole_;
};

/// The values that `recall` can read from a grid whose cells are within its bounds. If the bounds are so far apart that
/// their difference overflows, the result may be any float.
ResultRanges recall_ranges(const Grid& grid);

/// The values that `cell` can read.
Interval cell_range(const Grid& grid);

}  // namespace wale
