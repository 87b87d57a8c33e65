#pragma once

#include <cmath>
#include <glm/vec2.hpp>

#include "wale/device_profile.hpp"
#include "wale/program.hpp"

namespace wale {

/// Meters the energy that a program's own force gives to the hand, and holds back energy beyond its allowance.
///
/// The force of a potential only returns energy that it was given, so it never gives more than the range of that
/// potential, counted from its lowest point; friction and viscosity only take. A force that gives more is a source: its
/// program must declare `active`, and may give the declared power P. The energy
///
///   E <- max(0, E + (f(n-1) + f(n)) dx / 2 - P t)
///
/// falls at the rate P; f is the force (N), dx the hand's step (m), t the time since the last call (s). Once E exceeds
/// the range, the part of the force along the hand's motion is reduced until it gives no more than P. A force that does
/// not move the hand is never held back. `PassivityObserver` counts the energy from holding the force between ticks.
class EnergyMeter {
 public:
  explicit EnergyMeter(const DeviceProfile& profile) : period_(1 / profile.rate) {}

  /// The hand is on a program whose potential has a range of at most `range` (J), and which may give `active` (W) by
  /// itself. Energy given so far still counts.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  void allow(double range, double active) noexcept;

  /// Returns the part of `field` (N), the program's force, that may be given, with the handle at `position` (m from the
  /// workspace's centre), `periods` after the last call.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  Force operator()(Force field, glm::dvec2 position, long periods) noexcept;

  double given() const noexcept { return given_; }  ///< J
  long held() const noexcept { return held_; }      ///< ticks on which the force was reduced

 private:
  double period_;                         // s
  double range_ = HUGE_VAL, active_ = 0;  // J, W; everything is allowed until `allow` is called
  bool begun_ = false;
  glm::dvec2 position_{0}, field_{0};
  double given_ = 0;
  long held_ = 0;
};

}  // namespace wale
