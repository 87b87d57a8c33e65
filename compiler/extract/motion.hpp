#pragma once

#include "wale/program.hpp"

namespace wale {

/// What opposes a hand that moves, beyond what depends on place alone.
struct OpposingForce {
  double friction = 0;  ///< N: whatever the speed; below 0 it pushes the hand on
  double damping = 0;   ///< N s/m: in proportion to the speed
  double scatter = 0;   ///< N: standard deviation of the strokes about friction + damping * speed
};

/// Lets hands stroke to and fro at several speeds along both axes and through several places, each over the same
/// stretch both ways, so that what only depends on place cancels. States and memories work as they do under a hand.
OpposingForce opposing_force(const Bank& bank);

/// What opposes the acceleration of a hand at rest, kg: the program's own use of acceleration, with states as on entry.
double inertia(const Bank& bank);

/// How the program pushes a hand that holds still.
struct Vibration {
  double amplitude = 0;  ///< N: of a sine with the same mean square
  double frequency = 0;  ///< Hz: of its strongest component; 0 where nothing moves
};

/// Over a second, at the busiest of a few places.
Vibration vibration(const Bank& bank);

}  // namespace wale
