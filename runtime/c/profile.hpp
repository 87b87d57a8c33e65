#pragma once

#include <vector>

#include "runtime/c/call.hpp"
#include "wale/declared_device.hpp"
#include "wale/device.h"

namespace wale::c {

/// The figures of a profile; the text is the profile's.
WaleProfile figures_of(const DeviceProfile& profile);

/// The profile with these figures. Errors: `malformed_value`, and those of texts.
Result<DeviceProfile> read_profile(const WaleProfile* profile);

/// Writes the figures of the declared device of that name, where its text stays. `to` has a size. Error:
/// `unknown_device`, with the nearest names.
Result<> give_profile(const std::vector<DeclaredDevice>& declared, WaleText name, WaleProfile* to);

}  // namespace wale::c
