#pragma once

#include <glm/vec2.hpp>
#include <limits>

#include "wale/device_profile.hpp"
#include "wale/program.hpp"

namespace wale {

/// Whether a device's position is valid now.
enum class Contact {
  good,
  stale,  ///< it is connected, but has sent no new position for too long
  lost    ///< it was unplugged or does not answer properly; it may come back
};

/// A device's report, once a tick.
struct Reading {
  glm::ivec2 counts{0};  ///< encoder counts from the workspace's centre; metres are counts * position_step()
  /// N, the force of the hand on the handle, averaged over the period that just ended, with inertia and friction.
  /// Not-a-number where the device does not measure it.
  Force interaction{std::numeric_limits<float>::quiet_NaN()};
  bool button = false;  ///< the device's button is pressed
  /// Unless this is `good`, the position is an old one, and the loop commands no force.
  Contact contact = Contact::good;
};

/// A force-feedback joystick (position in, force out) or a pad (vibration out, and position in if it has one). One
/// thread at a time uses it.
///
/// The real-time loop calls `elapse`, `sample` and `command` once a tick, in this order; they allocate nothing, take no
/// lock, do not throw, and make no system call besides those that reach the hardware.
class Device {
 public:
  virtual ~Device() = default;

  virtual const DeviceProfile& profile() const noexcept = 0;

  /// `periods` control periods have passed since the last call. Real hardware moves by itself and ignores it.
  virtual void elapse(long periods) noexcept = 0;

  /// The device's report. The loop takes one with counts beyond `RecordedTick::most_counts`, or with an unknown
  /// `contact`, as lost at the last place; an interaction that is not finite was not measured.
  virtual Reading sample() noexcept = 0;

  /// Pushes with `force` (N at the handle) until the next command. Returns the force that the actuator exerts from now
  /// on, after calibration, clamping and quantisation; if the device does not know it, the force that was sent, for
  /// which one that is not finite counts too. A pad
  /// (a profile that vibrates) takes an amplitude (m/s^2) and a frequency (Hz) and returns those of its present
  /// vibration.
  virtual Force command(Force force) noexcept = 0;
};

}  // namespace wale
