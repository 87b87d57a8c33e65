#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "schema/device_profile.hpp"

namespace wale {

/// A device's profile as the patch program that does nothing on it: so it has the one form that profiles are stored in,
/// and is checked as they are. Both throw a `Refusal`.
std::vector<std::byte> write_profile(const DeviceProfile& profile);
DeviceProfile read_profile(std::span<const std::byte> bytes);

}  // namespace wale
