#pragma once

#include <vector>

#include "compiler/drawing/canvas.hpp"
#include "compiler/drawing/image_library.hpp"
#include "compiler/preview/exhibit.hpp"

namespace wale {

/// The surface over the exhibit's square, lit from the upper left, with the heights of the memory: `side` by `side`
/// pixels, rows from the top. It is plaster, or has the program's colours. Steepness is exaggerated for the eye; height
/// is not to scale.
std::vector<Colour> relief_colours(const Bank& bank, const Memory* memory, const Exhibit& exhibit,
                                   const ImageLibrary& images, int side);

/// Draws it. Each height stands for a square of so many pixels a side.
void draw_relief(Canvas& canvas, const PageBox& box, const Bank& bank, const Memory* memory, const Exhibit& exhibit,
                 const ImageLibrary& images, int square);

}  // namespace wale
