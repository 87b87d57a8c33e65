#pragma once

#include "compiler/prove/interval.hpp"
#include "wale/instruction.hpp"

namespace wale {

/// Bounds from below on the sizes of values that are not zero, the counterpart of `Interval`: they tell where a result
/// may be subnormal, so that a processor that does not flush must be told to.
///
/// Every bound is a float; rounding is monotonic, so a result that is at least a bound before rounding is so after it.
struct Smallest {
  float size = 0x1p-126f;  ///< no value is nearer to zero, except zero itself
  bool maybe_zero = true;

  static Smallest of(float value);
  /// The values that are also in `interval`.
  Smallest within(const Interval& interval) const;
};

/// An operand: its bound, and the interval in which it lies.
struct SizedOperand {
  Smallest smallest;
  Interval interval;
};

/// The bound on an operation's exact results before subnormal ones are flushed: below 0x1p-126f if one may be
/// subnormal. Only sums, differences, products and quotients give subnormal results; other operations flush their own.
float smallest_result(Operation operation, const SizedOperand& a, const SizedOperand& b, const SizedOperand& c);

}  // namespace wale
