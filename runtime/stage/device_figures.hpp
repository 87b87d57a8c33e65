#pragma once

#include "wale/device_profile.hpp"
#include "wale/result.hpp"

namespace wale {

/// Ticks. The filter tries each length of its window at each tick.
inline constexpr double most_velocity_window = 100;

/// Whether each figure that the profile declares, one that is not 0, lies in the range of devices. The ranges are those
/// of programs and recordings, so a device that runs can be recorded too. Error: `unusable_device`.
Result<> check_declared_figures(const DeviceProfile& profile);

/// Whether the profile also has all that a loop needs. Error: `unusable_device`.
Result<> check_figures(const DeviceProfile& profile);

}  // namespace wale
