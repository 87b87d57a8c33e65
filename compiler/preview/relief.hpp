#pragma once

#include "compiler/drawing/canvas.hpp"
#include "compiler/drawing/image_library.hpp"
#include "compiler/preview/exhibit.hpp"

namespace wale {

/// Draws the surface over the exhibit's square, lit from the upper left, with the heights of the memory. It is plaster,
/// or has the program's colours. Steepness is exaggerated for the eye; height is not to scale. Each height stands for a
/// square of so many pixels a side.
void draw_relief(Canvas& canvas, const PageBox& box, const Bank& bank, const Memory* memory, const Exhibit& exhibit,
                 const ImageLibrary& images, int square);

}  // namespace wale
