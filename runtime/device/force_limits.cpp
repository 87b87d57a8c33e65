#include "runtime/device/force_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "runtime/device/trusted_device.hpp"

namespace wale {

ForceLimits force_limits(const TrustedDevice& device, double most_newton) {
  const DeviceWiring& wiring = device.wiring();
  const double peak = device.profile().force_newton;
  ForceLimits limits{.peak = glm::dvec2(peak), .most_newton = most_newton};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    double gain = wiring.response_of(axis, peak).steepest();
    // What a motor pushes without a command comes on top of what it is commanded.
    const double offset = std::min(std::abs(wiring.offset[axis]), peak / 2);
    if (offset > 0) gain *= peak / (peak - offset);
    limits.gain[wiring.motors[axis].axis] = gain;
  }
  if (wiring.offset != std::array<double, 2>{})
    limits.most_newton = std::max(0.0, most_newton - std::hypot(wiring.offset[0], wiring.offset[1]));
  return limits;
}

}  // namespace wale
