#include "runtime/stage/passivity_observer.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace wale {
namespace {

constexpr double least_joule = 20e-6;
constexpr double share_of_impedance = 0.1;  ///< of m/T
constexpr double memory_seconds = 0.1;
constexpr double most_gained = 2;  ///< times the allowed energy

/// The lag that counts: none if the damping is assumed.
Lag lag_of(DeviceProfile profile) {
  if (!profile.damping_known) profile.delay_x = profile.delay_y = profile.bandwidth_x = profile.bandwidth_y = 0;
  return Lag(profile);
}

}  // namespace

PassivityObserver::PassivityObserver(const DeviceProfile& profile)
    : lag_(lag_of(profile)),
      late_(1 + 2 * std::max(lag_.periods().x, lag_.periods().y)),
      period_(1 / profile.rate),
      per_answer_(profile.rate / (0.5 + lag_.periods())),
      count_(profile.position_step()),
      damping_(profile.damping),
      largest_damping_(share_of_impedance * profile.mass * profile.rate / late_) {}

Force PassivityObserver::operator()(Force force, glm::dvec2 position, long periods) noexcept {
  const glm::dvec2 field(force);
  if (!begun_) {
    begun_ = true;
    lag_.begin({.force = glm::dvec2(0), .place = position_ = position});
  }
  const auto count = static_cast<double>(std::max(1L, periods));
  const double elapsed = period_ * count;
  const glm::dvec2 step = position - position_, middle = 0.5 * (position_ + position);
  const Lag::Answer felt = lag_.over({.force = held_, .place = position_}, periods);
  const glm::dvec2 per_answer = count == 1 ? per_answer_ : 1.0 / (0.5 * elapsed + period_ * lag_.periods());
  gained_ += glm::dot(felt.force - 0.5 * (field_ + field) - damping_ * per_answer * (middle - felt.place), step);

  const double fading = 1 - std::min(1.0, elapsed * (1 / memory_seconds));
  const double length = glm::length(step);
  recent_force_ = std::max(glm::length(field), recent_force_ * fading);
  recent_step_ = std::max(length, recent_step_ * fading);
  const double allowed = least_joule + recent_force_ * late_ * (recent_step_ + count_);
  gained_ = std::clamp(gained_, 0.0, most_gained * allowed);

  position_ = position;
  field_ = field;
  if (!(gained_ > allowed) || length == 0 || largest_damping_ == 0) return force;
  ++acted_;
  // Held for one period at this speed, the damping absorbs the energy beyond the allowance.
  const double damping = std::min((gained_ - allowed) * elapsed / (length * length), largest_damping_);
  return Force(field - step * (damping / elapsed));
}

}  // namespace wale
