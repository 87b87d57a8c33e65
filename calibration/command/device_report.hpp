#pragma once

#include <span>
#include <string>

#include "runtime/device/driver.hpp"
#include "runtime/device/trusted_device.hpp"
#include "schema/declared_device.hpp"

namespace wale::command {

/// What `wale devices` prints: the joysticks that can be felt on, those that can be built for, with the evidence for
/// their figures, and what is plugged in: by which trusted declaration each device is used, what it can do, and
/// what is in the way.
std::string devices_text(std::span<const DeclaredDevice> known, std::span<const TrustedDevice> trusted,
                         const Connections& connections, std::span<const PluggedIn> plugged);

/// An array: of each declared device its name, whether it can be felt on, its figures in SI units, those that are
/// assumed, and their source; then an element for each device that is plugged in.
std::string devices_json(std::span<const DeclaredDevice> known, std::span<const TrustedDevice> trusted,
                         std::span<const PluggedIn> plugged);

}  // namespace wale::command
