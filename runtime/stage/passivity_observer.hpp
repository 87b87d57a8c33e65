#pragma once

#include <glm/vec2.hpp>

#include "runtime/stage/lag.hpp"
#include "schema/device_profile.hpp"
#include "wale/program.hpp"

namespace wale {

/// Meters the energy that sampling and holding give to the hand, beyond what the force field itself does, and takes it
/// away again by damping: what keeps a wall that is too stiff for its device from singing.
///
/// A force u that is held while the handle moves by dx does the work u dx; the field f, of which it was sampled, does
/// the mean of its values before and after. The difference, less what the device's own damping b takes up, is what the
/// loop gained:
///
///   W <- max(0, W + u(n-1) dx - (f(n-1) + f(n)) dx / 2 - b dx^2 / T)
///
/// u(n-1) is what the actuator exerts: where the device is late by d periods (its delay and its bandwidth's time
/// constant), the command of d periods before. That is counted only where somebody measured the device's damping: with
/// an assumed one a late device would be blamed for what the hand takes up in truth, as no grade is given then either.
/// Then, on a spring, the first two differ by the stretch over all the time from a sample to the middle of its force's
/// period, (1/2 + d) T, and so the speed with which b takes up energy is taken over just that time: what an encoder has
/// wrong is wrong on both sides, and they cancel at the stiffness that is passive, b / (T / 2 + d T). On a texture the
/// first two differ by turns: moving at an even pace over a slope up and one down they come to nothing, and to at most
/// (1 + 2 d) |f| |dx| on the way. That much, at the force and the pace of the last tenth of a second (with one encoder
/// count, by which the way may be wrong), is no gain yet. Beyond it the observer damps, by what is gained and at most
/// 0.1 m/T / (1 + 2 d), m the moving mass at the handle: more would itself be unstable, and the sooner, the later it
/// comes. The form, the 20 uJ and the 0.1 are from simulations (tests/reference/closed_loop.md). They allowed 20 uJ
/// alone, which fires on a passive corduroy that is moved at more than 0.1 m/s.
class PassivityObserver {
 public:
  /// The profile's rate and encoder are known. A mass or damping that it does not declare is 0; without a mass the
  /// observer meters and does not act.
  explicit PassivityObserver(const DeviceProfile& profile);

  /// What to command in place of `field` (N, the force as limits and slew left it), with the handle at `position` (m
  /// from the workspace's centre), `periods` control periods after the last call; the first call only begins. Then
  /// `commanded` says what the actuator does.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  Force operator()(Force field, glm::dvec2 position, long periods) noexcept;
  void commanded(Force force) noexcept { held_ = force; }

  /// J, gained and not yet taken away; at most twice what is allowed, so that it is soon forgotten once it is over.
  double gained() const noexcept { return gained_; }
  /// Ticks on which it damped.
  long acted() const noexcept { return acted_; }

 private:
  Lag lag_;
  double late_;             // 1 + 2 d
  double period_;           // s
  glm::dvec2 per_answer_;   // 1/s, of the time from a sample to the middle of its force's period
  double count_;            // m
  double damping_;          // N s/m, the device's own
  double largest_damping_;  // N s/m, that the observer may add
  bool begun_ = false;
  glm::dvec2 position_{0};
  glm::dvec2 held_{0}, field_{0};  // N, commanded and wanted at the last call
  double recent_force_ = 0;        // N
  double recent_step_ = 0;         // m a period
  double gained_ = 0;
  long acted_ = 0;
};

}  // namespace wale
