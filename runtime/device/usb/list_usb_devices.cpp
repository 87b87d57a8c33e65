#include "runtime/device/usb/list_usb_devices.hpp"

#include <libusb.h>

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "runtime/device/hid_pid/open_pid_transport.hpp"
#include "runtime/device/hid_pid/pid_layout.hpp"
#include "runtime/device/hid_pid/report_descriptor.hpp"
#include "runtime/device/falcon/falcon_device.hpp"

namespace wale {
namespace {

/// The report descriptor as the device tells it. Only where nobody has claimed the interface: nothing is detached.
Result<std::vector<std::uint8_t>> descriptor_from_device(libusb_device_handle* handle, const UsbDeviceInfo& info,
                                                         const UsbHidInterface& interface) {
  if (const int error = libusb_claim_interface(handle, interface.number); error != 0) {
    return why_not_usable(error, info);
  }
  std::vector<std::uint8_t> bytes(interface.report_descriptor_bytes);
  constexpr std::uint8_t standard_in = 0x81, get_descriptor = 6;
  constexpr std::uint16_t report_descriptor = 0x2200;
  constexpr unsigned timeout = 100;  // ms
  const int got = libusb_control_transfer(handle, standard_in, get_descriptor, report_descriptor, interface.number,
                                          bytes.data(), interface.report_descriptor_bytes, timeout);
  libusb_release_interface(handle, interface.number);
  if (got < 0) {
    return Error{Code::failed_transfer, "it does not tell its report descriptor", {}, {.name = "port " + info.port}};
  }
  bytes.resize(static_cast<std::size_t>(got));
  return bytes;
}

/// What a device whose reports are laid out so can do, in a line.
Result<std::string> abilities(std::span<const std::uint8_t> report_descriptor) {
  const auto descriptor = hid::parse_report_descriptor(report_descriptor);
  if (!descriptor) return descriptor.error();
  const auto layout = hid::find_pid_layout(*descriptor);
  if (!layout) return layout.error();
  return std::string("two axes ") + (layout->has_direction() ? "by direction" : "each by itself") + ", " +
         std::to_string(layout->set_constant_force.full()) + " steps of force to each side";
}

/// An open device, or the number of libusb's error. Opening alone changes nothing.
class OpenedForLooking {
 public:
  OpenedForLooking(const UsbContext& context, const UsbDeviceInfo& info) {
    libusb_device* device = context.find(info);
    if (device == nullptr) return;
    error_ = libusb_open(device, &handle_);
    libusb_unref_device(device);
  }
  ~OpenedForLooking() {
    if (handle_ != nullptr) libusb_close(handle_);
  }
  OpenedForLooking(const OpenedForLooking&) = delete;
  OpenedForLooking& operator=(const OpenedForLooking&) = delete;

  libusb_device_handle* handle() const { return handle_; }
  int error() const { return error_; }

 private:
  libusb_device_handle* handle_ = nullptr;
  int error_ = LIBUSB_ERROR_NO_DEVICE;
};

void list_falcon(ListedUsbDevice& listed, const OpenedForLooking& opened) {
  listed.can = "three motors, used as two axes in a plane, " + std::to_string(falcon::most_torque) +
               " steps of torque to each side";
  const auto firmware = read_falcon_firmware(falcon_firmware_path());
  if (const auto* refusal = std::get_if<Refusal>(&firmware)) listed.obstacle = Error{Code::unusable_device, refusal->reason};
  if (opened.error() != 0) listed.obstacle = why_not_usable(opened.error(), listed.usb);
}

void list_hid(ListedUsbDevice& listed, const KernelNodes& nodes, const OpenedForLooking& opened) {
  for (const UsbHidInterface& interface : listed.usb.hid) {
    const HidNodes* known = nodes.of(interface.number);
    Result<std::vector<std::uint8_t>> descriptor = why_not_usable(opened.error(), listed.usb);
    if (known != nullptr && !known->report_descriptor.empty()) {
      descriptor = known->report_descriptor;
    } else if (opened.handle() != nullptr) {
      descriptor = descriptor_from_device(opened.handle(), listed.usb, interface);
    }
    Result<std::string> can = descriptor ? abilities(*descriptor) : Result<std::string>(descriptor.error());
    if (can) {
      listed.can = *std::move(can);
      listed.obstacle.reset();
      break;
    }
    listed.obstacle = std::move(can).error();
  }
  if (listed.can.empty()) return;
  const PidTransportChoice choice = choose_transport(listed.usb, nodes);
  listed.why = choice.why;
  if (choice.kind) {
    listed.transport = in_words(*choice.kind);
  } else {
    listed.obstacle = Error{Code::no_permission, "no permission to open it",
                            how_to_permit(listed.usb.vendor, listed.usb.product), {.name = "port " + listed.usb.port}};
  }
}

ListedUsbDevice listed_device(const UsbContext& context, const UsbDeviceInfo& info) {
  ListedUsbDevice listed;
  listed.usb = info;
  const KernelNodes nodes = kernel_nodes(info);
  listed.name = nodes.product;
  listed.holders = who_holds(nodes.all());
  const OpenedForLooking opened(context, info);
  if (is_falcon(info)) {
    list_falcon(listed, opened);
  } else {
    list_hid(listed, nodes, opened);
  }
  return listed;
}

template <class IsMeant>
std::vector<ListedUsbDevice> listed_devices(const UsbContext& context, IsMeant is_meant) {
  std::vector<UsbDeviceInfo> devices = context.devices();
  std::erase_if(devices, [&](const UsbDeviceInfo& info) { return !is_meant(info); });
  std::sort(devices.begin(), devices.end(), [](const auto& a, const auto& b) { return a.port < b.port; });
  std::vector<ListedUsbDevice> listed;
  for (const UsbDeviceInfo& info : devices) listed.push_back(listed_device(context, info));
  return listed;
}

}  // namespace

std::vector<ListedUsbDevice> list_usb_devices(const UsbContext& context, const std::optional<UsbNumbers>& only) {
  return listed_devices(context, [&](const UsbDeviceInfo& info) {
    return !info.hid.empty() && (!only || *only == UsbNumbers{info.vendor, info.product});
  });
}

std::vector<ListedUsbDevice> list_falcons(const UsbContext& context) { return listed_devices(context, is_falcon); }

}  // namespace wale
