#pragma once

namespace wale::reference {

/// A number as real arithmetic has it, and how far at most what the machine computes may stray from it. Each operation
/// rounds once; all throw `Undecided` where that makes a difference.
struct Component {
  double value, error;
};

// A float holds a real number within half of this times its size; each operation rounds once.
inline constexpr double rounding = 1.2e-7;
// sin, cos, exp2, log2 and normal of the machine are right within a few units in the last place.
inline constexpr double function_rounding = 6e-7;

/// Rounds a result: what comes in as its error came from the operands.
Component rounded(double value, double error, double by = rounding);

Component add(Component a, Component b);
Component negated(Component a);
Component multiply(Component a, Component b);
Component divide(Component a, Component b);
Component square_root(Component a);
/// A function whose slope is at most `slope` near the argument.
Component smooth(double value, Component argument, double slope);
Component exponential(Component a, double base);  ///< base^a
Component logarithm(Component a, double base);
Component floor_of(Component a);

bool less(Component a, Component b);
/// Where it is beyond doubt which one it is, the other's error does not matter.
Component smaller(Component a, Component b);
Component larger(Component a, Component b);

}  // namespace wale::reference
