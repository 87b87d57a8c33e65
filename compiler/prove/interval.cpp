#include "compiler/prove/interval.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "compiler/prove/rounding.hpp"
#include "runtime/machine/arithmetic.hpp"
#include "runtime/machine/single.hpp"

namespace wale {
namespace {

using arithmetic::infinity;
using arithmetic::least_normal;

constexpr float most = std::numeric_limits<float>::max();
constexpr float pi = 3.14159274f;  // the float, which is above pi: the largest result of `arctangent_of`

// A result slightly below the least normal number may round up to it before it is flushed, so an end at that number may
// also be zero.
float low_end(float low) { return low > 0 && low <= least_normal ? 0.0f : low; }
float high_end(float high) { return high < 0 && high >= -least_normal ? 0.0f : high; }

/// From the least to the greatest of `values` without not-a-number. At least one must be a number.
Interval hull_of(std::initializer_list<float> values, bool maybe_nan) {
  float low = infinity, high = -infinity;
  for (const float value : values) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  if (low > high) return {0, 0, true};
  return Interval::between(low, high, maybe_nan);
}

/// For a function that is monotonic within an error: `value` at each end of the operand.
Interval spread(float at_low, float at_high, double relative, double absolute, bool maybe_nan) {
  const double low = static_cast<double>(at_low) - (std::abs(static_cast<double>(at_low)) * relative + absolute);
  const double high = static_cast<double>(at_high) + (std::abs(static_cast<double>(at_high)) * relative + absolute);
  return Interval::between(std::isinf(at_low) ? at_low : rounded_down(low),
                           std::isinf(at_high) ? at_high : rounded_up(high), maybe_nan);
}

Interval within(const Interval& a, float low, float high) {
  return {std::clamp(a.low, low, high), std::clamp(a.high, low, high), a.maybe_nan};
}

/// Twice the stated errors of the machine's functions, and a little for sums of them here.
constexpr double sine_error = 2 * 1.5e-7 * 1.01;
constexpr double exp2_error = 2 * 2e-7 * 1.01;
constexpr double log2_error = 2 * 2e-7 * 1.01;
constexpr double normal_error = 2 * 2e-7 * 1.01;
constexpr double arctangent_error = 2 * 2e-7 * 1.01;

/// Sine, or cosine with a shift of a quarter turn.
Interval wave(const Interval& a, float (*of)(float), double quarter_turns) {
  constexpr double turn = 6.283185307179586;
  constexpr float exact_below = 1e4f;  // rad: the error is stated below this
  const bool maybe_nan = a.maybe_nan || a.has_infinity();
  if (a.low < -exact_below || a.high > exact_below) return {-1, 1, maybe_nan};
  // Crests are at whole numbers of `phase`, troughs half a turn later. A crest that is missed because of the rounding
  // of `phase` is within the added error of its neighbour.
  const double from = a.low / turn + quarter_turns / 4 - 0.25, to = a.high / turn + quarter_turns / 4 - 0.25;
  const bool crest = std::floor(to) > std::floor(from) || std::floor(from) == from;
  const bool trough = std::floor(to - 0.5) > std::floor(from - 0.5) || std::floor(from - 0.5) == from - 0.5;
  const float first = of(a.low), last = of(a.high);
  Interval ends = spread(std::min(first, last), std::max(first, last), 0, sine_error, maybe_nan);
  if (crest) ends.high = 1;
  if (trough) ends.low = -1;
  return within(ends, -1, 1);
}

}  // namespace

Interval Interval::of(float value) {
  if (value != value) return {0, 0, true};
  return std::abs(value) < least_normal ? Interval{0, 0, false} : Interval{value, value, false};
}

Interval Interval::between(float low, float high, bool maybe_nan) { return {low_end(low), high_end(high), maybe_nan}; }

Interval Interval::everything(bool maybe_nan) { return {-infinity, infinity, maybe_nan}; }

bool Interval::is_finite() const { return low >= -most && high <= most; }

bool Interval::contains(float value) const {
  if (value != value) return maybe_nan;
  const float seen = std::abs(value) < least_normal ? 0.0f : value;
  return low <= seen && seen <= high;
}

Interval hull(const Interval& a, const Interval& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high), a.maybe_nan || b.maybe_nan};
}

