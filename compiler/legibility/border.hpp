#pragma once

#include <glm/vec2.hpp>
#include <span>

#include "compiler/layout/ground.hpp"
#include "compiler/read/cues.hpp"

namespace wale {

/// By how much the push of one patch differs from the other's along the border between them, N: the mean static force
/// just within each, without what swings about it. Two springs of one stiffness differ so, though no cue of theirs does.
double border_step(const LaidPatch& a, const Cues& cues_of_a, const LaidPatch& b, const Cues& cues_of_b,
                   std::span<const Ground::Crossing> crossings);

}  // namespace wale
