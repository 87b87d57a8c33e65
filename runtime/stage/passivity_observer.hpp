#pragma once

#include <glm/vec2.hpp>

#include "runtime/stage/lag.hpp"
#include "wale/device_profile.hpp"
#include "wale/program.hpp"

namespace wale {

/// Meters the energy that sampling and holding give to the hand beyond the work of the force field itself, and takes it
/// away by damping. This keeps a wall that is too stiff for its device from vibrating.
///
/// A force u that is held while the handle moves by dx does the work u dx. The field f that it samples does the work of
/// the mean of its values before and after. The difference, less the energy that the device's own damping b absorbs, is
/// the energy that the loop gained:
///
///   W <- max(0, W + u(n-1) dx - (f(n-1) + f(n)) dx / 2 - b dx^2 / T)
///
/// u(n-1) is the force that the actuator exerts. On a device that lags by d periods (its delay and its bandwidth's time
/// constant) it is the command of d periods before. The lag counts only if the device's damping was measured: with an
/// assumed damping, a late device would be blamed for energy that the hand absorbs (then no grade is given either).
/// On a spring the two works differ by the stretch over the time from a sample to the middle of its force's period,
/// (1/2 + d) T. The speed at which b absorbs energy is taken over the same time, so an encoder's error is the same in
/// both terms, and they cancel at the stiffness that is just passive, b / (T / 2 + d T). On a texture the difference
/// alternates: at a constant speed over a slope up and a slope down it sums to zero, and between it is at most
/// (1 + 2 d) |f| |dx|. An energy up to that, at the largest force and step of the last tenth of a second (plus one
/// encoder count, the error of a step), does not count as a gain. Beyond it the observer damps by the gained energy, at
/// most by 0.1 m/T / (1 + 2 d), with m the moving mass at the handle: more damping would itself be unstable, and a
/// larger lag lowers that limit. The form, the 20 uJ and the 0.1 are from simulations (tests/reference/closed_loop.md),
/// which allowed 20 uJ only. That alone would damp a passive corduroy that is moved at more than 0.1 m/s.
class PassivityObserver {
 public:
  /// The profile must have a rate and an encoder. A mass or damping that it does not declare is 0; without a mass the
  /// observer meters but does not act.
  explicit PassivityObserver(const DeviceProfile& profile);

  /// The force to command in place of `field` (N, after limits and slew), with the handle at `position` (m from the
  /// workspace's centre), `periods` control periods after the last call; the first call only begins. Call `commanded`
  /// next, with the force that the actuator exerts.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  Force operator()(Force field, glm::dvec2 position, long periods) noexcept;
  void commanded(Force force) noexcept { held_ = force; }

  /// J, gained and not yet taken away; at most twice what is allowed, so that damping ends soon after the gain does.
  double gained() const noexcept { return gained_; }
  /// The number of ticks on which it damped.
  long acted() const noexcept { return acted_; }

 private:
  Lag lag_;
  double late_;             // 1 + 2 d
  double period_;           // s
  glm::dvec2 per_answer_;   // 1/s, one over the time from a sample to the middle of its force's period
  double count_;            // m
  double damping_;          // N s/m, the device's own
  double largest_damping_;  // N s/m, that the observer may add
  bool begun_ = false;
  glm::dvec2 position_{0};
  glm::dvec2 held_{0}, field_{0};  // N, commanded and wanted at the last call
  double recent_force_ = 0;        // N
  double recent_step_ = 0;         // m per period
  double gained_ = 0;              // J
  long acted_ = 0;
};

}  // namespace wale
