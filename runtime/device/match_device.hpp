#pragma once

#include <span>

#include "runtime/device/driver.hpp"
#include "runtime/device/trusted_device.hpp"
#include "wale/declared_device.hpp"

namespace wale {

/// The trusted declaration of a plugged device.
struct MatchedDevice {
  const TrustedDevice* device = nullptr;  ///< an element of the span that was handed in; null: none
  bool is_generic = false;                ///< no declaration names it, so its figures are assumed
};

/// The first of `trusted` that its driver names or that has its numbers; otherwise, for a device on USB, the generic
/// one.
MatchedDevice match_device(const PluggedIn& plugged, std::span<const TrustedDevice> trusted);

/// The declaration of `known` that the same rule would choose if it were trusted. Null if there is none, or if one of
/// `trusted` has the same profile and wiring.
const DeclaredDevice* untrusted_match(const PluggedIn& plugged, std::span<const DeclaredDevice> known,
                                      std::span<const TrustedDevice> trusted);

}  // namespace wale
