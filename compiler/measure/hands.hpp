#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "wale/program.hpp"

namespace wale {

/// Whether the force depends on more than the place: on motion, time or the button.
bool depends_on_the_moment(const PatchProgram& program);

/// `count` hands at rest, spread evenly over the rectangle with half extents `extent` (m): the first points of a fixed
/// lattice.
std::vector<Hand> hands_at_rest(std::size_t count, glm::vec2 extent);

/// The first `count` of those hands in motion: velocities spread evenly up to `speed` (m/s) along each axis,
/// accelerations of both signs, times within a minute, the button down for every other hand.
std::vector<Hand> hands_in_motion(std::size_t count, glm::vec2 extent, float speed);

/// Sets the time, accelerations and button of a moving hand from its place, velocity and number `i`.
void give_a_moment(Hand& hand, std::size_t i);

}  // namespace wale
