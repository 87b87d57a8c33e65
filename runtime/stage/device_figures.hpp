#pragma once

#include "wale/device_profile.hpp"
#include "wale/result.hpp"

namespace wale {

/// Whether each figure that the profile declares, one that is not 0, lies in the range of devices. The ranges are those
/// of programs and recordings, so a device that runs can be recorded too. Error: `unusable_device`.
Result<> check_declared_figures(const DeviceProfile& profile);

/// Whether the profile also has all that a loop needs. A device that pushes needs a slew: without one its force could
/// jump by its whole range whenever the hand enters a patch. Error: `unusable_device`, with `expected` and `found`.
Result<> check_figures(const DeviceProfile& profile);

/// Whether the profile of a recording has all that its replay needs. Recordings were made of devices without a slew.
Result<> check_recorded_figures(const DeviceProfile& profile);

}  // namespace wale
