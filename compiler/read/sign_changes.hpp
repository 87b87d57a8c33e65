#pragma once

#include "compiler/read/relief_figures.hpp"

namespace wale {

/// 1/m: how often a relief's force changes its sign along lines of the direction in which it changes, counted there; a
/// force of less than a twentieth of its amplitude has no sign. `finest` (m) is the shortest period that is to be seen.
/// The force is taken along the axis on which it pushes, or along the lines if it has none.
double sign_changes(const SplitRelief& split, const Relief& relief, double finest);

}  // namespace wale
