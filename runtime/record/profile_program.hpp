#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "wale/device_profile.hpp"
#include "wale/result.hpp"

namespace wale {

/// A device's profile is stored in a patch program that does nothing, so profiles have only one stored form and one
/// check. Errors: those of `Program::load`.
Result<std::vector<std::byte>> write_profile(const DeviceProfile& profile);
Result<DeviceProfile> read_profile(std::span<const std::byte> bytes);

}  // namespace wale
