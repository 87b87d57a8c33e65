#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "schema/device_profile.hpp"
#include "schema/result.hpp"

namespace wale {

/// A device's profile is stored as a patch program for the device that does nothing, so profiles have one stored form
/// and one check. Errors: those of `Program::load`.
Result<std::vector<std::byte>> write_profile(const DeviceProfile& profile);
Result<DeviceProfile> read_profile(std::span<const std::byte> bytes);

}  // namespace wale
