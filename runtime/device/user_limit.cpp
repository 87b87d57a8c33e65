#include "runtime/device/user_limit.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace wale {

UserLimit::UserLimit(const DeviceProfile& profile, double most)
    : given_(most),
      most_(static_cast<float>(most)),
      step_(profile.force_step()),
      peak_(profile.force_newton),
      shaker_(profile.shaker) {
  if (most_ > most) most_ = std::nextafter(most_, 0.0f);
}

Force UserLimit::clamped(Force wanted) const noexcept {
  if (most_ == HUGE_VALF) return wanted;
  const float size = shaker_ ? wanted.x : glm::length(wanted);
  if (!(size > most_)) return wanted;
  return shaker_ ? Force(most_, wanted.y) : wanted * (most_ / size);
}

bool UserLimit::allows(Force exerted) const noexcept { return glm::length(glm::dvec2(exerted)) <= most_; }

Force UserLimit::toward_zero(Force wanted) const noexcept {
  return Force(std::trunc(wanted.x / step_) * step_, std::trunc(wanted.y / step_) * step_);
}

Force UserLimit::in_steps(Force wanted) const noexcept {
  if (most_ == HUGE_VALF || !counts_steps_) return wanted;
  if (shaker_) return vibration_in_steps(wanted);
  if (!(step_ > 0 && step_ < HUGE_VAL)) return wanted;
  const auto nearest = [this](float force) {
    return std::round(std::clamp<double>(force, -peak_, peak_) / step_) * step_;
  };
  if (allows(Force(nearest(wanted.x), nearest(wanted.y)))) return wanted;
  const Force lower = toward_zero(wanted);
  // A clamped force may be longer than allowed by its own rounding, and both axes may lie on steps.
  constexpr float less_than_rounding = 1 - 1e-6f;
  return allows(lower) ? lower : toward_zero(wanted * less_than_rounding);
}

Force UserLimit::vibration_in_steps(Force wanted) const noexcept {
  if (!(shaker_->command_steps > 0)) return wanted;
  const double frequency = std::clamp<double>(wanted.y, shaker_->frequency_low, shaker_->frequency_high);
  const double steps = std::clamp(shaker_->command(wanted.x, frequency), 0.0, 1.0) * shaker_->command_steps;
  const auto given = [&](double whole) { return shaker_->acceleration(whole / shaker_->command_steps, frequency); };
  if (static_cast<float>(given(std::round(steps))) <= most_) return wanted;
  return Force(given(std::floor(steps)), wanted.y);
}

}  // namespace wale
