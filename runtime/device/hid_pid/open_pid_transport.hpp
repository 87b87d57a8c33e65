#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/device/hid_pid/pid_transport.hpp"
#include "runtime/device/usb/kernel_nodes.hpp"
#include "runtime/device/usb/usb_context.hpp"
#include "wale/result.hpp"

namespace wale {

/// The transports in the order in which they are tried. open_pid_transport.cpp has the measurements behind the order.
std::array<PidTransportKind, 3> transports_by_preference() noexcept;

/// The transport that would be taken, judged by files and permissions without opening anything.
struct PidTransportChoice {
  std::optional<PidTransportKind> kind;  ///< none: no transport can be used
  std::string why;  ///< in a line: "libusb, because there is no permission to open /dev/hidraw3"; empty without one
};
/// With `wanted`, only that one is considered.
PidTransportChoice choose_transport(const UsbDeviceInfo& info, const KernelNodes& nodes,
                                    std::optional<PidTransportKind> wanted = std::nullopt);

struct OpenedPidTransport {
  std::unique_ptr<PidTransport> transport;
  std::string why;  ///< why it is not the transport tried first; empty if it is
};

/// Opens the first interface of the device that can push, by the first transport that exists and is permitted, or by
/// `wanted` alone, and sets it up from zero force. `force_steps` is the number of force levels to each side with evdev;
/// the other transports take it from the report descriptor. May take a second. The error is that of the transport that
/// came nearest; the device is left as it was.
Result<OpenedPidTransport> open_pid_transport(const std::shared_ptr<UsbContext>& context, const UsbDeviceInfo& info,
                                              std::int64_t force_steps, const PidTransportOptions& options,
                                              std::optional<PidTransportKind> wanted = std::nullopt);

/// The transport of an open descriptor, which must be a hidraw, evdev or usbfs node that is open for reading and
/// writing. Error: `malformed_value`.
Result<PidTransportKind> transport_of_descriptor(int descriptor, IoctlCall ioctl = system_ioctl);

/// Uses a node that another party, such as a portal or a broker, has opened and still owns. The transport uses a second
/// descriptor of it until it is destroyed. Only usbfs needs a context.
Result<std::unique_ptr<PidTransport>> open_pid_transport(const std::shared_ptr<UsbContext>& context, int descriptor,
                                                         std::int64_t force_steps, const PidTransportOptions& options);

}  // namespace wale
