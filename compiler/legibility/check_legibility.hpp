#pragma once

#include <string>
#include <vector>

#include "compiler/compile_workspace.hpp"

namespace wale {

/// Warns of what a hand cannot tell on a workspace, by the reading of its finished programs, each of which is read
/// once: patches that lie wholly behind others (W0429), neighbours of different materials that fade into one another
/// and feel alike (W0428), patches and gaps that are too small for the device's encoder, the speed of the hand `normal`
/// or the textures themselves (W0435), and more textures than people recognise when they feel one alone (W0436).
void check_legibility(const CheckedWorkspace& workspace, const std::vector<LaidPatch>& laid,
                      const Declarations& declarations, const std::string& device, Diagnostics& diagnostics);

}  // namespace wale
