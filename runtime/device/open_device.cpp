#include "runtime/device/open_device.hpp"

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace wale {
namespace {

/// The devices like `plugged`. USB devices are not opened for this, since another program may be using them.
std::vector<PluggedIn> alike(const Connections& connections, const PluggedIn& plugged) {
  const auto numbers = read_usb_numbers(plugged.numbers);
  if (!numbers || !connections.usb) return plugged.driver->find(connections, &plugged);
  std::vector<PluggedIn> all;
  for (const UsbDeviceInfo& info : (*connections.usb)->devices()) {
    if (*numbers != UsbNumbers{info.vendor, info.product}) continue;
    all.push_back(plugged);
    all.back().port = info.port;
    all.back().usb = info;
  }
  return all;
}

}  // namespace

Result<std::unique_ptr<HotPluggedDevice>> open_device(const Connections& connections, const ChosenDevice& chosen,
                                                      DeviceOptions options) {
  const PluggedIn& plugged = *chosen.plugged;
  const TrustedDevice& trusted = *chosen.trusted;
  if (connections.usb)
    (*connections.usb)->set_priority(options.priority);  // without permission it runs at ordinary priority
  std::set<std::string> others;                          // ports of other devices like it
  for (const PluggedIn& each : alike(connections, plugged))
    if (each.port != plugged.port) others.insert(each.port);
  OpenedDevice opened = plugged.driver->open(connections, plugged, trusted, options);
  if (!opened) return std::move(opened.error());

  options.descriptor = -1;  // a handed-over descriptor is used only once
  const auto reopen = [connections, plugged, trusted, options, others]() -> OpenedDevice {
    const std::vector<PluggedIn> found = alike(connections, plugged);
    const PluggedIn* again = nullptr;
    for (const PluggedIn& each : found)
      if (each.port == plugged.port || (again == nullptr && !others.contains(each.port))) again = &each;
    if (again == nullptr) return Error{Code::absent_device, "it is not plugged in"};
    return plugged.driver->open(connections, *again, trusted, options);
  };
  return std::make_unique<HotPluggedDevice>(*std::move(opened), trusted.wiring(), reopen);
}

}  // namespace wale
