#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/device/hid_pid/pid_transport.hpp"
#include "runtime/device/usb/kernel_nodes.hpp"
#include "runtime/device/usb/usb_context.hpp"
#include "schema/result.hpp"

namespace wale {

/// In the order in which they are tried; open_pid_transport.cpp has the figures that it rests on.
std::array<PidTransportKind, 3> transports_by_preference() noexcept;

/// The transport that would be taken, as far as files and permissions tell without opening anything.
struct PidTransportChoice {
  std::optional<PidTransportKind> kind;  ///< none: nothing can be used
  std::string why;  ///< in a line: "libusb, because there is no permission to open /dev/hidraw3"; empty without one
};
/// With `wanted`, only that one is considered.
PidTransportChoice choose_transport(const UsbDeviceInfo& info, const KernelNodes& nodes,
                                    std::optional<PidTransportKind> wanted = std::nullopt);

struct OpenedPidTransport {
  std::unique_ptr<PidTransport> transport;
  std::string why;  ///< why it is not the one tried first; empty: it is
};

/// Opens the first interface of the device that can push, by the first transport that is there and permitted, or by
/// `wanted` alone, and sets it up from zero force. `force_steps`, of each side, is how finely evdev tells levels apart;
/// the others go by the report descriptor. May take a second. The error is that of the transport that came nearest; the
/// device is left as it was.
Result<OpenedPidTransport> open_pid_transport(const std::shared_ptr<UsbContext>& context, const UsbDeviceInfo& info,
                                              std::int64_t force_steps, const PidTransportOptions& options,
                                              std::optional<PidTransportKind> wanted = std::nullopt);

/// Which transport an open descriptor belongs to: a hidraw, evdev or usbfs node, open for reading and writing.
Result<PidTransportKind> transport_of_descriptor(int descriptor, IoctlCall ioctl = system_ioctl);

/// Uses a node that somebody else has opened, such as a portal or a broker. It stays theirs, and is used through a
/// second descriptor until the transport is gone. A context is needed for usbfs only.
Result<std::unique_ptr<PidTransport>> open_pid_transport(const std::shared_ptr<UsbContext>& context, int descriptor,
                                                         std::int64_t force_steps, const PidTransportOptions& options);

}  // namespace wale
