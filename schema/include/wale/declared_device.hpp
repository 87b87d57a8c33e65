#pragma once

#include <string>
#include <vector>

#include "wale/device_profile.hpp"
#include "wale/device_wiring.hpp"

namespace wale {

/// The 95 % interval of a calibrated figure, in SI units.
struct FigureInterval {
  std::string figure;  ///< the setting, then the way, axis or part: "gain right", "delay x", "mass"
  double low = 0, high = 0;

  friend bool operator==(const FigureInterval&, const FigureInterval&) = default;
};

/// A device as its `device` declaration describes it: the profile that programs are built for, and its hardware.
struct DeclaredDevice {
  DeviceProfile profile;
  DeviceWiring wiring;
  std::string of_class;              ///< the name of its `class`; may be empty
  std::string source;                ///< where the figures come from; may be empty
  std::vector<std::string> assumed;  ///< settings whose figures nobody measured
  std::vector<std::string> unknown;  ///< figures of the handle that nobody knows
  std::vector<FigureInterval> intervals;  ///< of figures that were calibrated on this device

  friend bool operator==(const DeclaredDevice&, const DeclaredDevice&) = default;
};

}  // namespace wale
