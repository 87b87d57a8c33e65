#pragma once

#include <cmath>
#include <limits>

#include "compiler/prove/interval.hpp"

namespace wale {

/// The greatest float not above `value`, and the least not below it.
inline float rounded_down(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest > value ? std::nextafter(nearest, -std::numeric_limits<float>::infinity()) : nearest;
}
inline float rounded_up(double value) {
  const auto nearest = static_cast<float>(value);
  return nearest < value ? std::nextafter(nearest, std::numeric_limits<float>::infinity()) : nearest;
}

/// The smallest interval of floats that contains low .. high, both numbers.
inline Interval outward(double low, double high, bool maybe_nan = false) {
  return Interval::between(rounded_down(low), rounded_up(high), maybe_nan);
}

}  // namespace wale
