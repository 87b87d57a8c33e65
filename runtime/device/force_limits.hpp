#pragma once

#include <cmath>
#include <glm/vec2.hpp>

#include "wale/device_wiring.hpp"

namespace wale {

class TrustedDevice;

/// How hard a plugged device may push its handle, along the device's own axes. All forces are in N at the handle.
struct ForceLimits {
  /// N at the handle for each N that is commanded, of each motor: where its response is bent, the most of any command.
  glm::dvec2 gain{1};
  glm::dvec2 peak{1};             ///< the most along each axis, as its trusted declaration says
  double most_newton = HUGE_VAL;  ///< the most of the whole vector, as its user allows

  /// What the device's full command along each axis would give.
  glm::dvec2 full() const noexcept { return gain * peak; }
};

/// Those of a device whose user allows `most_newton`.
ForceLimits force_limits(const TrustedDevice& device, double most_newton);

}  // namespace wale
