#pragma once

#include <algorithm>
#include <glm/vec2.hpp>

#include "wale/program.hpp"

namespace wale {

/// How far to both sides of its centre a hand can stroke a patch, m: nine tenths of the way to its rim.
inline double room_to_stroke(PatchSize size) {
  return 0.9 * std::max(0.0, 0.5 * std::min<double>(size.width, size.height) - size.rim);
}

/// A smooth step from 0 at time 0 to 1 at time `whole` (s), with zero slope at both ends and continuous acceleration.
inline double coming_up(double time, double whole) {
  const double u = std::clamp(time / whole, 0.0, 1.0);
  return u * u * u * (10 + u * (6 * u - 15));
}

/// A hand that moves along `place`, a function from time (s) to place (m). Its motion, both filtered and raw, consists
/// of differences over `step` (s).
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
