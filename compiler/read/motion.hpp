#pragma once

#include "wale/program.hpp"

namespace wale {

/// The resistance to a moving hand, without forces that depend on position or time only.
struct OpposingForce {
  /// N: of a hand that slides, at any speed above `saturation_speed`; negative if the force pushes the hand on
  double friction = 0;
  double saturation_speed = 0;  ///< m/s: at which the friction is fully there; 0 if it is at any that was tried
  double damping = 0;           ///< N s/m: in proportion to the speed
  double scatter = 0;           ///< N: standard deviation of the strokes from these laws
};

/// Strokes with hands to and fro at several speeds, along both axes and through several positions. Each goes over the
/// same stretch both ways, so that forces that depend on position only cancel. States and memories work as they do
/// under a hand.
OpposingForce opposing_force(const Bank& bank);

/// The mass that opposes the acceleration of a hand at rest, kg: the program's own use of acceleration, with states as
/// on entry.
double inertia(const Bank& bank);

/// A changing force on a hand that holds still.
struct Swing {
  double amplitude = 0;  ///< N: of a sine with the same mean square
  double frequency = 0;  ///< Hz: of its strongest component; 0 if the force does not swing
};

/// Below this frequency (Hz) a swing is a sway, which the hand follows; above it is a vibration.
inline constexpr double slowest_vibration = 10;

/// Watches hands that hold still for some seconds, and tells the swings at the place where the force changes most. A
/// force that only rises or falls does not swing.
void tell_swings(const Bank& bank, Swing& sway, Swing& vibration);

}  // namespace wale
