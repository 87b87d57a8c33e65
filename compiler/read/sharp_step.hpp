#pragma once

#include "compiler/read/obstacles.hpp"
#include "wale/program.hpp"

namespace wale {

/// Looks closely at a step that was found among coarse samples. Where the force jumps, its line, its place and its size
/// become exact to about a micrometre and its width 0; otherwise the step stays as it was found.
void sharpen(const Bank& bank, StaticStep& step);

}  // namespace wale
