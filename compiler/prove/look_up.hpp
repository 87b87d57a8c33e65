#pragma once

#include <array>

#include "compiler/prove/interval.hpp"
#include "runtime/machine/spline.hpp"
#include "schema/patch_program.hpp"

namespace wale {

/// The ranges of the results of one instruction; those that it does not have are zero.
using ResultRanges = std::array<Interval, 3>;

/// What `sample` can find in one table.
///
/// The value of a B-spline is a mean of its coefficients, and its derivative along an axis one of the differences of
/// neighbours, so that their extremes bound both; what the machine's rounding may add is stated with them.
class TableRanges {
 public:
  /// Reads all coefficients. `spline` outlives this.
  explicit TableRanges(const Spline& spline);

  /// For coordinates in `a` and `b`. Where these keep to a part of the table that has few samples, its own extremes.
  ResultRanges at(const Interval& a, const Interval& b) const;

 private:
  struct Rectangle {
    std::size_t first_column, columns, first_row, rows;
  };
  ResultRanges extremes(const Rectangle& part, bool may_run_backwards) const;

  const Spline& spline_;
  double largest_;  ///< size of a coefficient
  ResultRanges whole_;
};

/// What `recall` can find in a grid whose cells are within its bounds. Differences of bounds so far apart that they
/// overflow may come out as anything.
ResultRanges recall_ranges(const Grid& grid);

/// What `cell` can find.
Interval cell_range(const Grid& grid);

}  // namespace wale
