#pragma once

#include <cmath>

#include "schema/device_profile.hpp"
#include "wale/program.hpp"

namespace wale {

/// Keeps motors from growing hotter than the force that they bear for any length of time would make them.
///
/// A motor's heat goes with the square of its force F and leaves with a time constant tau. Metered as the square of the
/// force that would keep it as hot for ever, it follows h' = (F^2 - h) / tau, on each axis, and is to stay below the
/// square of the continuous force Fc. So
///
///   F^2 <= Fc^2 + (Fc^2 - h) tau / r
///
/// which is far beyond the peak while there is anything in hand, and near the end lets h come up to Fc^2 as fast as
/// 1 / tau + 1 / r says, and not beyond; F comes down to Fc meanwhile. With r, the peak over twice the slew, it does so
/// no faster than the slew lets it.
class MotorHeat {
 public:
  /// The motors are cold. A profile without a continuous force limits nothing.
  explicit MotorHeat(const DeviceProfile& profile);

  /// `periods` control periods have passed under the force commanded last; before the first, nothing is held back.
  /// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
  void elapse(long periods) noexcept;
  void commanded(Force force) noexcept { held_ = force; }

  /// `wanted` (N), each axis held within what its motor bears now.
  /// Real-time likewise.
  Force held_within(Force wanted) const noexcept;

  glm::dvec2 heat() const noexcept { return heat_; }  ///< N^2, per axis

 private:
  double continuous_square_;  // N^2
  double kept_ = 1;           // of the heat over one period
  double reserve_ = 0;        // tau / r
  glm::dvec2 held_{0}, heat_{0};
  glm::dvec2 most_{HUGE_VAL};  // N^2, what each axis bears now
};

}  // namespace wale
