#pragma once

#include "wale/device_profile.hpp"
#include "wale/simulated.hpp"

namespace wale {

/// The joystick and hand of tests/reference/closed_loop.md, with the slew and filter of
/// calibration/devices/sandpaper.wale.
inline DeviceProfile sandpaper() {
  return {.name = "sandpaper",
          .workspace_diameter = 0.2286,
          .position_counts = 4096,
          .force_newton = 10,
          .force_counts = 2048,
          .rate = 900,
          .speed_limit = 1,
          .slew = 200,
          .velocity_window = 15,
          .velocity_noise_counts = 1,
          .patch_width = 0.16,
          .patch_height = 0.16,
          .patch_rim = 0.005,
          .mass = 0.3,
          .damping = 1,
          .friction = 0.15};
}

inline HandModel normal_hand() { return {.mass = 0.55, .damping = 6.5, .stiffness = 135}; }

inline constexpr HandModel no_hand{};

}  // namespace wale
