#include "runtime/device/usb/usb_transfers.hpp"

#include <libusb.h>
#include <time.h>

namespace wale {

std::int64_t microseconds_now() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000 + now.tv_nsec / 1000;
}

Outcome outcome_of(int libusb_status) noexcept {
  switch (libusb_status) {
    case LIBUSB_TRANSFER_COMPLETED: return Outcome::done;
    case LIBUSB_TRANSFER_STALL: return Outcome::stalled;
    case LIBUSB_TRANSFER_TIMED_OUT: return Outcome::timed_out;
    case LIBUSB_TRANSFER_NO_DEVICE: return Outcome::gone;
    default: return Outcome::failed;
  }
}

Outcome outcome_of_submitting(int libusb_error) noexcept {
  return libusb_error == LIBUSB_ERROR_NO_DEVICE ? Outcome::gone : Outcome::failed;
}

}  // namespace wale
