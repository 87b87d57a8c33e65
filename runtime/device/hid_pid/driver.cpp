#include "runtime/device/driver.hpp"

#include <libusb.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>

#include "runtime/device/hid_pid/hid_pid_device.hpp"
#include "runtime/device/hid_pid/pid_layout.hpp"
#include "runtime/device/hid_pid/report_descriptor.hpp"
#include "runtime/device/usb/list_usb_devices.hpp"
#include "schema/device_wiring.hpp"

namespace wale {

extern const Driver hid_pid_driver;

namespace {

/// The report descriptor as the kernel's driver has read it, where one is bound.
std::optional<std::string> descriptor_from_kernel(const UsbDeviceInfo& info, const UsbHidInterface& interface) {
  std::error_code error;
  const std::filesystem::path folder =
      "/sys/bus/usb/devices/" + info.port + "/" + info.port + ":1." + std::to_string(interface.number);
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    std::ifstream file(entry.path() / "report_descriptor", std::ios::binary);
    if (file) return std::string(std::istreambuf_iterator<char>(file), {});
  }
  return std::nullopt;
}

/// The report descriptor as the device tells it, where nobody has claimed the interface: nothing is detached.
Result<std::string> descriptor_from_device(libusb_device_handle* handle, const UsbDeviceInfo& info,
                                           const UsbHidInterface& interface) {
  if (const int error = libusb_claim_interface(handle, interface.number); error != 0)
    return Error{Code::unusable_device, why_not_usable(error, info).reason};
  std::string bytes(interface.report_descriptor_bytes, 0);
  constexpr std::uint8_t standard_in = 0x81, get_descriptor = 6;
  constexpr std::uint16_t report_descriptor = 0x2200;
  constexpr unsigned timeout = 100;  // ms
  const int got = libusb_control_transfer(handle, standard_in, get_descriptor, report_descriptor, interface.number,
                                          reinterpret_cast<unsigned char*>(bytes.data()),
                                          interface.report_descriptor_bytes, timeout);
  libusb_release_interface(handle, interface.number);
  if (got < 0) return Error{Code::failed_transfer, "it does not send its report descriptor"};
  bytes.resize(static_cast<std::size_t>(got));
  return bytes;
}

/// What a report descriptor says that its device can do, or why it cannot.
void read_descriptor(const std::string& text, PluggedIn& listed) {
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  const auto descriptor = hid::parse_report_descriptor(bytes);
  if (const auto* error = std::get_if<hid::ReportDescriptorError>(&descriptor)) {
    listed.obstacle = Error{Code::unlike_device, "its report descriptor is damaged at byte " +
                                                     std::to_string(error->offset) + ": " + error->reason};
    return;
  }
  const auto found = hid::find_pid_layout(std::get<hid::ReportDescriptor>(descriptor));
  if (const auto* refusal = std::get_if<hid::PidRefusal>(&found)) {
    listed.obstacle = Error{Code::unlike_device, refusal->reason};
    return;
  }
  const auto& layout = std::get<hid::PidLayout>(found);
  listed.can = std::string("two axes ") + (layout.has_direction() ? "by direction" : "each by itself") + ", " +
               std::to_string(layout.set_constant_force.full()) + " steps of force to each side";
  listed.obstacle.reset();
}

void describe_hid_pid(PluggedIn& listed, libusb_device_handle* handle) {
  for (const UsbHidInterface& interface : listed.usb.hid) {
    if (const auto known = descriptor_from_kernel(listed.usb, interface)) {
      read_descriptor(*known, listed);
    } else if (handle != nullptr) {
      const auto told = descriptor_from_device(handle, listed.usb, interface);
      if (told)
        read_descriptor(*told, listed);
      else
        listed.obstacle = told.error();
    }
    if (!listed.can.empty()) break;
  }
}

/// Joysticks of USB's PID class, and all other HID devices, with the reason why they are none.
std::vector<PluggedIn> find_hid_pid(const Connections& connections, const PluggedIn* like) {
  const auto numbers = like != nullptr ? read_usb_numbers(like->numbers) : std::nullopt;
  if (like != nullptr && !numbers) return {};
  const auto is_meant = [&](const UsbDeviceInfo& info) {
    return !info.hid.empty() && (!numbers || *numbers == UsbNumbers{info.vendor, info.product});
  };
  return list_usb_devices(connections, hid_pid_driver, is_meant, describe_hid_pid);
}

OpenedDevice open_hid_pid(const Connections& connections, const PluggedIn& plugged, const DeviceProfile& profile,
                          const DeviceOptions& options) {
  if (!connections.usb) return connections.usb.error();
  auto opened = HidPidDevice::open(*connections.usb, plugged.usb, profile, {.priority = options.priority});
  if (auto* refusal = std::get_if<Refusal>(&opened)) return Error{Code::unusable_device, std::move(refusal->reason)};
  return std::move(std::get<std::unique_ptr<HidPidDevice>>(opened));
}

}  // namespace

const Driver hid_pid_driver{
    .name = "hid-pid", .is_chosen_by_auto = true, .is_felt = true, .find = find_hid_pid, .open = open_hid_pid};

}  // namespace wale
