#include "runtime/device/usb/list_usb_devices.hpp"

#include <libusb.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>

#include "runtime/device/hid_pid/pid_layout.hpp"
#include "runtime/device/hid_pid/report_descriptor.hpp"
#include "runtime/device/falcon/falcon_device.hpp"

namespace wale {
namespace {

std::optional<std::string> content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

std::filesystem::path sysfs_folder(const UsbDeviceInfo& info) { return "/sys/bus/usb/devices/" + info.port; }

/// The report descriptor as the kernel's driver has read it, where one is bound.
std::optional<std::string> descriptor_from_kernel(const UsbDeviceInfo& info, const UsbHidInterface& interface) {
  std::error_code error;
  const auto folder = sysfs_folder(info) / (info.port + ":1." + std::to_string(interface.number));
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (auto bytes = content_of(entry.path() / "report_descriptor")) return bytes;
  }
  return std::nullopt;
}

/// The report descriptor as the device tells it. Only where nobody has claimed the interface: nothing is detached.
std::variant<std::string, Refusal> descriptor_from_device(libusb_device_handle* handle, const UsbDeviceInfo& info,
                                                          const UsbHidInterface& interface) {
  if (const int error = libusb_claim_interface(handle, interface.number); error != 0) {
    return why_not_usable(error, info);
  }
  std::string bytes(interface.report_descriptor_bytes, 0);
  constexpr std::uint8_t standard_in = 0x81, get_descriptor = 6;
  constexpr std::uint16_t report_descriptor = 0x2200;
  constexpr unsigned timeout = 100;  // ms
  const int got = libusb_control_transfer(handle, standard_in, get_descriptor, report_descriptor, interface.number,
                                          reinterpret_cast<unsigned char*>(bytes.data()),
                                          interface.report_descriptor_bytes, timeout);
  libusb_release_interface(handle, interface.number);
  if (got < 0) return Refusal{"it does not tell its report descriptor", {}};
  bytes.resize(static_cast<std::size_t>(got));
  return bytes;
}

/// What a report descriptor says that its device can do, or why it cannot.
void read_descriptor(const std::string& text, ListedUsbDevice& listed) {
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  const auto descriptor = hid::parse_report_descriptor(bytes);
  if (const auto* error = std::get_if<hid::ReportDescriptorError>(&descriptor)) {
    listed.obstacle =
        "its report descriptor is damaged at byte " + std::to_string(error->offset) + ": " + error->reason;
    return;
  }
  const auto found = hid::find_pid_layout(std::get<hid::ReportDescriptor>(descriptor));
  if (const auto* refusal = std::get_if<hid::PidRefusal>(&found)) {
    listed.obstacle = refusal->reason;
    return;
  }
  const auto& layout = std::get<hid::PidLayout>(found);
  listed.can = std::string("two axes ") + (layout.has_direction() ? "by direction" : "each by itself") + ", " +
               std::to_string(layout.set_constant_force.full()) + " steps of force to each side";
  listed.obstacle.clear();
}

ListedUsbDevice listed_device(const UsbContext& context, const UsbDeviceInfo& info) {
  ListedUsbDevice listed;
  listed.usb = info;
  listed.name = content_of(sysfs_folder(info) / "product").value_or("");
  while (!listed.name.empty() && listed.name.back() == '\n') listed.name.pop_back();

  libusb_device* device = context.find(info);
  if (device == nullptr) {
    listed.obstacle = why_not_usable(LIBUSB_ERROR_NO_DEVICE, info).reason;
    return listed;
  }
  libusb_device_handle* handle = nullptr;
  const int error = libusb_open(device, &handle);
  libusb_unref_device(device);
  if (is_falcon(info)) {
    listed.can = "three motors, used as two axes in a plane, " + std::to_string(falcon::most_torque) +
                 " steps of torque to each side";
    const auto firmware = read_falcon_firmware(falcon_firmware_path());
    if (const auto* refusal = std::get_if<Refusal>(&firmware)) listed.obstacle = refusal->reason;
  }
  for (const UsbHidInterface& interface : info.hid) {
    if (const auto known = descriptor_from_kernel(info, interface)) {
      read_descriptor(*known, listed);
    } else if (error == 0) {
      const auto told = descriptor_from_device(handle, info, interface);
      if (const auto* bytes = std::get_if<std::string>(&told)) {
        read_descriptor(*bytes, listed);
      } else {
        listed.obstacle = std::get<Refusal>(told).reason;
      }
    }
    if (!listed.can.empty()) break;
  }
  // One that pushes, or may, but must not be opened.
  const bool is_known_not_to = !listed.obstacle.empty() && listed.can.empty();
  if (error != 0 && !is_known_not_to) listed.obstacle = why_not_usable(error, info).reason;
  if (handle != nullptr) libusb_close(handle);
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
