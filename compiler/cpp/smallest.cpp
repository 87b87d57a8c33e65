#include "compiler/cpp/smallest.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wale {
namespace {

constexpr float least_normal_float = std::numeric_limits<float>::min();

/// The greatest float up to `bound`, or 0 where that would be far below all subnormal numbers.
float rounded_down(double bound) {
  if (bound < 0x1p-149) return 0;
  const auto near = static_cast<float>(bound);
  return static_cast<double>(near) <= bound ? near : std::nextafter(near, 0.0f);
}

/// Two values of nearly the same size leave a multiple of half the last place of the larger; otherwise the result is at
/// least half as large as the larger one.
float smallest_sum(const Smallest& a, const Smallest& b) {
  float size = rounded_down(std::max(double{a.size}, double{b.size}) * 0x1p-25);
  if (a.maybe_zero) size = std::min(size, b.size);
  if (b.maybe_zero) size = std::min(size, a.size);
  return size;
}

float smallest_quotient(const Smallest& a, const Interval& divisor) {
  const double most = std::min(double{divisor.largest()}, double{std::numeric_limits<float>::max()});
  if (most == 0) return a.size;
  const double size = a.size / most;
  return rounded_down(std::fma(size, most, -double{a.size}) == 0 ? size : std::nextafter(size, 0.0));
}

}  // namespace

Smallest Smallest::of(float value) {
  if (std::isnan(value)) return {};
  return value == 0 ? Smallest{.size = std::numeric_limits<float>::max()}
                    : Smallest{.size = std::abs(value), .maybe_zero = false};
}

Smallest Smallest::within(const Interval& interval) const {
  if (interval.has_zero()) return *this;
  return {std::max(size, interval.low > 0 ? interval.low : -interval.high), false};
}

float smallest_result(Operation operation, const SizedOperand& a, const SizedOperand& b, const SizedOperand& c) {
  switch (operation) {
    case Operation::add:
    case Operation::subtract: return smallest_sum(a.smallest, b.smallest);
    case Operation::multiply: return rounded_down(double{a.smallest.size} * b.smallest.size);
    case Operation::divide: return smallest_quotient(a.smallest, b.interval);
    case Operation::negate:
    case Operation::absolute: return a.smallest.size;
    case Operation::minimum:
    case Operation::maximum:
    case Operation::limit: return std::min(a.smallest.size, b.smallest.size);
    case Operation::select: return std::min(b.smallest.size, c.smallest.size);
    case Operation::floor:
    case Operation::less: return 1;
    case Operation::square_root: return rounded_down(std::sqrt(double{a.smallest.size}) * (1 - 0x1p-40));
    case Operation::hash: return 0x1p-24f;
    default: return least_normal_float;
  }
}

}  // namespace wale
