#include "runtime/device/match_device.hpp"

#include <algorithm>

namespace wale {
namespace {

const DeclaredDevice& declaration(const DeclaredDevice& device) { return device; }
const DeclaredDevice& declaration(const TrustedDevice& device) { return device.declared(); }

template <class Device>
struct Match {
  const Device* device = nullptr;
  bool is_generic = false;
};

template <class Device>
Match<Device> first_about(const PluggedIn& plugged, std::span<const Device> devices) {
  const auto numbers = read_usb_numbers(plugged.numbers);
  const Device* generic = nullptr;
  for (const Device& device : devices) {
    const DeclaredDevice& declared = declaration(device);
    if (!plugged.profile.empty() && declared.profile.name == plugged.profile) return {&device, false};
    if (numbers && std::ranges::find(declared.wiring.usb, *numbers) != declared.wiring.usb.end())
      return {&device, false};
    if (declared.wiring.is_generic && generic == nullptr) generic = &device;
  }
  if (!plugged.profile.empty() || !numbers) return {};
  return {generic, generic != nullptr};
}

}  // namespace

MatchedDevice match_device(const PluggedIn& plugged, std::span<const TrustedDevice> trusted) {
  const auto match = first_about(plugged, trusted);
  return {match.device, match.is_generic};
}

const DeclaredDevice* untrusted_match(const PluggedIn& plugged, std::span<const DeclaredDevice> known,
                                      std::span<const TrustedDevice> trusted) {
  const DeclaredDevice* const device = first_about(plugged, known).device;
  if (device == nullptr) return nullptr;
  const bool is_trusted = std::ranges::any_of(trusted, [&](const TrustedDevice& each) {
    return each.profile() == device->profile && each.wiring() == device->wiring;
  });
  return is_trusted ? nullptr : device;
}

}  // namespace wale
