#pragma once

#include <algorithm>
#include <glm/vec2.hpp>
#include <limits>

#include "wale/program.hpp"

namespace wale {

/// Gives a hand the distance to the edge of the shape of its patch, m, and how that changes. Outside it is on the edge.
/// Real-time: allocates nothing, takes no lock, makes no system call, does not throw.
inline void meet_edge(Hand& hand, float metres, glm::vec2 slope) noexcept {
  hand.edge = std::max(metres, std::numeric_limits<float>::min());  // 0 would be a rectangle
  hand.edge_slope = slope;
}

}  // namespace wale
