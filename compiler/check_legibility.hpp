#pragma once

#include <string>
#include <vector>

#include "compiler/compile_workspace.hpp"

namespace wale {

/// Warns of what a hand cannot tell on a workspace: patches that lie wholly behind others (W0429), and neighbours of
/// different materials that fade into one another and feel alike on the device (W0428), by the reading of their
/// finished programs. Reads each program that has such a neighbour once.
void check_legibility(const std::vector<LaidPatch>& laid, const Declarations& declarations, const std::string& device,
                      Diagnostics& diagnostics);

}  // namespace wale
