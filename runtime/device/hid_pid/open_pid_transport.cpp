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

Opened open_evdev(Result<EvdevNode> node, std::int64_t force_steps, const PidTransportOptions& options) {
  if (!node) return std::move(node).error();
  return EvdevTransport::open(std::move(*node), force_steps, options);
}

Error without_node(PidTransportKind kind) {
  if (kind == PidTransportKind::evdev) {
    return {Code::absent_device, "the kernel's driver makes no constant force of it",
            "Linux 6.12.24 and later know more sticks"};
  }
  return {Code::absent_device, "the kernel's driver has made no hidraw node of it", "plug it in again"};
}

/// What is tried of one device.
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
    return open_evdev(EvdevNode::open(known->pushing.front(), options.ioctl), force_steps, options);
  }

  /// By the first interface that can push: a keyboard beside the joystick is not what stands in the way.
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

/// Whether another transport may do where one failed so.
bool may_fall_back(const Error& error) {
  return error.code == Code::no_permission || error.code == Code::absent_device;
}

/// Says which device it is about, and how permission is given.
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
    return Error{Code::malformed_value, name + " is not open for reading and writing", "open it with O_RDWR",
                 {.name = name}};
  }
  hidraw_devinfo numbers{};
  if (ioctl(descriptor, HIDIOCGRAWINFO, &numbers) >= 0) return PidTransportKind::hidraw;
  int version = 0;
  if (ioctl(descriptor, EVIOCGVERSION, &version) >= 0) return PidTransportKind::evdev;
  std::uint32_t capabilities = 0;
  if (ioctl(descriptor, USBDEVFS_GET_CAPABILITIES, &capabilities) >= 0) return PidTransportKind::libusb;
  return Error{Code::malformed_value, name + " is of no USB device", "open a hidraw, evdev or usbfs node",
               {.name = name}};
}

Result<std::unique_ptr<PidTransport>> open_pid_transport(const std::shared_ptr<UsbContext>& context, int descriptor,
                                                         std::int64_t force_steps, const PidTransportOptions& options) {
  const Result<PidTransportKind> kind = transport_of_descriptor(descriptor, options.ioctl);
  if (!kind) return kind.error();
  // Who gave the descriptor may use the device as well, and nobody can tell: nothing of theirs is reset.
  if (*kind == PidTransportKind::hidraw) return open_hidraw(HidrawNode::of(descriptor, options.ioctl), true, options);
  if (*kind == PidTransportKind::evdev) return open_evdev(EvdevNode::of(descriptor, options.ioctl), force_steps, options);
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
