#pragma once

#include <array>

#include "runtime/device/trusted_device.hpp"
#include "tests/usb/falcon_model.hpp"
#include "wale/device_profile.hpp"

namespace wale::test {

/// A profile with the entries that a driver needs, for a joystick of 16 bits. It has no mass, damping or friction.
inline DeviceProfile joystick_profile() {
  return {.name = "joystick",
          .workspace_diameter = 0.2,
          .position_counts = 65534,
          .force_newton = 10,
          .force_counts = 32767,
          .rate = 900};
}

/// The same for the model of a Falcon.
inline DeviceProfile falcon_profile() {
  return {.name = "falcon",
          .workspace_diameter = 0.1,
          .position_counts = 1667,
          .force_newton = FalconModel::full_newton,
          .force_counts = 4096,
          .rate = 1000};
}

/// A declaration that the owner of a device vouches for.
inline TrustedDevice trusted(const DeviceProfile& profile, std::array<double, 2> gain = {1, 1}) {
  DeclaredDevice declared;
  declared.profile = profile;
  declared.wiring.gain = gain;
  return TrustedDevice::by_owner(declared, "devices.wale");
}

}  // namespace wale::test
