#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <span>

#include "runtime/device/choose_device.hpp"

namespace wale {

/// Chooses again whenever a device is plugged in on USB, and each half second because other devices do not announce
/// themselves, until the requested device is there, usable or not. Errors: those of `choose_device`; the last of them
/// once `seconds` (empty: no limit) are over; `stopped` once `stop` is true. Blocks the calling thread. While
/// `connections.usb` has no value, only devices that are not on USB are found, and `open` tries for USB again each half
/// second: a container or a virtual machine may get it late.
Result<ChosenDevice> wait_for_device(Connections& connections, const DeviceRequest& request,
                                     std::span<const DeclaredDevice> known, std::span<const TrustedDevice> trusted,
                                     std::optional<double> seconds, const std::atomic<bool>& stop,
                                     Drivers drivers = wale::drivers(),
                                     const std::function<Connections()>& open = Connections::open);

}  // namespace wale
