#pragma once

#include "compiler/measure/rehearsal.hpp"
#include "compiler/preview/canvas.hpp"
#include "compiler/preview/exhibit.hpp"

namespace wale {

/// The shapes that a program shows, at the end of its rehearsal, over the exhibit's square and clipped to it; before
/// them, where the program remembers, the ring that is the hand. Shapes that are nowhere (not-a-number, or a thousand
/// pictures away) are left out.
void draw_marks(Canvas& canvas, const PageBox& box, const Exhibit& exhibit, const Rehearsal& rehearsal);

}  // namespace wale
