#pragma once

#include <vector>

#include "compiler/read/motion.hpp"
#include "compiler/read/strokes.hpp"

namespace wale {

/// The simplest law of friction and damping that fits the strokes (`opposed`: N along each), or the one that fits best.
/// Its `by_speed` are the forces at all speeds, and `explained` says whether the law tells them. Speeds at which the
/// device's limit `most` (N) cuts the force off say nothing about the law if some others do.
OpposingForce law_of(std::vector<Stroke> strokes, std::vector<double> opposed, double most);

/// The mean forces (N) along the strokes of each speed, slow ones first, at the device's limit too.
std::vector<DragAt> mean_drags(const std::vector<Stroke>& strokes, const std::vector<double>& opposed);

}  // namespace wale
