#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "schema/patch_program.hpp"

namespace wale {

/// A figure with the digits that single precision holds: 0.6, not 0.60000002384.
inline double figure(double value) { return std::isfinite(value) ? std::stod(fmt::format("{:.6g}", value)) : value; }

/// A parameter's value in its author's unit.
inline double shown(float value, double unit_in_si) { return figure(value / unit_in_si); }

/// What the cells of a memory take on the device.
inline std::size_t bytes_of(const Grid& grid) { return std::size_t{grid.columns} * grid.rows * sizeof(float); }

/// Each line of a documentation comment on a line of its own, `columns` from the left.
inline void write_documentation(std::string& text, std::size_t columns, const std::string& documentation) {
  for (std::size_t at = 0; at < documentation.size();) {
    const std::size_t end = std::min(documentation.find('\n', at), documentation.size());
    text += std::string(columns, ' ') + documentation.substr(at, end - at) + '\n';
    at = end + 1;
  }
}

}  // namespace wale
