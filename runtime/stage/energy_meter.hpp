#pragma once

#include <cmath>
#include <glm/vec2.hpp>

#include "schema/device_profile.hpp"
#include "wale/program.hpp"

namespace wale {

/// Meters the energy that a program's own force gives to the hand, and holds back what it may not give.
///
/// A force that comes from a potential gives back what it was given, so from its lowest point on it never gives more
/// than the range of that potential; friction and viscosity only take. What gives more is a source: it must say
/// `active`, and gets the watts that it says. The energy
///
///   E <- max(0, E + (f(n-1) + f(n)) dx / 2 - P t)
///
/// falls by what it may give, P, and once it is beyond the range the part of the force that goes along with the hand's
/// motion is left out as far as it gives more than P. What never moves the hand is never held back. How the loop holds
/// the force between ticks is not metered here but by the `PassivityObserver`.
class EnergyMeter {
 public:
  explicit EnergyMeter(const DeviceProfile& profile) : period_(1 / profile.rate) {}

  /// The hand is on a program whose potential has a range of at most `range` (J), and which may give `active` (W) by
  /// itself. What has been given so far still counts.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  void allow(double range, double active) noexcept;

  /// What is left of `field` (N), the program's force, with the handle at `position` (m from the workspace's centre),
  /// `periods` after the last call.
  /// Real-time likewise.
  Force operator()(Force field, glm::dvec2 position, long periods) noexcept;

  double given() const noexcept { return given_; }  ///< J
  long held() const noexcept { return held_; }      ///< ticks on which something was left out

 private:
  double period_;                         // s
  double range_ = HUGE_VAL, active_ = 0;  // until something is said, everything goes
  bool begun_ = false;
  glm::dvec2 position_{0}, field_{0};
  double given_ = 0;
  long held_ = 0;
};

}  // namespace wale
