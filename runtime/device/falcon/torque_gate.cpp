#include "runtime/device/falcon/torque_gate.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace wale::falcon {

double steps_per_newton_metre(double full_newton) noexcept {
  const auto angles = inverse(workspace_centre);
  const glm::dmat3 by_force = glm::inverse(glm::transpose(*turning(workspace_centre, *angles)));
  double worst = 0;  // N m per N
  for (int i = 0; i < 3; ++i) worst = std::max(worst, std::hypot(by_force[0][i], by_force[1][i]));
  return most_torque / (worst * full_newton);
}

ForceLimits for_moving_handle(ForceLimits limits) noexcept {
  constexpr double growth = 0.025;
  limits.most_newton /= 1 + growth;
  return limits;
}

TorqueGate::TorqueGate(const ForceLimits& limits, double most_across)
    : steps_per_newton_metre_(steps_per_newton_metre(limits.peak.x)),
      gain_(limits.gain, std::max(limits.gain.x, limits.gain.y)),
      most_(limits.peak, most_across),
      most_newton_(limits.most_newton) {}

/// How many times the force is as large as it may be.
double TorqueGate::excess(const glm::dmat3& turning, const Torques& torques) const noexcept {
  const glm::dvec3 steps(torques[0], torques[1], torques[2]);
  const glm::dvec3 force = gain_ * force_by(turning, steps / steps_per_newton_metre_);
  double most = glm::length(force) / most_newton_;
  for (int axis = 0; axis < 3; ++axis) most = std::max(most, std::abs(force[axis]) / most_[axis]);
  return most;
}

Torques TorqueGate::within(const Torques& torques, const Encoders& encoders) const noexcept {
  if (!(steps_per_newton_metre_ > 0) || torques == Torques{}) return {};
  const glm::dvec3 angles = angles_of(encoders);
  const auto place = forward(angles);
  const auto turning = place ? falcon::turning(*place, angles) : std::nullopt;
  if (!turning) return {};
  const double whole = excess(*turning, torques);
  if (whole <= 1) return torques;
  // Rounding each torque toward zero may still make the force larger where motors push against each other.
  constexpr int attempts = 64;
  for (int left = attempts; left > 0; --left) {
    Torques smaller;
    for (std::size_t i = 0; i < smaller.size(); ++i)
      smaller[i] = static_cast<std::int16_t>(torques[i] * (left / (attempts * whole)));
    if (excess(*turning, smaller) <= 1) return smaller;
  }
  return {};
}

}  // namespace wale::falcon
