#pragma once

#include <algorithm>
#include <glm/vec2.hpp>

#include "wale/program.hpp"

namespace wale {

/// How far to either side of its centre a hand can stroke a patch, m: not over its rim, and a tenth less.
inline double room_to_stroke(PatchSize size) {
  return 0.9 * std::max(0.0, 0.5 * std::min<double>(size.width, size.height) - size.rim);
}

/// From 0 at time 0 to 1 at `whole` (s), level at both ends and without a jump of the acceleration.
inline double coming_up(double time, double whole) {
  const double u = std::clamp(time / whole, 0.0, 1.0);
  return u * u * u * (10 + u * (6 * u - 15));
}

/// A hand that goes along `place`, a function of the time (s) that gives m: its motion as differences over `step` (s)
/// have it, filtered and raw alike.
template <typename Place>
Hand hand_along(const Place& place, double time, double step) {
  const glm::dvec2 here = place(time), before = place(time - step), earlier = place(time - 2 * step);
  Hand hand;
  hand.position = hand.workspace = glm::vec2(here);
  hand.velocity = hand.raw_velocity = glm::vec2((here - before) / step);
  hand.acceleration = hand.raw_acceleration = glm::vec2((here - 2.0 * before + earlier) / (step * step));
  hand.time = time;
  return hand;
}

}  // namespace wale
