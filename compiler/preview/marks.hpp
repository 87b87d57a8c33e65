#pragma once

#include "compiler/drawing/canvas.hpp"
#include "compiler/measure/rehearsal.hpp"
#include "compiler/preview/exhibit.hpp"

namespace wale {

/// Draws the marks of a program at the end of its rehearsal, clipped to the exhibit's square; first, if the program has
/// memory, the ring of the hand. Marks without a position (not-a-number, or a thousand pictures away) are left out.
void draw_marks(Canvas& canvas, const PageBox& box, const Exhibit& exhibit, const Rehearsal& rehearsal);

}  // namespace wale
