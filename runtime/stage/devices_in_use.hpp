#pragma once

#include "wale/device.hpp"

namespace wale {

/// Notes that a run uses the device; false if another one does.
bool take_device(const Device& device);
/// It uses it no more.
void give_device_back(const Device& device) noexcept;

}  // namespace wale
