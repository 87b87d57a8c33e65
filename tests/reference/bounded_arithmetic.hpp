#pragma once

namespace wale::reference {

/// A number in real arithmetic, with a bound on the difference from the machine's result. Each operation rounds once.
/// All throw `Undecided` if rounding may change a decision.
struct Component {
  double value, error;
};

// A float differs from a real number by at most half of this, relative to its size. Each operation rounds once.
inline constexpr double rounding = 1.2e-7;
// sin, cos, exp2, log2 and normal of the machine have errors of a few units in the last place.
inline constexpr double function_rounding = 6e-7;

/// Rounds a result. Its error on entry is the error from the operands.
Component rounded(double value, double error, double by = rounding);

Component add(Component a, Component b);
Component negated(Component a);
Component multiply(Component a, Component b);
Component divide(Component a, Component b);
Component square_root(Component a);
/// Applies a function whose slope is at most `slope` near the argument.
Component smooth(double value, Component argument, double slope);
Component exponential(Component a, double base);  ///< base^a
Component logarithm(Component a, double base);
Component floor_of(Component a);

bool less(Component a, Component b);
/// If the choice is certain, the other's error has no effect.
Component smaller(Component a, Component b);
Component larger(Component a, Component b);

}  // namespace wale::reference
