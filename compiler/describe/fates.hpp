#pragma once

#include <string>
#include <vector>

#include "compiler/describe/fates_at.hpp"

namespace wale {

/// What one device makes of one material.
struct DeviceFates {
  std::string material, device;
  std::vector<DescribedFate> fates;
  std::string refusal;  ///< why it cannot be built for the device, in a line; empty where it can
};

/// Material by material, what becomes of each thing on each device: a column for each device.
std::string fates_text(const std::vector<DeviceFates>& all);
/// An object: by material, by device, as `wale describe --json` has `fates`.
std::string fates_json(const std::vector<DeviceFates>& all);

}  // namespace wale
