#pragma once

#include <string>
#include <vector>

#include "compiler/describe/fates_at.hpp"
#include "schema/result.hpp"

namespace wale {

/// What one device makes of one material.
struct DeviceFates {
  std::string material, device;
  Result<std::vector<DescribedFate>> fates;  ///< or why it cannot be built for the device
};

/// A table for each material: what becomes of each percept and of the physics, with a column for each device. A device
/// that it cannot be built for has dashes in its column, and the error's sentence below the table.
std::string fates_text(const std::vector<DeviceFates>& all);
/// JSON: an object by material, then by device, with `fates` as in `wale describe --json`, or with the sentence of the
/// error as `refused`.
std::string fates_json(const std::vector<DeviceFates>& all);

}  // namespace wale
