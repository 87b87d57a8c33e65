#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "wale/declared_device.hpp"
#include "wale/result.hpp"

namespace wale {

/// The devices that Wale itself declares (calibration/devices), in the order of their names. The build makes the table
/// with the compiler and stores it in the binary, so no file and no compiler is needed at run time. Decoded at the
/// first call, which allocates; safe from all threads. Error: `damaged_file`, only if the build stored a damaged table.
const Result<std::vector<DeclaredDevice>>& shipped_devices();

/// The table from which they are decoded (schema/device_table.hpp).
std::span<const std::byte> shipped_device_table();

}  // namespace wale
