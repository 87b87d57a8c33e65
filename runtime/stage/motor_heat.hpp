#pragma once

#include <cmath>

#include "wale/device_profile.hpp"
#include "wale/program.hpp"

namespace wale {

/// Keeps motors no hotter than their continuous force would make them.
///
/// A motor's heating is proportional to the square of its force F, and its heat decays with a time constant tau. The
/// heat h is measured as the square of the constant force that would keep the motor as hot. On each axis it follows
/// h' = (F^2 - h) / tau, and must stay below the square of the continuous force Fc. So
///
///   F^2 <= Fc^2 + (Fc^2 - h) tau / r
///
/// This limit is far above the peak force until h is near Fc^2. Then h approaches Fc^2 at the rate 1 / tau + 1 / r and
/// does not exceed it, while F falls to Fc. The time r is the peak force divided by twice the slew, so F falls no
/// faster than the slew.
class MotorHeat {
 public:
  /// The motors are cold. A profile without a continuous force limits nothing.
  explicit MotorHeat(const DeviceProfile& profile);

  /// `periods` control periods have passed under the force commanded last. Before the first call nothing is limited.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  void elapse(long periods) noexcept;
  void commanded(Force force) noexcept { held_ = force; }

  /// `wanted` (N), each axis clamped to what its motor bears now.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  Force held_within(Force wanted) const noexcept;

  glm::dvec2 heat() const noexcept { return heat_; }  ///< N^2, per axis

 private:
  double continuous_square_;  // N^2
  double kept_ = 1;           // share of the heat after one period
  double reserve_ = 0;        // tau / r
  glm::dvec2 held_{0}, heat_{0};
  glm::dvec2 most_{HUGE_VAL};  // N^2, the square of the force that each axis bears now
};

}  // namespace wale
