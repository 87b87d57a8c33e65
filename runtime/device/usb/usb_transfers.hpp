#pragma once

#include <cstdint>

#include "runtime/device/outcome.hpp"

namespace wale {

/// Of a steady clock. Real-time.
std::int64_t microseconds_now() noexcept;
/// What tells the time to a driver: `microseconds_now`, but for devices whose own time is not the clock's.
using MicrosecondClock = std::int64_t (*)() noexcept;

/// What libusb's status of a transfer, and its error when submitting one, come to.
Outcome outcome_of(int libusb_status) noexcept;
Outcome outcome_of_submitting(int libusb_error) noexcept;

}  // namespace wale
