#pragma once

#include <string>
#include <vector>

#include "wale/device_profile.hpp"
#include "wale/device_wiring.hpp"

namespace wale {

/// A device as its `device` declaration describes it: the profile that programs are built for, and its hardware.
struct DeclaredDevice {
  DeviceProfile profile;
  DeviceWiring wiring;
  std::string of_class;              ///< the name of its `class`; may be empty
  std::string source;                ///< where the figures come from; may be empty
  std::vector<std::string> assumed;  ///< settings whose figures nobody measured
  std::vector<std::string> unknown;  ///< figures of the handle that nobody knows

  friend bool operator==(const DeclaredDevice&, const DeclaredDevice&) = default;
};

}  // namespace wale
