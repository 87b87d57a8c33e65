#pragma once

#include "compiler/compare/compare.hpp"
#include "compiler/legibility/read_cues.hpp"

namespace wale {

/// Warns of more textures than people recognise when they feel one alone (W0436): as many as the product of what they
/// recognise of each cue in which the textures differ. Where they differ in a cue for which nobody has published that,
/// there is no bound.
void check_count(const CheckedWorkspace& workspace, const std::vector<LaidPatch>& laid, const Comparer& comparer,
                 const Declarations& declarations, const std::string& device, ReadCues& cues, Diagnostics& diagnostics);

}  // namespace wale