Interval intersection(const Interval& a, const Interval& b) {
  const float low = std::max(a.low, b.low), high = std::min(a.high, b.high);
  if (low > high) return {0, 0, a.maybe_nan && b.maybe_nan};
  return {low, high, a.maybe_nan && b.maybe_nan};
}

std::string shown(const Interval& interval) {
  const std::string nan = interval.maybe_nan ? " or nan" : "";
  if (interval.low == interval.high) return fmt::format("{:.6g}{}", interval.low + 0.0f, nan);
  return fmt::format("{:.6g} .. {:.6g}{}", interval.low + 0.0f, interval.high + 0.0f, nan);  // no negative zeros
}

namespace ranges {

Interval sum(const Interval& a, const Interval& b) {
  const bool opposite =
      (a.high == infinity && b.low == -infinity) || (a.low == -infinity && b.high == infinity);  // inf - inf
  const float low = a.low + b.low, high = a.high + b.high;
  return Interval::between(low == low ? low : -infinity, high == high ? high : infinity,
                           a.maybe_nan || b.maybe_nan || opposite);
}

Interval difference(const Interval& a, const Interval& b) { return sum(a, negative(b)); }

Interval product(const Interval& a, const Interval& b) {
  const bool maybe_nan = a.maybe_nan || b.maybe_nan || (a.has_zero() && b.has_infinity()) ||
                         (b.has_zero() && a.has_infinity());  // 0 * inf
  // If an end is 0 * inf, the finite values next to the infinity give 0.
  const auto end = [](float x, float y) { return x == 0 || y == 0 ? 0.0f : x * y; };
  return hull_of({end(a.low, b.low), end(a.low, b.high), end(a.high, b.low), end(a.high, b.high)}, maybe_nan);
}

Interval square(const Interval& a) {
  const Interval size = magnitude(a);
  return Interval::between(size.low * size.low, size.high * size.high, size.maybe_nan);
}

Interval quotient(const Interval& a, const Interval& b) {
  if (b.has_zero()) return Interval::everything(true);
  const bool maybe_nan = a.maybe_nan || b.maybe_nan || (a.has_infinity() && b.has_infinity());  // inf / inf
  // If an end is inf / inf, finite values next to one infinity over the other give 0.
  const auto end = [](float x, float y) { return std::isinf(x) && std::isinf(y) ? 0.0f : x / y; };
  return hull_of({end(a.low, b.low), end(a.low, b.high), end(a.high, b.low), end(a.high, b.high)}, maybe_nan);
}

Interval negative(const Interval& a) { return {-a.high, -a.low, a.maybe_nan}; }

Interval magnitude(const Interval& a) {
  if (a.low >= 0) return a;
  if (a.high <= 0) return negative(a);
  return {0, std::max(-a.low, a.high), a.maybe_nan};
}

Interval least(const Interval& a, const Interval& b) {
  return {std::min(a.low, b.low), b.maybe_nan ? a.high : std::min(a.high, b.high), a.maybe_nan};
}

Interval greatest(const Interval& a, const Interval& b) {
  return {b.maybe_nan ? a.low : std::max(a.low, b.low), std::max(a.high, b.high), a.maybe_nan};
}

Interval whole(const Interval& a) { return {floor_of(a.low), floor_of(a.high), a.maybe_nan}; }

Interval root(const Interval& a) {
  if (a.high < 0) return {0, 0, true};
  return Interval::between(square_root_of(std::max(a.low, 0.0f)), square_root_of(a.high), a.maybe_nan || a.low < 0);
}

Interval order(const Interval& a, const Interval& b) {
  if (a.low >= b.high) return Interval::of(0);
  if (a.high < b.low && !a.maybe_nan && !b.maybe_nan) return Interval::of(1);
  return {0, 1, false};
}

Interval choice(const Interval& a, const Interval& b, const Interval& c) {
  if (!a.has_zero()) return b;
  if (a.low == 0 && a.high == 0 && !a.maybe_nan) return c;
  return hull(b, c);
}

Interval sine(const Interval& a) { return wave(a, sine_of, 0); }
Interval cosine(const Interval& a) { return wave(a, cosine_of, 1); }

Interval exp2(const Interval& a) {
  const Interval result = spread(exp2_of(a.low), exp2_of(a.high), exp2_error, 0, a.maybe_nan);
  return {std::max(result.low, 0.0f), result.high, result.maybe_nan};
}

Interval log2(const Interval& a) {
  return spread(log2_of(std::max(a.low, 0.0f)), log2_of(std::max(a.high, 0.0f)), log2_error, 0,
                a.maybe_nan || a.low < 0);
}

Interval normal(const Interval& a) {
  return within(spread(normal_of(a.low), normal_of(a.high), 0, normal_error, a.maybe_nan), 0, 1);
}

Interval limit(const Interval& a, const Interval& b) {
  const bool maybe_zero = a.maybe_nan || b.maybe_nan || b.low < 0;
  if (b.high < 0) return Interval::of(0);
  const auto held = [&](float value, float ceiling) { return std::clamp(value, -ceiling, ceiling); };
  const float lowest = std::max(b.low, 0.0f);
  const Interval result{held(a.low, a.low < 0 ? b.high : lowest), held(a.high, a.high > 0 ? b.high : lowest), false};
  return maybe_zero ? hull(result, Interval::of(0)) : result;
}

Interval arctangent(const Interval& a, const Interval& b) {
  const bool maybe_nan = a.maybe_nan || b.maybe_nan;
  const bool left = b.low < 0;
  if (a.has_zero() && b.has_zero()) {  // the box contains the origin, so all directions occur
    if (a.low < 0) return left ? Interval{-pi, pi, maybe_nan} : Interval{-pi / 2, pi / 2, maybe_nan};
    return {0, left ? pi : pi / 2, maybe_nan};
  }
  if (left && a.low < 0 && a.high >= 0) return {-pi, pi, maybe_nan};  // both sides of the jump of the angle
  // Otherwise the extremes of the angle over a box are at its corners.
  float low = infinity, high = -infinity;
  for (const float y : {a.low, a.high}) {
    for (const float x : {b.low, b.high}) {
      const float angle = arctangent_of(y, x);
      low = std::min(low, angle);
      high = std::max(high, angle);
    }
  }
  return within(spread(low, high, arctangent_error, 0, maybe_nan), -pi, pi);
}

Interval random() { return {0, 1 - 0x1p-24f, false}; }

}  // namespace ranges

Interval range_of(Operation operation, const Interval& A, const Interval& B, const Interval& C) {
  const int operands = facts(operation).operands;
  const bool points = A.is_point() && (operands < 2 || B.is_point()) && (operands < 3 || C.is_point());
  // The sign of a zero decides, and an interval does not know it.
  if (points && operands > 0 && operation != Operation::divide && facts(operation).fields[2] != 't' &&
      facts(operation).fields[2] != 'g') {
    return Interval::of(result_of(operation, A.low, B.low, C.low));
  }
  using namespace ranges;
  // clang-format off
  switch (operation) {
#define INSTRUCTION(number, name, fields, results, cost, meaning, range, derivative) \
  case Operation::name: return range;
#define SPECIAL(number, name, fields, results, cost) \
  case Operation::name: break;
#include "wale/instruction.def"
  }
  // clang-format on
  return Interval::everything(true);
}

}  // namespace wale
