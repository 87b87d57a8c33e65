#pragma once

#include <string>

#include "compiler/declarations/declarations.hpp"
#include "wale/simulated.hpp"

namespace wale {

/// The motion of a simulated person as people type it: `lateral`, `circular`, `press` or `rest`, then perhaps
/// `along x`, `along y` or `along 30 deg` (from x to the left; a circle has no direction), and `at 20 mm, 5 mm`, the
/// middle of the motion from the workspace's centre. Sizes and paces are those of `person`. Any other text is the file
/// of a trace. `units` reads the place. Errors: W0801 and those of `load_trace`.
Result<Motion> motion_of(const std::string& hand, const HandDeclaration& person, const Declarations& units);

}  // namespace wale
