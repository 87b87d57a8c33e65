#pragma once

#include <algorithm>
#include <cmath>

#include "runtime/stage/energy_meter.hpp"
#include "runtime/stage/motor_heat.hpp"
#include "runtime/stage/passivity_observer.hpp"
#include "schema/device_profile.hpp"
#include "wale/stage.hpp"

namespace wale {

/// What stands between a program's force and the device, whatever the program does. In order: a force that is not a
/// number becomes zero; what gives more energy than it may is held back; its size is held within what the user allows
/// and each axis within the device's peak force and what its motor bears without growing too hot; after `slew` was
/// called the force moves no faster than the profile's slew, until it has caught up with the wanted one; and the
/// passivity observer takes away what the sampled loop gained, within the same limits. Begins at zero force, slewing.
/// On a pad, which gives no energy, the amplitude is held within what the user allows and the greatest acceleration and
/// is not less than nothing, and slews likewise; the frequency is held within those that the pad has, at the least one
/// where nothing is wanted.
class Guards {
 public:
  /// A profile without a slew (zero) does not slow anything. `most` is the largest force that the user allows, N.
  explicit Guards(const DeviceProfile& profile, double most = HUGE_VAL);

  /// Something changed that may make the wanted force jump.
  void slew() noexcept { slewing_ = max_step_ > 0; }

  /// The hand is on this program now, and its force may give so much, but no more watts than the device gives; see
  /// `EnergyMeter`.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  void allow(double range, double active) noexcept { meter_.allow(range, std::min(active, most_active_)); }

  /// The force (N) that may be commanded when `wanted` is, with the handle at `position` (m from the workspace's
  /// centre), `periods` after the last; `commanded` then says what the actuator does.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  Force operator()(Force wanted, glm::dvec2 position, long periods) noexcept;
  /// No force at once, whatever was wanted; from there it slews back. Counted by its reason.
  /// Real-time likewise.
  enum class Reason { overrun, stale, lost };
  Force cut(Reason reason, glm::dvec2 position, long periods) noexcept;
  void commanded(Force force) noexcept {
    observer_.commanded(force);
    heat_.commanded(force);
  }

  const GuardCounts& counts() const noexcept { return counts_; }

 private:
  Force within_device(Force wanted) const noexcept;
  Force within_user(Force wanted) const noexcept;
  /// Within what the device can, the user allows and the motors bear.
  Force bounded(Force wanted) const noexcept;
  /// The same, counted.
  Force within_limits(Force wanted) noexcept;
  Force slewed(Force wanted) noexcept;

  Force low_, high_;    // N per axis; m/s^2 and Hz
  float most_;          // N, of the whole; m/s^2
  double most_active_;  // W
  float max_step_;      // N or m/s^2 per tick
  bool vibrates_;
  bool slewing_ = false;
  Force last_{0};
  EnergyMeter meter_;
  MotorHeat heat_;
  PassivityObserver observer_;
  GuardCounts counts_;
};

}  // namespace wale
