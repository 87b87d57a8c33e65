#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <span>

#include "compiler/read/obstacles.hpp"

namespace wale {

/// Where a round hill may be in forces that are means over the cells of a square lattice: where they are curved in one
/// place, and elsewhere in lines at most. It pushes nothing yet. Nothing if they are curved in no one place, or nearly
/// everywhere.
std::optional<Hill> likely_hill(std::span<const glm::dvec2> places, std::span<const glm::dvec2> forces);

}  // namespace wale
