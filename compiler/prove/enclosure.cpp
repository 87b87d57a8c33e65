#include "compiler/prove/enclosure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/prove/rounding.hpp"
#include "runtime/machine/arithmetic.hpp"

namespace wale {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();
/// Half a unit in the last place of a float, relative: the error of a correctly rounded operation.
constexpr double half_unit = 0x1p-24;
/// The size below which numbers may be flushed to zero, twice: for operands and results.
constexpr double flushed_operands = 2 * 1.1754943508222875e-38;
/// Relative to all figures of a form together: far more than the rounding of a few operations in double over a hundred
/// quantities.
constexpr double double_rounding = 0x1p-44;

constexpr double ln_2 = 0.69314718055994531;

/// scale_a a + scale_b b + offset, for the forms only. The result's rest does not include rounding yet.
Enclosure combined(const Enclosure& a, double scale_a, const Enclosure& b, double scale_b, double offset = 0) {
  Enclosure result;
  result.centre = scale_a * a.centre + scale_b * b.centre + offset;
  result.rest = std::abs(scale_a) * a.rest + std::abs(scale_b) * b.rest;
  for (std::size_t i = 0; i < quantities_limit; ++i) result.slopes[i] = scale_a * a.slopes[i] + scale_b * b.slopes[i];
  return result;
}

/// value + slope (a - at): a tangent of a smooth function.
Enclosure line(const Enclosure& a, double slope, double value, double at) {
  Enclosure result = combined(a, slope, {}, 0);
  result.centre = value + slope * (a.centre - at);
  return result;
}

/// Joins a form and an interval that both hold. `error` is the machine's possible error in the form.
Enclosure finished(Enclosure form, const Interval& range, double error) {
  double size = std::abs(form.centre) + form.rest;
  for (const double slope : form.slopes) size += std::abs(slope);
  form.rest += error + flushed_operands + double_rounding * (size + error);
  const double radius = form.radius();
  if (!(radius < unbounded) || !std::isfinite(form.centre)) return Enclosure::of(range);
  const double low = form.centre - radius, high = form.centre + radius;
  form.range = intersection(range, outward(low - double_rounding * size, high + double_rounding * size, true));
  // A form that is much wider than the interval adds nothing.
  const double known = (static_cast<double>(form.range.high) - form.range.low) / 2;
  if (radius > 2 * known) return Enclosure::of(form.range);
  return form;
}

/// The largest distance of a value of `range` from `at`.
double reach(const Interval& range, double at) {
  return std::max(std::abs(static_cast<double>(range.low) - at), std::abs(static_cast<double>(range.high) - at));
}

/// A smooth function by its tangent in the middle: `value` and `slope` there; `curvature` bounds the second derivative;
/// `error` bounds the error of the machine's function and of the two figures.
Enclosure smooth(const Enclosure& a, const Interval& range, float at, double value, double slope, double curvature,
                 double error) {
  const double distance = reach(a.range, at);
  return finished(line(a, slope, value, at), range, 0.5 * curvature * distance * distance + error);
}

float middle(const Enclosure& a) { return std::clamp(static_cast<float>(a.centre), a.range.low, a.range.high); }

Enclosure product(const Enclosure& a, const Enclosure& b, const Interval& range, bool same) {
  const double error = range.largest() * half_unit;
  const double radius_a = a.radius(), radius_b = b.radius();
  if (same) {  // c^2 + 2 c (x - c) + (x - c)^2, the last in [0, radius^2]
    const double half = 0.5 * radius_a * radius_a;
    return finished(line(a, 2 * a.centre, a.centre * a.centre + half, a.centre), range, half + error);
  }
  return finished(combined(a, b.centre, b, a.centre, -a.centre * b.centre), range, radius_a * radius_b + error);
}

Enclosure quotient(const Enclosure& a, const Enclosure& b, const Interval& range) {
  const double least =
      std::min(std::abs(static_cast<double>(b.range.low)), std::abs(static_cast<double>(b.range.high)));
  const double at = middle(b);
  const double distance = reach(b.range, at);
  // 1 / b, which is not rounded since no register holds it.
  Enclosure reciprocal = line(b, -1 / (at * at), 1 / at, at);
  reciprocal.rest += distance * distance / (least * least * least);
  reciprocal.rest += double_rounding * (std::abs(reciprocal.centre) + reciprocal.radius());
  const double largest = range.largest();
  return finished(combined(a, reciprocal.centre, reciprocal, a.centre, -a.centre * reciprocal.centre), range,
                  a.radius() * reciprocal.radius() + largest * half_unit);
}

Enclosure wave(const Enclosure& a, const Interval& range, float (*of)(float), double slope) {
  constexpr double error = 1.5e-7;
  if (a.range.largest() > 1e4f) return Enclosure::of(range);
  const float at = middle(a);
  return smooth(a, range, at, of(at), slope, 1, 2 * error + error * reach(a.range, at));
}

/// The enclosure of a smooth function of one operand; of other operations only the range.
Enclosure smooth_function(Operation operation, const Enclosure& a, const Interval& range) {
  if (!a.range.is_finite()) return Enclosure::of(range);
  switch (operation) {
    case Operation::sine: return wave(a, range, sine_of, cosine_of(middle(a)));
    case Operation::cosine: return wave(a, range, cosine_of, -static_cast<double>(sine_of(middle(a))));
    case Operation::exp2: {
      constexpr double error = 2e-7;
      const double largest = range.high, value = exp2_of(middle(a));
      return smooth(a, range, middle(a), value, ln_2 * value, ln_2 * ln_2 * largest,
                    error * (largest + value * (1 + reach(a.range, middle(a)))));
    }
    case Operation::log2: {
      constexpr double error = 2e-7;
      if (a.range.low <= 0) break;
      const double at = middle(a), value = log2_of(middle(a)), least = a.range.low;
      return smooth(a, range, middle(a), value, 1 / (ln_2 * at), 1 / (ln_2 * least * least),
                    error * (range.largest() + std::abs(value)));
    }
    case Operation::square_root: {
      if (a.range.low <= 0) break;
      const double value = std::sqrt(static_cast<double>(middle(a))), least = a.range.low;
      return smooth(a, range, middle(a), value, 0.5 / value, 0.25 / (least * std::sqrt(least)),
                    range.largest() * half_unit);
    }
    case Operation::normal: {
      // of the density, whose slope is 0.2420 at one standard deviation
      constexpr double error = 2e-7, steepest_change = 0.25;
      const float at = middle(a);
      const double density = 0.39894228040143268 * exp2_of(at * at * -0.72134752f);
      return smooth(a, range, at, normal_of(at), density, steepest_change,
                    2 * error + 1e-5 * reach(a.range, at));  // the density, with its argument rounded
    }
    default: break;
  }
  return Enclosure::of(range);
}

}  // namespace

