#pragma once

#include <string>
#include <string_view>

#include "compiler/declarations/declarations.hpp"
#include "wale/result.hpp"

namespace wale {

/// A measured relation with equal spacing: sample i is the value at `first + i * step`; all in SI.
struct MeasuredTable {
  Dimension from, to;
  double first = 0, step = 0;
  double low = 0, high = 0;  ///< values of the codes 0 and 65535
  HeightTable table;         ///< two equal rows
};

/// Reads comma-separated values whose first line names the columns and their units, `x (mm), force (N)`; a column
/// without a unit holds plain numbers. `from` and `to` name the columns; empty names mean the first and the second. The
/// places must rise from line to line. If they are not equally spaced, the table is resampled linearly. Errors: W0504,
/// with the line in `place.number` if a line is at fault.
Result<MeasuredTable> read_measured_table(std::string_view text, const std::string& from, const std::string& to,
                                          const Declarations& declarations);

}  // namespace wale
