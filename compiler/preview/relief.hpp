#pragma once

#include "compiler/preview/canvas.hpp"
#include "compiler/preview/exhibit.hpp"

namespace wale {

/// The surface under a lamp at the upper left, over the exhibit's square, as the memory has it: plaster or, where the
/// program says colours, those times the lamp's light, 1 on level ground. Steepness is exaggerated to what the eye
/// likes; height is not to scale.
void draw_relief(Canvas& canvas, const PageBox& box, const Bank& bank, const Memory* memory, const Exhibit& exhibit);

}  // namespace wale
