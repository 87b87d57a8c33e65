#pragma once

#include <cstdint>

#include "runtime/device/outcome.hpp"

namespace wale {

/// The time of a steady clock. Real-time.
std::int64_t microseconds_now() noexcept;
/// A driver's clock: `microseconds_now`, except for devices with a time of their own.
using MicrosecondClock = std::int64_t (*)() noexcept;

/// The outcome of a transfer, from libusb's status, or from libusb's error when it was submitted.
Outcome outcome_of(int libusb_status) noexcept;
Outcome outcome_of_submitting(int libusb_error) noexcept;

}  // namespace wale
