#pragma once

#include <optional>

#include "compiler/read/still_forces.hpp"

namespace wale {

/// The wave of a sine that is too slow to be seen by its repeating, as periods over a metre: it goes on for one to a few
/// periods over the patch, and with a line it tells the force as well as that is computed. Nothing if no sine does.
std::optional<glm::dvec2> slow_sine(const StillForces& whole);

}  // namespace wale
