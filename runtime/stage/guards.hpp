#pragma once

#include <algorithm>
#include <cmath>

#include "runtime/stage/energy_meter.hpp"
#include "runtime/stage/motor_heat.hpp"
#include "runtime/stage/passivity_observer.hpp"
#include "runtime/device/user_limit.hpp"
#include "wale/device_profile.hpp"
#include "wale/run.hpp"

namespace wale {

/// Limits the force of any program before it reaches the device. In order: a force that is not a number becomes zero; a
/// force that gives more energy than allowed is reduced; its size is clamped to the user's limit, and each axis to the
/// device's peak force and to the force that its motor bears without overheating; after a call of `slew` the force
/// moves no faster than the profile's slew, until it reaches or passes the wanted one; the passivity observer takes
/// away the energy that the sampled loop gained, within the same limits. Where the device's nearest step would exceed the
/// user's limit, the force is that of the step toward zero. Begins at zero force, slewing. On a pad, which gives no energy, the amplitude is clamped between 0 and the lesser of the user's limit and the greatest
/// acceleration, and moves no faster than the profile's slew; the frequency is clamped to the pad's range, and is its
/// least one while the wanted amplitude is 0.
class Guards {
 public:
  /// A profile without a slew (zero), as of a pad or of an old recording, does not limit the rate. `most` is the largest force that the user allows, N.
  explicit Guards(const DeviceProfile& profile, double most = HUGE_VAL);

  /// Slews from now on: call it when a change may make the wanted force jump.
  void slew() noexcept { slewing_ = max_step_ > 0, missing_ = Force(0); }

  /// From now on slewing ends only within a step of the wanted force, as when recordings of version 3 were made.
  void end_slewing_only_when_near() noexcept { ends_when_passed_ = false; }
  /// From now on the user's limit disregards the device's steps, as when recordings of version 4 were made.
  void disregard_steps() noexcept { limit_.disregard_steps(); }

  /// The hand is on another program now. Its force may give the energy `range` (J) and the power `active` (W), but no
  /// more power than the device allows; see `EnergyMeter`.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  void allow(double range, double active) noexcept { meter_.allow(range, std::min(active, most_active_)); }

  /// The force (N) to command in place of `wanted`, with the handle at `position` (m from the workspace's centre),
  /// `periods` after the last call. Call `commanded` next, with the force that the actuator exerts.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  Force operator()(Force wanted, glm::dvec2 position, long periods) noexcept;
  /// Returns zero force, from which the force slews back, and counts the reason.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  enum class Reason { overrun, stale, lost };
  Force cut(Reason reason, glm::dvec2 position, long periods) noexcept;
  void commanded(Force force) noexcept {
    observer_.commanded(force);
    heat_.commanded(force);
  }

  const GuardCounts& counts() const noexcept { return counts_; }

 private:
  Force within_device(Force wanted) const noexcept;
  /// Clamped to the limits of the device, the user and the motors' heat.
  Force bounded(Force wanted) const noexcept;
  /// As `bounded`; also counts each limit that changed the force.
  Force within_limits(Force wanted) noexcept;
  Force slewed(Force wanted) noexcept;
  /// As the device can round without exceeding the user's limit. `counted` is the count of the limit before this tick.
  Force in_steps(Force wanted, long counted) noexcept;

  Force low_, high_;    // N per axis; m/s^2 and Hz
  UserLimit limit_;
  double most_active_;  // W
  float max_step_;      // N or m/s^2 per tick
  bool vibrates_;
  bool ends_when_passed_ = true;
  bool slewing_ = false;
  Force missing_{0};  // what lacked of the wanted force after the last tick that slewed
  Force last_{0};
  EnergyMeter meter_;
  MotorHeat heat_;
  PassivityObserver observer_;
  GuardCounts counts_;
};

}  // namespace wale
