#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "wale/program.hpp"

namespace wale {

/// A face that pushes on one side and not on the other.
struct WallFace {
  glm::dvec2 place{0};   ///< m from the patch's centre: where the force begins
  glm::dvec2 inward{0};  ///< unit vector into the wall
  double stiffness = 0;  ///< N/m: how the force out of it grows with depth
  double damping = 0;    ///< N s/m: what it adds against a hand that comes in
  double release = 0;    ///< N s/m: what it takes away from a hand that goes out
};

/// The stiffest face of the patch, if it has one: free over some millimetres, then a force against the way in that
/// grows in proportion to depth over some more. A texture, a spring and a hill are no walls.
std::optional<WallFace> wall_face(const Bank& bank);

}  // namespace wale
