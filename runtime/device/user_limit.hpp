#pragma once

#include <cmath>
#include <optional>

#include "wale/device_profile.hpp"
#include "wale/program.hpp"

namespace wale {

/// The largest force that a user allows on a device, N of the whole vector, on a pad m/s^2. A device rounds each command
/// to one of its steps, maybe to a larger one; what it exerts must be within the limit too.
class UserLimit {
 public:
  /// `most` is positive; HUGE_VAL is no limit. Copies the figures of the profile that it needs.
  UserLimit(const DeviceProfile& profile, double most);

  /// The force itself, or the largest one in its direction that is allowed.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  Force clamped(Force wanted) const noexcept;
  /// The force itself if the device's nearest step is allowed; otherwise that of the step toward zero. For a force
  /// that `clamped` has given, at most the device's peak.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  Force in_steps(Force wanted) const noexcept;

  /// From now on the steps do not count, as when recordings of version 4 were made.
  void disregard_steps() noexcept { most_ = static_cast<float>(given_), counts_steps_ = false; }

 private:
  Force toward_zero(Force wanted) const noexcept;
  bool allows(Force exerted) const noexcept;
  Force vibration_in_steps(Force wanted) const noexcept;

  double given_;
  float most_;  // the largest number of its precision that is not above the limit
  double step_;  // N
  double peak_;  // N per axis
  std::optional<Shaker> shaker_;
  bool counts_steps_ = true;
};

}  // namespace wale
