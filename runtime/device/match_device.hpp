#pragma once

#include <span>

#include "runtime/device/driver.hpp"
#include "schema/declared_device.hpp"

namespace wale {

/// The declared device that something plugged in is.
struct MatchedDevice {
  const DeclaredDevice* device = nullptr;  ///< one of those handed in; null: none
  bool is_generic = false;                 ///< no declaration is about it, and its figures are assumed
};

/// The first of `known` that its driver names or that has its numbers; for a device on USB else the generic one.
MatchedDevice match_device(const PluggedIn& plugged, std::span<const DeclaredDevice> known);

}  // namespace wale
