#pragma once

#include "schema/device_profile.hpp"
#include "wale/stage.hpp"

namespace wale {

/// What stands between a program's force and the device, whatever the program does. In order: a force that is not a
/// number becomes zero; each axis is held within the device's peak force; and after `slew` was called the force moves
/// no faster than the profile's slew, until it has caught up with the wanted one. Begins at zero force, slewing. On a
/// pad the same holds for the amplitude, which is not less than nothing, within the greatest acceleration; and the
/// frequency is held within those that the pad has, at the least one where nothing is wanted.
class Guards {
 public:
  /// A profile without a slew (zero) does not slow anything.
  explicit Guards(const DeviceProfile& profile);

  /// Something changed that may make the wanted force jump.
  void slew() noexcept { slewing_ = max_step_ > 0; }

  /// The force that may be commanded when `wanted` is, one tick after the last. N.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  Force operator()(Force wanted) noexcept;

  const GuardCounts& counts() const noexcept { return counts_; }

 private:
  Force low_, high_;  // N per axis; m/s^2 and Hz
  float max_step_;    // N or m/s^2 per tick
  bool vibrates_;
  bool slewing_ = false;
  Force last_{0};
  GuardCounts counts_;
};

}  // namespace wale
