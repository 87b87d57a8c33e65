#include "runtime/device/match_device.hpp"

#include <algorithm>

namespace wale {

MatchedDevice match_device(const PluggedIn& plugged, std::span<const DeclaredDevice> known) {
  const auto numbers = read_usb_numbers(plugged.numbers);
  const DeclaredDevice* generic = nullptr;
  for (const DeclaredDevice& device : known) {
    if (!plugged.profile.empty() && device.profile.name == plugged.profile) return {&device, false};
    if (numbers && std::ranges::find(device.wiring.usb, *numbers) != device.wiring.usb.end()) return {&device, false};
    if (device.wiring.is_generic && generic == nullptr) generic = &device;
  }
  if (!plugged.profile.empty() || !numbers) return {};
  return {generic, generic != nullptr};
}

}  // namespace wale
