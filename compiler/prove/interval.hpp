#pragma once

#include <string>

#include "wale/instruction.hpp"

namespace wale {

/// The values that a register can hold: the floats low .. high, which may be infinite, and perhaps not-a-number.
///
/// Always low <= high; a value that can only be not-a-number is {0, 0, true}. Zero stands for both signs and for every
/// subnormal, which the machine flushes to zero: no interval ends just above or below zero without containing it.
struct Interval {
  float low = 0, high = 0;
  bool maybe_nan = false;

  /// Exactly `value`, which may be any float.
  static Interval of(float value);
  /// The floats from `low` to `high`, which are numbers with low <= high. An end that is subnormal is widened to zero.
  static Interval between(float low, float high, bool maybe_nan = false);
  /// Every float, also infinities.
  static Interval everything(bool maybe_nan);

  bool is_point() const { return low == high && !maybe_nan; }
  bool is_finite() const;
  /// Whether zero of either sign or a subnormal is among the values.
  bool has_zero() const { return low <= 0 && high >= 0; }
  bool has_infinity() const { return !is_finite(); }
  /// Whether `value` is in this interval.
  bool contains(float value) const;
  /// The largest absolute value.
  float largest() const { return -low > high ? -low : high; }

  friend bool operator==(const Interval&, const Interval&) = default;
};

/// The smallest interval that contains both.
Interval hull(const Interval& a, const Interval& b);

/// The values in both; there must be a common value. For two statements about the same register.
Interval intersection(const Interval& a, const Interval& b);

/// The interval as text with six digits: "-1 .. 2.5", "3", "0 .. inf or nan".
std::string shown(const Interval& interval);

/// The rules of the column `range` in `schema/include/wale/instruction.def`: for all values in A, B and C that an
/// instruction may have as operands, the machine's result lies in the interval of the rule.
///
/// The four operations, the root and floor are rounded to nearest by the machine, and rounding is monotonic: the ends
/// are the machine's own results at the ends of the operands. The machine's own functions are monotonic only within
/// their stated errors (runtime/machine/arithmetic.hpp), so their ends move outward by twice these errors.
namespace ranges {

Interval sum(const Interval& a, const Interval& b);
Interval difference(const Interval& a, const Interval& b);
Interval product(const Interval& a, const Interval& b);
/// Every float, and perhaps not-a-number, if `b` contains zero.
Interval quotient(const Interval& a, const Interval& b);
Interval negative(const Interval& a);
Interval magnitude(const Interval& a);
/// `b < a ? b : a`: not-a-number in either gives a.
Interval least(const Interval& a, const Interval& b);
/// `a < b ? b : a`: not-a-number in either gives a.
Interval greatest(const Interval& a, const Interval& b);
Interval whole(const Interval& a);
Interval root(const Interval& a);
/// 1 if a < b, otherwise 0.
Interval order(const Interval& a, const Interval& b);
/// b if a is not zero (not-a-number is not zero), otherwise c.
Interval choice(const Interval& a, const Interval& b, const Interval& c);
Interval sine(const Interval& a);
Interval cosine(const Interval& a);
Interval exp2(const Interval& a);
Interval log2(const Interval& a);
Interval normal(const Interval& a);
/// a limited to +-b; 0 if a is not a number or b is not a valid ceiling.
Interval limit(const Interval& a, const Interval& b);
Interval arctangent(const Interval& a, const Interval& b);
/// [0, 1) in steps of 2^-24.
Interval random();

/// a * a for one register.
Interval square(const Interval& a);

}  // namespace ranges

/// The range of an operation's result by the instruction table. For operations that read tables, grids or peaks it is
/// every float, since the operands alone do not tell. For single values it is the machine's own result.
Interval range_of(Operation operation, const Interval& a, const Interval& b, const Interval& c);

}  // namespace wale
