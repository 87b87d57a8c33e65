#include "runtime/device/force_limits.hpp"

#include "runtime/device/trusted_device.hpp"

namespace wale {

ForceLimits force_limits(const TrustedDevice& device, double most_newton) {
  return {.gain = motor_gains(device.wiring()),
          .peak = glm::dvec2(device.profile().force_newton),
          .most_newton = most_newton};
}

glm::dvec2 motor_gains(const DeviceWiring& wiring) {
  glm::dvec2 gains(1);
  for (std::size_t axis = 0; axis < 2; ++axis) gains[wiring.motors[axis].axis] = wiring.gain[axis];
  return gains;
}

}  // namespace wale
