#pragma once

#include "compiler/drawing/canvas.hpp"
#include "compiler/preview/exhibit.hpp"

namespace wale {

/// The force on a hand at rest as arrows over the exhibit's square; with `of_velocity`, the force at the patch's centre
/// over velocities up to the exhibit's speed. The background is darker where the force is stronger. Returns the
/// strongest force shown, N, by which the arrows are drawn: each is the mean over its square. Each force of the
/// background stands for a square of so many pixels a side.
double draw_field(Canvas& canvas, const PageBox& box, const Bank& bank, const Exhibit& exhibit, bool of_velocity,
                  int square);

}  // namespace wale
