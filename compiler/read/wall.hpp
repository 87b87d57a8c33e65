#pragma once

#include <cmath>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compiler/read/features.hpp"
#include "compiler/read/obstacles.hpp"
#include "wale/program.hpp"

namespace wale {

/// A face that pushes on one side only, along a straight line or a circle.
struct WallFace {
  glm::dvec2 place{0};     ///< m from the patch's centre: where the force begins
  glm::dvec2 inward{0};    ///< unit vector into the wall
  double stiffness = 0;    ///< N/m: the outward force over depth; of one that bends, where it is deepest
  double damping = 0;      ///< N s/m: added against a hand that moves in, to what drags it outside
  double release = 0;      ///< N s/m: taken away from a hand that moves out
  double preload = 0;      ///< N: with which it pushes where it begins
  double radius = 0;       ///< m: of a round face, of which `place` is one place; 0 if it is straight
  glm::dvec2 centre{0};    ///< m: of a round face
  bool fills = false;      ///< a round wall fills its circle; otherwise it lies around it
  double most = HUGE_VAL;  ///< N: it pushes no harder, since its author limits it
  double power = 1;        ///< of the depth, with which the push grows; 0 if with none
};

/// How far into a wall a hand can go before it leaves the patch, m, and the largest force that pushes it back on the
/// way, N.
struct WallDepth {
  double depth = 0, newton = 0;
};
WallDepth deepest(const Bank& bank, const WallFace& face);

/// Whether a face pushes a hand out of it that goes in, and plainly more than the force outside pushes it in. The far
/// side of what drives the hand away is no wall, nor is the end of a spring that slips.
bool pushes_back(const Bank& bank, const WallFace& face);

/// Where a wall stands, in words: "right of x = 20 mm", "beyond (3, 4) mm towards 53 degrees", "beyond 30 mm
/// from (0, 0) mm, all round".
std::string wall_place(const WallFace& face);

/// The stiffest face of the patch, if it has one: no force over some millimetres, then a force against the motion that
/// grows in proportion to depth over some more. Textures, springs and hills are not walls.
std::optional<WallFace> wall_face(const Bank& bank);

/// The stiffest face among the features of a static force: a profile that is flat up to some place and pushes back in
/// proportion to the depth from there on. A texture may lie over it.
std::optional<WallFace> wall_face(const Bank& bank, const std::vector<Feature>& features);

/// A wall that was found, with its damping; `most` (N) is what its author limits it to.
WallFace wall_face(const Bank& bank, const Wall& wall, double most = HUGE_VAL);

}  // namespace wale
