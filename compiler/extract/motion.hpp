#pragma once

#include "wale/program.hpp"

namespace wale {

/// The resistance to a moving hand, without forces that depend on position only.
struct OpposingForce {
  double friction = 0;  ///< N: at any speed; negative if the force pushes the hand on
  double damping = 0;   ///< N s/m: in proportion to the speed
  double scatter = 0;   ///< N: standard deviation of the strokes from friction + damping * speed
};

/// Strokes with hands to and fro at several speeds, along both axes and through several positions. Each goes over the
/// same stretch both ways, so that forces that depend on position only cancel. States and memories work as they do
/// under a hand.
OpposingForce opposing_force(const Bank& bank);

/// The mass that opposes the acceleration of a hand at rest, kg: the program's own use of acceleration, with states as
/// on entry.
double inertia(const Bank& bank);

/// The changing force on a hand that holds still.
struct Vibration {
  double amplitude = 0;  ///< N: amplitude of a sine with the same mean square
  double frequency = 0;  ///< Hz: of its strongest component; 0 if the force is constant
};

/// Measured over a second, at the position of the largest change among a few.
Vibration vibration(const Bank& bank);

}  // namespace wale
