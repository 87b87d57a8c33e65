#pragma once

#include "compiler/preview/canvas.hpp"
#include "compiler/preview/exhibit.hpp"

namespace wale {

/// The surface as plaster under a lamp at the upper left, over the exhibit's square. Steepness is exaggerated to what
/// the eye likes; height is not to scale.
void draw_relief(Canvas& canvas, const PageBox& box, const Bank& bank, const Exhibit& exhibit);

}  // namespace wale
