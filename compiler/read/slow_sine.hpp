#pragma once

#include <optional>

#include "compiler/read/still_forces.hpp"

namespace wale {

/// A sine of one to a few periods over the patch, and the line beside it.
struct SlowSine {
  glm::dvec2 waves{0};  ///< periods over a metre
  LinearForce line;
};

/// The sine, too slow to be seen by its repeating, that with a line tells the force as well as that is computed. Nothing if
/// none does.
std::optional<SlowSine> slow_sine(const StillForces& whole);

}  // namespace wale
