#include "library/plugged_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace wale {

PluggedDevices plugged_devices() {
  auto context = UsbContext::open();
  if (auto* refusal = std::get_if<Refusal>(&context)) return *std::move(refusal);
  return list_usb_devices(*std::get<std::shared_ptr<UsbContext>>(context));
}

std::string plugged_text(const PluggedDevices& plugged) {
  std::string text = "\nplugged in (listed; this version does not feel on them yet)\n";
  if (const auto* refusal = std::get_if<Refusal>(&plugged))
    return text + fmt::format("  USB cannot be looked at: {}\n", refusal->reason);
  const auto& devices = std::get<std::vector<ListedUsbDevice>>(plugged);
  if (devices.empty()) return text + "  no USB joystick\n";
  for (const ListedUsbDevice& device : devices) {
    text += fmt::format("  {:<12} {} at port {}\n", in_words(device.usb.vendor, device.usb.product),
                        device.name.empty() ? "without a name" : device.name, device.usb.port);
    if (!device.can.empty()) text += fmt::format("  {:<12} {}\n", "", device.can);
    if (!device.obstacle.empty()) text += fmt::format("  {:<12} cannot be used: {}\n", "", device.obstacle);
  }
  return text;
}

std::string with_plugged(const std::string& devices_json, const PluggedDevices& plugged) {
  auto json = nlohmann::ordered_json::parse(devices_json);
  if (const auto* devices = std::get_if<std::vector<ListedUsbDevice>>(&plugged))
    for (const ListedUsbDevice& device : *devices)
      json.push_back({{"name", device.name},
                      {"feel", false},
                      {"build", false},
                      {"usb", in_words(device.usb.vendor, device.usb.product)},
                      {"port", device.usb.port},
                      {"can", device.can},
                      {"obstacle", device.obstacle}});
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace wale
