#pragma once

#include <atomic>
#include <optional>
#include <span>

#include "runtime/device/choose_device.hpp"

namespace wale {

/// Looks again whenever something is plugged in on USB, until the device that is asked for is there, or is there and
/// cannot be used. Errors are those of `choose_device`; `absent_device` or what was in the way once `seconds` are over
/// (nothing: no limit), and `stopped` once `stop` is true. Blocks the calling thread; `connections.usb` is there.
Result<ChosenDevice> wait_for_device(const Connections& connections, const DeviceRequest& request,
                                     std::span<const DeclaredDevice> known, std::span<const TrustedDevice> trusted,
                                     std::optional<double> seconds, const std::atomic<bool>& stop,
                                     Drivers drivers = wale::drivers());

}  // namespace wale
