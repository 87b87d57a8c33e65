#include "runtime/device/driver.hpp"

#include <libusb.h>
#include <unistd.h>

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/device/hid_pid/hid_pid_device.hpp"
#include "runtime/device/hid_pid/open_pid_transport.hpp"
#include "runtime/device/hid_pid/pid_layout.hpp"
#include "runtime/device/hid_pid/report_descriptor.hpp"
#include "runtime/device/list_usb_devices.hpp"
#include "wale/device_wiring.hpp"

namespace wale {

extern const Driver hid_pid_driver;

namespace {

/// The report descriptor from the device itself, if no program has claimed the interface. Detaches no driver.
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
    return Error{Code::failed_transfer, "it does not send its report descriptor", {}, {.name = "port " + info.port}};
  }
  bytes.resize(static_cast<std::size_t>(got));
  return bytes;
}

/// The abilities of a device with this report descriptor, in a line.
Result<std::string> abilities(std::span<const std::uint8_t> report_descriptor) {
  const auto descriptor = hid::parse_report_descriptor(report_descriptor);
  if (!descriptor) return descriptor.error();
  const auto layout = hid::find_pid_layout(*descriptor);
  if (!layout) return layout.error();
  return std::string("two axes ") + (layout->has_direction() ? "by direction" : "each by itself") + ", " +
         std::to_string(layout->set_constant_force.full()) + " steps of force to each side";
}

Result<std::string> abilities_of(const PluggedIn& listed, const KernelNodes& nodes, libusb_device_handle* handle,
                                 const UsbHidInterface& interface) {
  const HidNodes* known = nodes.of(interface.number);
  if (known != nullptr && !known->report_descriptor.empty()) return abilities(known->report_descriptor);
  if (handle == nullptr) return *listed.obstacle;
  const auto told = descriptor_from_device(handle, listed.usb, interface);
  return told ? abilities(*told) : Result<std::string>(told.error());
}

/// "hidraw", or "libusb (not by hidraw: no permission to open /dev/hidraw3)"
std::string way_of(const PidTransportChoice& choice) {
  if (!choice.kind) return {};
  const std::string name(in_words(*choice.kind));
  return choice.why.empty() ? name : name + " (" + choice.why + ")";
}

void describe_hid_pid(PluggedIn& listed, const KernelNodes& nodes, libusb_device_handle* handle) {
  for (const UsbHidInterface& interface : listed.usb.hid) {
    Result<std::string> can = abilities_of(listed, nodes, handle, interface);
    if (!can) {
      listed.obstacle = std::move(can).error();
      continue;
    }
    listed.can = *std::move(can);
    const PidTransportChoice choice = choose_transport(listed.usb, nodes);
    listed.transport = way_of(choice);
    listed.obstacle.reset();
    if (!choice.kind) {
      listed.obstacle = Error{Code::no_permission,
                              "no permission to open it",
                              how_to_permit(listed.usb.vendor, listed.usb.product),
                              {.name = "port " + listed.port}};
    }
    return;
  }
}

/// Joysticks of USB's PID class, and all other HID devices with the reason why they are not such joysticks.
std::vector<PluggedIn> find_hid_pid(const Connections& connections, const PluggedIn* like) {
  const auto numbers = like != nullptr ? read_usb_numbers(like->numbers) : std::nullopt;
  if (like != nullptr && !numbers) return {};
  const auto is_meant = [&](const UsbDeviceInfo& info) {
    return !info.hid.empty() && (!numbers || *numbers == UsbNumbers{info.vendor, info.product});
  };
  return list_usb_devices(connections, hid_pid_driver, is_meant, describe_hid_pid);
}

OpenedDevice open_hid_pid(const Connections& connections, const PluggedIn& plugged, const TrustedDevice& trusted,
                          const DeviceOptions& options) {
  if (!connections.usb) return connections.usb.error();
  HidPidDevice::Options wanted;
  wanted.priority = options.priority;
  wanted.most_newton = options.most_newton;
  wanted.keeper = options.keeper;
  if (!options.transport.empty()) {
    wanted.transport = read_transport_kind(options.transport);
    if (!wanted.transport) {
      return Error{Code::malformed_value,
                   "there is no transport `" + options.transport + "`",
                   "there are hidraw, libusb and evdev",
                   {.name = "--transport", .text = options.transport}};
    }
  }
  auto opened = options.descriptor < 0 ? HidPidDevice::open(*connections.usb, plugged.usb, trusted, wanted)
                                       : HidPidDevice::open(*connections.usb, options.descriptor, trusted, wanted);
  if (!opened) return std::move(opened).error();
  if (options.descriptor >= 0) close(options.descriptor);  // the device has one of its own
  return *std::move(opened);
}

}  // namespace

constinit const Driver hid_pid_driver{.name = "hid-pid",
                                      .is_chosen_by_auto = true,
                                      .is_felt = true,
                                      .find = find_hid_pid,
                                      .open = open_hid_pid,
                                      .transports = pid_transport_names,
                                      .left_alone = "lets go within 0.2 s, if it honours durations"};

}  // namespace wale
