#pragma once

#include <string>
#include <variant>
#include <vector>

#include "runtime/device/usb/list_usb_devices.hpp"

namespace wale {

/// What is plugged in, or why nobody can tell.
using PluggedDevices = std::variant<std::vector<ListedUsbDevice>, Refusal>;

PluggedDevices plugged_devices();

/// The last part of what `wale devices` prints: each device, what it can do, and what is in the way.
std::string plugged_text(const PluggedDevices& plugged);
/// The array of `devices_json` with one element more for each device that is plugged in.
std::string with_plugged(const std::string& devices_json, const PluggedDevices& plugged);

}  // namespace wale
