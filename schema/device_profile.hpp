#pragma once

#include <string>

namespace wale {

/// A two-axis joystick as its `device` declaration describes it; SI units throughout. Zero means "not declared"
/// where a zero makes no sense.
struct DeviceProfile {
  std::string name;
  double workspace_diameter = 0;     ///< m
  double position_counts = 0;        ///< encoder counts over the workspace's diameter, per axis
  double force_newton = 0;           ///< peak force per axis, N
  double force_counts = 0;           ///< command steps from zero to peak force
  double rate = 0;                   ///< control ticks per second, Hz
  double speed_limit = 0;            ///< m/s; what the runtime clamps velocity to and measuring explores up to
  double slew = 0;                   ///< N/s; how fast the force may move after a change of program, bank or patch
  double velocity_window = 0;        ///< ticks; the longest window of the velocity filter
  double velocity_noise_counts = 0;  ///< counts; the band the velocity filter takes for noise
  double patch_width = 0;            ///< m; the patch a material gets that does not say
  double patch_height = 0;           ///< m
  double patch_rim = 0;              ///< m; over which a patch fades at its edge
  double mass = 0;                   ///< kg, moving mass at the handle
  double damping = 0;                ///< N s/m
  double friction = 0;               ///< N, Coulomb
  double delay_x = 0, delay_y = 0;   ///< s, from a sample to the force that answers it, beyond the period it is held
  /// Hz, of each axis: where the actuator, taken for a first-order low-pass, has 3 dB less force; 0: it has them all.
  double bandwidth_x = 0, bandwidth_y = 0;
  bool damping_known = false;   ///< somebody measured it; otherwise it is assumed and no grade leans on it
  bool friction_known = false;  ///< the same of the friction

  /// Metres per encoder count.
  double position_step() const { return workspace_diameter / position_counts; }
  /// Newtons per command step.
  double force_step() const { return force_newton / force_counts; }

  friend bool operator==(const DeviceProfile&, const DeviceProfile&) = default;
};

}  // namespace wale
