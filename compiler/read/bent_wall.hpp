#pragma once

#include <optional>

#include "compiler/read/features.hpp"
#include "compiler/read/obstacles.hpp"
#include "compiler/read/still_forces.hpp"

namespace wale {

/// A straight wall whose push does not grow in proportion to the depth: with its power 3/2 where two round bodies meet
/// (Hertz 1881; Hunt and Crossley 1975), or with another one.
struct BentWall {
  Wall wall;     ///< its stiffness is the push over the depth where it is deepest, or where a limit (N) is reached
  Feature push;  ///< all of it
};

/// The bent wall in some forces (N, at the places of a lattice) in which one wall was found, or nothing if that one
/// explains them as well.
std::optional<BentWall> bent_wall(const StillForces& whole, const std::vector<glm::dvec2>& forces, const Wall& straight,
                                  double limit);

}  // namespace wale
