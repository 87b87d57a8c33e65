#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "schema/declared_device.hpp"
#include "schema/result.hpp"

namespace wale {

/// The devices that Wale itself declares (calibration/devices), by name: data in the binary, which the build makes with
/// the compiler. No file and no compiler is needed at run time. Decoded at the first call; safe from all threads.
/// Refused only where the build was handed a damaged table.
const Result<std::vector<DeclaredDevice>>& shipped_devices();

/// The bytes that they are decoded from (schema/device_table.hpp).
std::span<const std::byte> shipped_device_table();

}  // namespace wale
