#pragma once

#include <glm/vec2.hpp>
#include <vector>

namespace wale {

/// Whether forces change evenly with the place, but for less than a part of their mean square.
bool changes_evenly(const std::vector<glm::dvec2>& places, std::vector<glm::dvec2> forces, double unevenly = 0.03);

/// N: the force with which a spring ends at both sides, from what it would push beyond these (`off`, not empty). 0 if it
/// is no spring, or ends at one side only.
double end_of_a_spring(const std::vector<glm::dvec2>& places, const std::vector<glm::dvec2>& off);

}  // namespace wale
