#include "runtime/device/hid_pid/open_pid_transport.hpp"

#include <fcntl.h>
#include <libusb.h>
#include <linux/hidraw.h>
#include <linux/input.h>
#include <linux/usbdevice_fs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "runtime/device/hid_pid/evdev_transport.hpp"
#include "runtime/device/hid_pid/hidraw_channel.hpp"
#include "runtime/device/hid_pid/libusb_channel.hpp"
#include "runtime/device/hid_pid/report_transport.hpp"
#include "runtime/device/usb/system_error.hpp"

namespace wale {
namespace {

using Opened = Result<std::unique_ptr<PidTransport>>;

PidTransportOptions shared(PidTransportOptions options, bool is_held) {
  options.session.is_shared = true;
  options.session.resets = !is_held;  // that would end what another program plays
  return options;
}

Opened open_hidraw(Result<HidrawNode> node, bool is_held, const PidTransportOptions& options) {
  if (!node) return std::move(node).error();
  const PidTransportOptions with = shared(options, is_held);
  return ReportTransport::open(
      PidTransportKind::hidraw,
      [&](ReportChannel::Listener& listener) {
        return std::make_unique<HidrawChannel>(std::move(*node), with, listener);
      },
      with);
}

Opened open_libusb(Result<LibusbInterface> interface, const PidTransportOptions& options) {
  if (!interface) return std::move(interface).error();
  return ReportTransport::open(
      PidTransportKind::libusb,
      [&](ReportChannel::Listener& listener) {
        return std::make_unique<LibusbChannel>(std::move(*interface), options, listener);
      },
      options);
}

Opened open_evdev(Result<EvdevNode> node, const EvdevTransport::Limits& limits, const PidTransportOptions& options) {
  if (!node) return std::move(node).error();
  return EvdevTransport::open(std::move(*node), limits, options);
}

Error without_node(PidTransportKind kind) {
  if (kind == PidTransportKind::evdev) {
    return {Code::absent_device, "the kernel's driver makes no constant force of it",
            "Linux 6.12.24 and later know more sticks"};
  }
  return {Code::absent_device, "the kernel's driver has made no hidraw node for it", "plug it in again"};
}

/// An attempt to open one device.
struct Attempt {
  const std::shared_ptr<UsbContext>& context;
  const UsbDeviceInfo& info;
  const KernelNodes& nodes;
  std::int64_t force_steps;
  const PidTransportOptions& options;

  Opened open(PidTransportKind kind, const UsbHidInterface& interface) const {
    const HidNodes* known = nodes.of(interface.number);
    switch (kind) {
      case PidTransportKind::hidraw:
        if (known == nullptr || known->hidraw.empty()) return without_node(kind);
        return open_hidraw(HidrawNode::open(known->hidraw, options.ioctl), !who_holds(nodes.all()).seen.empty(),
                           options);
      case PidTransportKind::libusb: return open_libusb(LibusbInterface::claim(context, info, interface), options);
      case PidTransportKind::evdev: break;
    }
    if (known == nullptr || known->pushing.empty()) return without_node(kind);
    return open_evdev(EvdevNode::open(known->pushing.front(), options.ioctl), {force_steps, interface.out_interval},
                      options);
  }

