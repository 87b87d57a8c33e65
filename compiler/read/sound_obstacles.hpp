#pragma once

#include <glm/vec2.hpp>
#include <span>

#include "compiler/read/obstacle_fit.hpp"

namespace wale {

/// Whether walls and steps are such as stand in a patch: none that is hardly there, no two in the same place, none that
/// changes the force by more than the force changes.
bool is_sound(const ObstacleFit& fit, std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces);

}  // namespace wale
