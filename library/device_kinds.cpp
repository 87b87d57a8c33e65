#include "library/device_kinds.hpp"

#include <algorithm>
#include <array>

#include "runtime/device/pointer/pointer_device.hpp"
#include "runtime/device/falcon/falcon_device.hpp"
#include "runtime/device/hid_pid/hid_pid_device.hpp"
#include "runtime/device/usb/list_usb_devices.hpp"

namespace wale {
namespace {

PluggedIn as_plugged_in(std::string_view kind, ListedUsbDevice device) {
  return {.kind = std::string(kind),
          .numbers = in_words(device.usb.vendor, device.usb.product),
          .port = device.usb.port,
          .name = std::move(device.name),
          .can = std::move(device.can),
          .obstacle = device.obstacle ? in_words(*device.obstacle) : "",
          .holders = in_words(device.holders),
          .transport = std::move(device.transport),
          .why_transport = std::move(device.why),
          .profile = {},
          .usb = std::move(device.usb)};
}

constexpr std::string_view hid_pid = "hid-pid";

/// Joysticks of USB's PID class, and all other HID devices, with the reason why they are none.
std::vector<PluggedIn> find_hid_pid(const Connections& connections, const PluggedIn* like) {
  std::vector<PluggedIn> found;
  if (!connections.usb) return found;
  const auto numbers = like != nullptr ? read_usb_numbers(like->numbers) : std::nullopt;
  if (like != nullptr && !numbers) return found;
  for (ListedUsbDevice& device : list_usb_devices(*connections.usb, numbers))
    found.push_back(as_plugged_in(hid_pid, std::move(device)));
  return found;
}

OpenedDevice open_hid_pid(const Connections& connections, const PluggedIn& plugged, const DeviceProfile& profile,
                          const DeviceOptions& options) {
  HidPidDevice::Options how;
  how.priority = options.priority;
  how.transport = options.transport;
  auto opened = HidPidDevice::open(connections.usb, plugged.usb, profile, how);
  if (!opened) return Refusal{in_words(opened.error()), {}};
  return *std::move(opened);
}

constexpr std::string_view novint_falcon = "novint-falcon";

std::vector<PluggedIn> find_falcon(const Connections& connections, const PluggedIn*) {
  std::vector<PluggedIn> found;
  if (!connections.usb) return found;
  for (ListedUsbDevice& device : list_falcons(*connections.usb))
    found.push_back(as_plugged_in(novint_falcon, std::move(device)));
  return found;
}

OpenedDevice open_falcon(const Connections& connections, const PluggedIn& plugged, const DeviceProfile& profile,
                         const DeviceOptions& options) {
  FalconOptions falcon;
  falcon.ask = options.ask;
  falcon.stop = options.stop;
  auto opened = FalconDevice::open(connections.usb, plugged.usb, profile, falcon);
  if (auto* refusal = std::get_if<Refusal>(&opened)) return std::move(*refusal);
  return std::move(std::get<std::unique_ptr<FalconDevice>>(opened));
}

constexpr std::string_view pointer_kind = "pointer";  // and the name of what declares it

/// The mouse in this terminal, which is always there, or would be.
std::vector<PluggedIn> find_pointer(const Connections&, const PluggedIn*) {
  return {{.kind = std::string(pointer_kind),
           .numbers = {},
           .port = std::string(pointer_kind),
           .name = "the mouse in this terminal",
           .can = "two axes; forces are drawn, not felt",
           .obstacle = pointer::why_no_terminal(),
           .holders = {},
           .transport = {},
           .why_transport = {},
           .profile = std::string(pointer_kind),
           .usb = {}}};
}

OpenedDevice open_pointer(const Connections&, const PluggedIn&, const DeviceProfile& profile, const DeviceOptions&) {
  auto opened = PointerDevice::open(profile);
  if (auto* refusal = std::get_if<Refusal>(&opened)) return std::move(*refusal);
  return std::move(std::get<std::unique_ptr<PointerDevice>>(opened));
}

constexpr std::array<DeviceKind, 3> kinds{{{hid_pid, true, find_hid_pid, open_hid_pid},
                                           {novint_falcon, true, find_falcon, open_falcon},
                                           {pointer_kind, false, find_pointer, open_pointer}}};

}  // namespace

Connections Connections::open() {
  auto context = UsbContext::open();
  if (!context) return {nullptr, in_words(context.error())};
  return {*std::move(context), {}};
}

std::string in_words(const PluggedIn& plugged) {
  const std::string name = plugged.name.empty() ? "a device without a name" : plugged.name;
  if (plugged.numbers.empty()) return name + " (" + plugged.port + ")";
  return name + " (" + plugged.numbers + " at port " + plugged.port + ")";
}

std::span<const DeviceKind> device_kinds() { return kinds; }

const DeviceKind* device_kind(std::string_view name) {
  const auto found = std::ranges::find(kinds, name, &DeviceKind::name);
  return found != kinds.end() ? found : nullptr;
}

}  // namespace wale
