#pragma once

#include <string>
#include <vector>

#include "compiler/describe/fates_at.hpp"

namespace wale {

/// The fates of one material's percepts and physics on one device.
struct DeviceFates {
  std::string material, device;
  std::vector<DescribedFate> fates;
  std::string refusal;  ///< why it cannot be built for the device, in a line; empty if it can
};

/// A table for each material: a row for each percept and part of the physics, and a column for each device.
std::string fates_text(const std::vector<DeviceFates>& all);
/// JSON: an object by material, then by device, with `fates` as in `wale describe --json`.
std::string fates_json(const std::vector<DeviceFates>& all);

}  // namespace wale
