#include "runtime/device/trusted_device.hpp"

#include "runtime/device/force_limits.hpp"
#include "runtime/device/shipped_devices.hpp"

namespace wale {

TrustedDevice TrustedDevice::as_built() const {
  DeclaredDevice bare = declared_;
  bare.wiring = declared_.wiring.with_motors(DeviceWiring{}.motors);
  bare.wiring.axes = DeviceWiring{}.axes;
  return {std::move(bare), file_};
}

TrustedDevice TrustedDevice::uncorrected() const {
  DeclaredDevice bare = declared_;
  const double peak = declared_.profile.force_newton;
  for (std::size_t axis = 0; axis < 2; ++axis)
    bare.wiring.gain[axis] = declared_.wiring.response_of(axis, peak).steepest();
  bare.wiring.response = {};
  bare.wiring.offset = {};
  return {std::move(bare), file_};
}

Result<std::vector<TrustedDevice>> trusted_devices(std::vector<TrustedDevice> of_owner) {
  const auto& shipped = shipped_devices();
  if (!shipped) return shipped.error();
  for (const DeclaredDevice& each : *shipped) of_owner.push_back(TrustedDevice(each, {}));
  return of_owner;
}

}  // namespace wale
