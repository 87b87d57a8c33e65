#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "wale/program.hpp"

namespace wale {

/// Whether the force depends on more than place: on motion, on time, on the button.
bool depends_on_the_moment(const PatchProgram& program);

/// `count` hands at rest, spread evenly over the rectangle of half extents `extent` (m): the first so many points of
/// one lattice.
std::vector<Hand> hands_at_rest(std::size_t count, glm::vec2 extent);

/// The first `count` of those hands, moving: velocities spread evenly up to `speed` (m/s) along each axis,
/// accelerations of either sign, moments over a minute, the button down for every other one.
std::vector<Hand> hands_in_motion(std::size_t count, glm::vec2 extent, float speed);

/// Gives a moving hand what a moving hand has besides place and velocity; `i` tells hands apart.
void give_a_moment(Hand& hand, std::size_t i);

}  // namespace wale