  /// Opens the first interface that can push. Its error counts, not that of a keyboard interface beside the joystick.
  Opened open(PidTransportKind kind) const {
    Opened last = Error{Code::no_force_device, "it is not a force device: it has no interface of the HID class"};
    for (const UsbHidInterface& interface : info.hid) {
      Opened opened = open(kind, interface);
      if (opened) return opened;
      const bool is_telling = !last && last.error().code == Code::no_force_device;
      if (is_telling || opened.error().code == Code::no_permission) last = std::move(opened);
    }
    return last;
  }
};

/// Whether another transport may work after this error.
bool may_fall_back(const Error& error) {
  return error.code == Code::no_permission || error.code == Code::absent_device;
}

/// Adds the device's numbers, and how to give permission.
Error about(const UsbDeviceInfo& info, Error error) {
  if (error.code == Code::no_permission) error.mend = how_to_permit(info.vendor, info.product);
  error.sentence = in_words(info.vendor, info.product) + ": " + error.sentence;
  if (error.place.name.empty()) error.place.name = "port " + info.port;
  return error;
}

void add_reason(std::string& why, PidTransportKind kind, const std::string& reason) {
  why += (why.empty() ? "" : "; ") + std::string("not by ") + std::string(in_words(kind)) + ": " + reason;
}

}  // namespace

// Measured by `tests/qemu/run rates` on 2026-11-22: the model of OpenFFBoard (full speed, a report each millisecond, an
// effect for each axis) behind vhci_hcd in QEMU without hardware acceleration, on an otherwise idle machine of two
// processors, twice by each transport, 4500 ticks in which both axes change. `loop`: ticks per second that the loop
// achieved, of 900. `x`, `y`: reports per second and axis that reached the device. `median` to `most`: the age of their
// force on arrival, ms. `lost`: reports that the kernel took and the device never got. `processor`: the share of a
// processor that the transport's threads used.
//
//                          loop   x    y    median  99 %   most   lost  processor
//   Linux 6.1.0-56   hidraw  897  484  484     1.4     2      9      0     16 %
//   (6.1.192)                896  483  483     1.4     2      6      0     16 %
//                    libusb  896  485  485     2.4     3     11      0     19 %
//                            898  486  486     2.4     3      7      0     19 %
//                    evdev   887  208  208     1.3     6     15      0      5 %   an update each 2 ms
//                            896  211  211     1.2     2      8      0      5 %
//   Linux 6.12.117   hidraw  897  484  484     1.4     2      9      0     14 %
//                    libusb  891  481  481     2.4     3     13      0     17 %
//                    evdev   895  212  212     1.2     3     14      0      4 %   an update each 2 ms
//
// While builds kept both processors busy:
//
//   Linux 6.1.0-56   hidraw  668  214  214     1.5    15     32      0     16 %
//                    libusb  472  110  109     3.0    44     72      0     19 %
//                    evdev   388   61   61   449     738    752    817      5 %
//
// hidraw and libusb wait for the device and lose nothing, so their forces are as fresh as the device allows. hidraw's
// forces are a millisecond fresher, it costs no more, and games still see the stick: it comes first. libusb also works
// without a hidraw node, but takes the stick from games. evdev costs least, but sends less than half as many forces. It
// queues reports that the device has not taken yet, old forces before new ones, and drops the newest ones when the
// queue is full: if the device or the machine falls behind for a moment, forces stay late for long. It is the last
// resort, for users without permission for the other two.
std::array<PidTransportKind, 3> transports_by_preference() noexcept {
  return {PidTransportKind::hidraw, PidTransportKind::libusb, PidTransportKind::evdev};
}

PidTransportChoice choose_transport(const UsbDeviceInfo& info, const KernelNodes& nodes,
                                    std::optional<PidTransportKind> wanted) {
  PidTransportChoice choice;
  for (const PidTransportKind kind : transports_by_preference()) {
    if (wanted && kind != *wanted) continue;
    std::string node = kind == PidTransportKind::libusb ? nodes.usbfs : "";
    for (const UsbHidInterface& interface : info.hid) {
      const HidNodes* known = nodes.of(interface.number);
      if (known == nullptr || !node.empty()) continue;
      if (kind == PidTransportKind::hidraw) node = known->hidraw;
      if (kind == PidTransportKind::evdev && !known->pushing.empty()) node = known->pushing.front();
    }
    if (node.empty()) {
      add_reason(choice.why, kind, without_node(kind).sentence);
    } else if (access(node.c_str(), R_OK | W_OK) != 0) {
      add_reason(choice.why, kind, why_not_opened(errno, node).sentence);
    } else {
      choice.kind = kind;
      return choice;
    }
  }
  return choice;
}

Result<OpenedPidTransport> open_pid_transport(const std::shared_ptr<UsbContext>& context, const UsbDeviceInfo& info,
                                              std::int64_t force_steps, const PidTransportOptions& options,
                                              std::optional<PidTransportKind> wanted) {
  const KernelNodes nodes = kernel_nodes(info);
  const Attempt attempt{context, info, nodes, force_steps, options};
  std::string why;
  std::optional<Error> nearest;
  for (const PidTransportKind kind : transports_by_preference()) {
    if (wanted && kind != *wanted) continue;
    Opened opened = attempt.open(kind);
    if (opened) return OpenedPidTransport{std::move(*opened), why};
    if (!may_fall_back(opened.error())) return about(info, std::move(opened).error());
    add_reason(why, kind, opened.error().sentence);
    if (!nearest || opened.error().code == Code::no_permission) nearest = std::move(opened).error();
  }
  return about(info, std::move(*nearest));
}

Result<PidTransportKind> transport_of_descriptor(int descriptor, IoctlCall ioctl) {
  const std::string name = "descriptor " + std::to_string(descriptor);
  const int mode = fcntl(descriptor, F_GETFL);
  if (mode < 0) return Error{Code::malformed_value, name + " is not open", {}, {.name = name}};
  if ((mode & O_ACCMODE) != O_RDWR) {
    return Error{
        Code::malformed_value, name + " is not open for reading and writing", "open it with O_RDWR", {.name = name}};
  }
  hidraw_devinfo numbers{};
  if (ioctl(descriptor, HIDIOCGRAWINFO, &numbers) >= 0) return PidTransportKind::hidraw;
  int version = 0;
  if (ioctl(descriptor, EVIOCGVERSION, &version) >= 0) return PidTransportKind::evdev;
  std::uint32_t capabilities = 0;
  if (ioctl(descriptor, USBDEVFS_GET_CAPABILITIES, &capabilities) >= 0) return PidTransportKind::libusb;
  return Error{
      Code::malformed_value, name + " is of no USB device", "open a hidraw, evdev or usbfs node", {.name = name}};
}

Result<std::unique_ptr<PidTransport>> open_pid_transport(const std::shared_ptr<UsbContext>& context, int descriptor,
                                                         std::int64_t force_steps, const PidTransportOptions& options) {
  const Result<PidTransportKind> kind = transport_of_descriptor(descriptor, options.ioctl);
  if (!kind) return kind.error();
  // The party that handed over the descriptor may also use the device, so the session does not reset it.
  if (*kind == PidTransportKind::hidraw) return open_hidraw(HidrawNode::of(descriptor, options.ioctl), true, options);
  if (*kind == PidTransportKind::evdev)
    return open_evdev(EvdevNode::of(descriptor, options.ioctl), {.force_steps = force_steps}, options);
  if (!context) return Error{Code::unusable_device, "USB cannot be used: there is no libusb"};
  const Result<UsbDeviceInfo> info = context->describe(descriptor);
  if (!info) return info.error();
  Opened last = Error{Code::no_force_device, "it is not a force device: it has no interface of the HID class"};
  for (const UsbHidInterface& interface : info->hid) {
    last = open_libusb(LibusbInterface::claim(context, descriptor, *info, interface), options);
    if (last || last.error().code != Code::no_force_device) return last;
  }
  return last;
}

}  // namespace wale
