#pragma once

#include <span>

#include "runtime/device/driver.hpp"
#include "schema/declared_device.hpp"

namespace wale {

/// The declaration of a plugged device.
struct MatchedDevice {
  const DeclaredDevice* device = nullptr;  ///< an element of the span that was handed in; null: none
  bool is_generic = false;                 ///< no declaration names it, so its figures are assumed
};

/// The first of `known` that its driver names or that has its numbers; otherwise, for a device on USB, the generic one.
MatchedDevice match_device(const PluggedIn& plugged, std::span<const DeclaredDevice> known);

}  // namespace wale
