#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "wale/program.hpp"

namespace wale {

/// s: so long hands hold still that feel what time brings.
inline constexpr double still_seconds = 8;

/// m: where such hands are, over a patch.
std::vector<glm::dvec2> places_of_rest(const Bank& bank);

/// The forces on hands that hold still at these places for so long, for each tick; empty if they cannot change.
std::vector<std::vector<Force>> felt_at_rest(const Bank& bank);

/// The same on one hand where the force changes most with time, of many places all over the patch; nothing if it hardly
/// changes more there than at one of the places of rest.
std::optional<std::vector<Force>> felt_where_busiest(const Bank& bank);

}  // namespace wale
