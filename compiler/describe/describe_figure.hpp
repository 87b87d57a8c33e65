#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/vec2.hpp>
#include <string>

#include "compiler/text/readable.hpp"
#include "wale/patch_program.hpp"

namespace wale {

/// A figure with the digits of single precision: 0.6, not 0.60000002384.
inline double figure(double value) {
  if (!std::isfinite(value)) return value;
  return std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr) + 0.0;  // no -0; stod throws at subnormals
}
/// A part of a direction, to six digits behind the point: less is rounding.
inline double direction_figure(double part) { return std::round(part * 1e6) / 1e6 + 0.0; }

/// A place or a force without the part along an axis that only rounding leaves: a millionth of its length.
inline glm::dvec2 without_rounding(glm::dvec2 whole) {
  constexpr double rounding = 1e-6;
  const double least = rounding * std::hypot(whole.x, whole.y);
  return {std::abs(whole.x) > least ? whole.x : 0, std::abs(whole.y) > least ? whole.y : 0};
}

/// `value` with so many decimals, and no minus before a number that rounds to zero.
inline std::string with_decimals(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.starts_with('-') && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

/// `value` with so many significant digits, as people write it: "1000", not "1e+03". No minus before zero.
inline std::string with_digits(double value, int digits) {
  return as_people_write(fmt::format("{:.{}g}", value + 0.0, digits), value);
}

/// "1 degree", "45 degrees".
inline std::string in_degrees(const std::string& number) { return number + (number == "1" ? " degree" : " degrees"); }

/// A value of a parameter in the unit that its author used.
inline double shown(float value, double unit_in_si) { return figure(value / unit_in_si); }

/// The size of a memory's cells on the device, in bytes.
inline std::size_t bytes_of(const Grid& grid) { return std::size_t{grid.columns} * grid.rows * sizeof(float); }

/// Each line of a documentation comment on its own line, indented by `columns`.
inline void write_documentation(std::string& text, std::size_t columns, const std::string& documentation) {
  for (std::size_t at = 0; at < documentation.size();) {
    const std::size_t end = std::min(documentation.find('\n', at), documentation.size());
    text += std::string(columns, ' ') + documentation.substr(at, end - at) + '\n';
    at = end + 1;
  }
}

}  // namespace wale
