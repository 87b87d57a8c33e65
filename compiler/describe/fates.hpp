#pragma once

#include <string>
#include <vector>

#include "compiler/describe/fates_at.hpp"
#include "wale/result.hpp"

namespace wale {

/// The fates of one material's percepts and physics on one device.
struct DeviceFates {
  std::string material, device;
  Result<std::vector<DescribedFate>> fates;  ///< or why it cannot be built for the device
};

/// A table for each material: a row for each percept and part of the physics, and a column for each device. If a device
/// refuses the material, its column has dashes, and the error's sentence follows the table.
std::string fates_text(const std::vector<DeviceFates>& all);
/// JSON: an object by material, then by device, with `fates` as in `wale describe --json`, or with the sentence of the
/// error as `refused`.
std::string fates_json(const std::vector<DeviceFates>& all);

}  // namespace wale
