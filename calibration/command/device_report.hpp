#pragma once

#include <span>
#include <string>

#include "runtime/device/driver.hpp"
#include "runtime/device/trusted_device.hpp"
#include "wale/declared_device.hpp"

namespace wale::command {

/// The text of `wale devices`: the joysticks to feel on, those to build for with the evidence for their figures, and
/// the plugged devices with the trusted declaration used, abilities and obstacles.
std::string devices_text(std::span<const DeclaredDevice> known, std::span<const TrustedDevice> trusted,
                         const Connections& connections, std::span<const PluggedIn> plugged);

/// An array with an element for each declared device (its name, whether it can be felt on, its figures in SI units, the
/// assumed ones, their source), then one for each plugged device.
std::string devices_json(std::span<const DeclaredDevice> known, std::span<const TrustedDevice> trusted,
                         std::span<const PluggedIn> plugged);

}  // namespace wale::command
