#pragma once

#include <cmath>
#include <glm/vec2.hpp>
#include <numbers>

#include "compiler/measure/strokes.hpp"

namespace wale {

inline constexpr double exploring_seconds = 1;  ///< of a hand that strokes, and of one that circles

/// Parts of its speed at which a hand may explore just as well: what a drag takes falls faster with the speed than what
/// a push gives.
inline constexpr double slower_paces[] = {1, 0.5, 0.25, 0.125, 0.0625, 0.03125};

/// The place of an exploring hand, m. It begins at rest at the centre and reaches its full radius after a quarter of
/// `exploring_seconds`.
inline glm::dvec2 exploring_place(double time, double radius, double frequency, bool circles) {
  const double angle = 2 * std::numbers::pi * frequency * time;
  return radius * coming_up(time, exploring_seconds / 4) * glm::dvec2(std::sin(angle), circles ? std::cos(angle) : 0.0);
}

}  // namespace wale
