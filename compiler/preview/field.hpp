#pragma once

#include "compiler/preview/canvas.hpp"
#include "compiler/preview/exhibit.hpp"

namespace wale {

/// The force on a hand at rest as arrows over the exhibit's square or, where `of_velocity`, the force at the patch's
/// centre over velocities up to the exhibit's speed to every side. The ground is the darker the stronger the force.
/// Returns the strongest force shown, N: that of the longest arrow.
double draw_field(Canvas& canvas, const PageBox& box, const Bank& bank, const Exhibit& exhibit, bool of_velocity);

}  // namespace wale