Enclosure Enclosure::of(const Interval& range) {
  Enclosure result;
  result.range = range;
  if (!range.is_finite()) {
    result.rest = unbounded;
    return result;
  }
  result.centre = 0.5 * (static_cast<double>(range.low) + range.high);
  // The ends are floats, so the middle and half the width are exact in double unless the floats are very far apart.
  result.rest = 0.5 * (static_cast<double>(range.high) - range.low) * (1 + 0x1p-50) + flushed_operands;
  return result;
}

Enclosure Enclosure::quantity(const Interval& range, std::size_t index) {
  Enclosure result = of(range);
  if (!range.is_finite()) return result;
  result.slopes[index] = 0.5 * (static_cast<double>(range.high) - range.low);
  result.rest = flushed_operands + double_rounding * (std::abs(result.centre) + result.slopes[index]);
  return result;
}

double Enclosure::radius() const {
  double radius = rest;
  for (const double slope : slopes) radius += std::abs(slope);
  return radius;
}

Enclosure enclose(Operation operation, const Enclosure& a, const Enclosure& b, const Enclosure& c, bool same) {
  Interval range = range_of(operation, a.range, b.range, c.range);
  if (same && operation == Operation::multiply) range = intersection(range, ranges::square(a.range));
  if (range.is_point() || !range.is_finite()) return Enclosure::of(range);
  const int operands = facts(operation).operands;
  const bool finite = a.range.is_finite() && (operands < 2 || b.range.is_finite());
  const auto chosen = [&range](const Enclosure& operand) {
    Enclosure result = operand;
    result.range = intersection(operand.range, range);
    result.range.maybe_nan = range.maybe_nan;
    return result;
  };
  const double rounding = range.largest() * half_unit;
  switch (operation) {
    case Operation::add: return finite ? finished(combined(a, 1, b, 1), range, rounding) : Enclosure::of(range);
    case Operation::subtract: return finite ? finished(combined(a, 1, b, -1), range, rounding) : Enclosure::of(range);
    case Operation::negate: return finite ? finished(combined(a, -1, a, 0), range, 0) : Enclosure::of(range);
    case Operation::multiply: return finite ? product(a, b, range, same) : Enclosure::of(range);
    case Operation::divide: return finite ? quotient(a, b, range) : Enclosure::of(range);
    case Operation::absolute:
      if (a.range.low >= 0) return chosen(a);
      if (a.range.high <= 0) return finished(combined(a, -1, a, 0), range, 0);
      break;
    // A comparison with not-a-number gives a.
    case Operation::minimum:
      if (a.range.high <= b.range.low) return chosen(a);
      if (b.range.high < a.range.low && !b.range.maybe_nan) return chosen(b);
      break;
    case Operation::maximum:
      if (a.range.low >= b.range.high) return chosen(a);
      if (b.range.low > a.range.high && !b.range.maybe_nan) return chosen(b);
      break;
    case Operation::floor: {  // a minus a fraction in [0, 1)
      if (!finite) break;
      Enclosure below = combined(a, 1, {}, 0);
      below.centre -= 0.5;
      return finished(below, range, 0.5);
    }
    case Operation::select:
      if (!a.range.has_zero()) return chosen(b);
      if (a.range == Interval{}) return chosen(c);
      break;
    case Operation::limit:
      if (a.range.maybe_nan || b.range.maybe_nan || b.range.low < 0) break;
      if (a.range.largest() <= b.range.low) return chosen(a);
      if (a.range.low >= b.range.high) return chosen(b);
      break;
    default: return smooth_function(operation, a, range);
  }
  return Enclosure::of(range);
}

}  // namespace wale
