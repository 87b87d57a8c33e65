#include "runtime/device/trusted_device.hpp"

#include "runtime/device/force_limits.hpp"
#include "runtime/device/shipped_devices.hpp"

namespace wale {

TrustedDevice TrustedDevice::as_built() const {
  DeclaredDevice bare = declared_;
  const glm::dvec2 gain = motor_gains(declared_.wiring);
  bare.wiring.axes = bare.wiring.motors = DeviceWiring{}.axes;
  bare.wiring.gain = {gain.x, gain.y};
  return {std::move(bare), file_};
}

Result<std::vector<TrustedDevice>> trusted_devices(std::vector<TrustedDevice> of_owner) {
  const auto& shipped = shipped_devices();
  if (!shipped) return shipped.error();
  for (const DeclaredDevice& each : *shipped) of_owner.push_back(TrustedDevice(each, {}));
  return of_owner;
}

}  // namespace wale
