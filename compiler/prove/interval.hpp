#pragma once

#include <string>

#include "schema/instruction.hpp"

namespace wale {

/// What a register can hold: the floats low .. high, which may be infinite, and perhaps not-a-number.
///
/// Low <= high always; what can be nothing but not-a-number is {0, 0, true}. Zero stands for both signs and for every
/// subnormal, which the machine takes for zero: no interval ends just above or below zero without containing it.
struct Interval {
  float low = 0, high = 0;
  bool maybe_nan = false;

  /// Exactly `value`, which may be anything.
  static Interval of(float value);
  /// The floats from `low` to `high`, neither of them not-a-number and low <= high, widened to zero where an end is
  /// subnormal.
  static Interval between(float low, float high, bool maybe_nan = false);
  /// Every float, infinite ones too.
  static Interval everything(bool maybe_nan);

  bool is_point() const { return low == high && !maybe_nan; }
  bool is_finite() const;
  /// Zero of either sign or a subnormal is among the values.
  bool has_zero() const { return low <= 0 && high >= 0; }
  bool has_infinity() const { return !is_finite(); }
  /// Whether a register that holds `value` keeps to this interval.
  bool contains(float value) const;
  /// The largest size of a value that is a number.
  float largest() const { return -low > high ? -low : high; }

  friend bool operator==(const Interval&, const Interval&) = default;
};

/// The least interval that contains both.
Interval hull(const Interval& a, const Interval& b);

/// What is in both, which have a value in common: two statements about the same register.
Interval intersection(const Interval& a, const Interval& b);

/// As a listing shows it, to six digits: "-1 .. 2.5", "3", "0 .. inf or nan".
std::string shown(const Interval& interval);

/// The rules of the column `range` in `schema/instruction.def`: for all values in A, B and C that an instruction may
/// find in its operands, the machine's result lies in the interval that the rule gives.
///
/// The four operations, the root and floor are rounded to nearest by the machine, and rounding keeps order: the ends
/// are the machine's own results at the operands' ends. The machine's own functions keep order only within their stated
/// errors (runtime/machine/arithmetic.hpp), so that their ends move outward by twice these.
namespace ranges {

Interval sum(const Interval& a, const Interval& b);
Interval difference(const Interval& a, const Interval& b);
Interval product(const Interval& a, const Interval& b);
/// Everything, and perhaps not-a-number, where `b` contains zero.
Interval quotient(const Interval& a, const Interval& b);
Interval negative(const Interval& a);
Interval magnitude(const Interval& a);
/// `b < a ? b : a`: not-a-number in either gives a.
Interval least(const Interval& a, const Interval& b);
/// `a < b ? b : a`: not-a-number in either gives a.
Interval greatest(const Interval& a, const Interval& b);
Interval whole(const Interval& a);
Interval root(const Interval& a);
/// 1 where a < b, else 0.
Interval order(const Interval& a, const Interval& b);
/// b where a is not zero, which not-a-number is not, else c.
Interval choice(const Interval& a, const Interval& b, const Interval& c);
Interval sine(const Interval& a);
Interval cosine(const Interval& a);
Interval exp2(const Interval& a);
Interval log2(const Interval& a);
Interval normal(const Interval& a);
/// a held within +-b, and 0 where a is not a number or b is no ceiling.
Interval limit(const Interval& a, const Interval& b);
Interval arctangent(const Interval& a, const Interval& b);
/// [0, 1) in steps of 2^-24.
Interval random();

/// a * a of one and the same register.
Interval square(const Interval& a);

}  // namespace ranges

/// The range of an operation's result by the instruction table; of one that reads tables, grids or peaks everything,
/// since more than its operands must be known. An operation of single values is the machine's own.
Interval range_of(Operation operation, const Interval& a, const Interval& b, const Interval& c);

}  // namespace wale
