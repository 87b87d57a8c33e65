#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "compiler/read/still_forces.hpp"

namespace wale {

/// The direction (rad) along which alone a relief changes, near the direction `near` (rad); nothing if it changes
/// across that too. `whole` is the field over the patch, `trend` what it has beside the relief, `rms` (N) the relief's
/// size and `grain` (m) about the period of what is finest.
std::optional<double> only_direction(const StillField& field, const StillForces& whole, const LinearForce& trend,
                                     double near, double rms, double grain);

}  // namespace wale
