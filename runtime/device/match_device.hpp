#pragma once

#include <span>

#include "runtime/device/driver.hpp"
#include "runtime/device/trusted_device.hpp"
#include "schema/declared_device.hpp"

namespace wale {

/// The trusted declaration by which something plugged in is driven.
struct MatchedDevice {
  const TrustedDevice* device = nullptr;  ///< one of those handed in; null: none
  bool is_generic = false;                ///< no declaration is about it, and its figures are assumed
};

/// The first of `trusted` that its driver names or that has its numbers; for a device on USB else the generic one.
MatchedDevice match_device(const PluggedIn& plugged, std::span<const TrustedDevice> trusted);

/// The declaration of `known` that would be about something plugged in, by the same rule, if it were trusted; null
/// where none would, or where one of `trusted` says the same.
const DeclaredDevice* untrusted_match(const PluggedIn& plugged, std::span<const DeclaredDevice> known,
                                      std::span<const TrustedDevice> trusted);

}  // namespace wale
