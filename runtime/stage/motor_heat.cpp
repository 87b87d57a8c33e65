#include "runtime/stage/motor_heat.hpp"

#include <algorithm>
#include <cmath>

namespace wale {
namespace {

/// e^-x for 0 <= x <= 10, by the Taylor series of its 64th root: the bits of libm's result depend on the processor.
double decayed(double x) {
  double sum = 1;
  for (int n = 16; n > 0; --n) sum = 1 - sum * x / (64.0 * n);
  for (int doubling = 0; doubling < 6; ++doubling) sum *= sum;
  return sum;
}

}  // namespace

MotorHeat::MotorHeat(const DeviceProfile& profile)
    : continuous_square_(profile.continuous_newton * profile.continuous_newton) {
  if (continuous_square_ == 0) return;
  const double period = 1 / profile.rate;
  kept_ = decayed(period / profile.heating_seconds);
  // At least two periods, so that one tick cannot heat the motor beyond its limit.
  const double slewing = profile.slew > 0 ? profile.force_newton / (2 * profile.slew) : 0;
  reserve_ = profile.heating_seconds / std::max(slewing, 2 * period);
}

void MotorHeat::elapse(long periods) noexcept {
  if (continuous_square_ == 0) return;
  double kept = kept_, all = 1;
  for (long left = std::max(1L, periods); left > 0; left /= 2, kept *= kept)
    if (left % 2 == 1) all *= kept;
  heat_ = all * heat_ + (1 - all) * (held_ * held_);
  most_ = continuous_square_ + (continuous_square_ - heat_) * reserve_;
}

Force MotorHeat::held_within(Force wanted) const noexcept {
  const glm::dvec2 force(wanted), square = force * force;
  if (!(square.x > most_.x || square.y > most_.y)) return wanted;
  Force held = wanted;
  for (int axis = 0; axis < 2; ++axis)
    if (square[axis] > most_[axis])
      held[axis] = static_cast<float>(std::copysign(std::sqrt(std::max(0.0, most_[axis])), force[axis]));
  return held;
}

}  // namespace wale
