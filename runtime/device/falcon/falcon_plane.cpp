#include "runtime/device/falcon/falcon_plane.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace wale::falcon {
namespace {

constexpr double speed_filter = 0.005;           // s, the time constant: one encoder step in a period is a few cm/s
constexpr std::int64_t longest_pause = 100'000;  // microseconds between pushes before the hold comes in anew

double largest(const glm::dvec3& v) noexcept { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

}  // namespace

FalconPlane::FalconPlane(const ForceLimits& limits, const HoldInPlane& hold)
    : steps_per_newton_metre_(steps_per_newton_metre(limits.peak.x)), limits_(limits), hold_(hold) {}

/// Reduces a force in the plane to the user's limit. Returns the force across the plane that the limit leaves, N.
double FalconPlane::room_across(glm::dvec2& force) const noexcept {
  const double size = glm::length(limits_.gain * force), most = limits_.most_newton;
  if (size > most) force *= most / size;
  const double left = std::max(0.0, most * most - std::min(size * size, most * most));
  return std::sqrt(left) / std::max(limits_.gain.x, limits_.gain.y);
}

bool FalconPlane::see(const Encoders& encoders, std::int64_t now) noexcept {
  const glm::dvec3 angles = angles_of(encoders);
  const auto place = forward(angles);
  const auto turning = place ? falcon::turning(*place, angles) : std::nullopt;
  if (!turning || !torques_for(*turning, glm::dvec3(0))) return false;
  if (is_known_ && now > seen_) {
    const double elapsed = static_cast<double>(now - seen_) * 1e-6;
    speed_out_ += ((place->z - place_.z) / elapsed - speed_out_) * (1 - std::exp(-elapsed / speed_filter));
  }
  place_ = *place;
  turning_ = *turning;
  is_known_ = true;
  seen_ = now;
  return true;
}

FalconPlane::Push FalconPlane::push(glm::dvec2 force, std::int64_t now) noexcept {
  Push push;
  if (!is_known_) return push;
  if (std::isnan(force.x) || std::isnan(force.y)) force = glm::dvec2(0);
  force = {std::clamp(force.x, -1e3, 1e3), std::clamp(force.y, -1e3, 1e3)};  // infinities have no direction
  const double room_for_hold = room_across(force);

  const bool continues = pushed_ >= 0 && now - pushed_ <= longest_pause;
  const double elapsed = continues ? static_cast<double>(now - pushed_) * 1e-6 : 0;
  held_ = continues ? std::min(1.0, held_ + elapsed / hold_.coming_in) : 0;
  pushed_ = now;

  // Positive steps fold the arms in: FalconKinematicStamper.cpp, getForces.
  const auto steps_for = [&](const glm::dvec3& f) { return -steps_per_newton_metre_ * *torques_for(turning_, f); };
  glm::dvec3 steps = steps_for({force.x, force.y, 0});
  if (const double most = largest(steps); most > most_torque) steps *= most_torque / most;

  double hold = 0;
  if (hold_.stiffness > 0) {
    const double wanted = -hold_.stiffness * out_of_plane() - hold_.damping * speed_out_;
    hold = held_ * std::clamp(wanted, -hold_.most, hold_.most);
    hold = std::clamp(hold, -room_for_hold, room_for_hold);
  }
  const glm::dvec3 for_hold = steps_for({0, 0, hold});
  double share = 1;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(steps[i] + for_hold[i]) <= most_torque) continue;
    const double room = for_hold[i] > 0 ? most_torque - steps[i] : -most_torque - steps[i];
    share = std::min(share, std::clamp(room / for_hold[i], 0.0, 1.0));
  }
  glm::dvec3 exerted(0);
  for (int i = 0; i < 3; ++i) {
    const double whole = std::clamp<double>(std::trunc(steps[i] + share * for_hold[i]), -most_torque, most_torque);
    push.torques[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(whole);
    exerted[i] = -whole / steps_per_newton_metre_;
  }
  const glm::dvec3 all = force_by(turning_, exerted);
  push.force = {all.x, all.y};
  push.hold = all.z;
  return push;
}

}  // namespace wale::falcon
