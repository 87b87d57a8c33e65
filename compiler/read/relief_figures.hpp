#pragma once

#include <vector>

#include "compiler/read/relief.hpp"

namespace wale {

/// The forces of hands at rest, split into trends, waves and the rest.
struct SplitRelief {
  const StillField& field;
  const StillForces& whole;
  const FoundWaves& waves;
  const std::vector<Feature>& features;
  const LinearForce& trend;
  const std::vector<glm::dvec2>& forces;  ///< N, at the places of the whole: without trends
};

/// The percentile that is an amplitude.
inline constexpr double percentile_of_amplitude = 0.99;

/// The value that so large a share of all values, at least a half, lies below; 0 of none.
double percentile(const std::vector<double>& values, double share);

/// Size, period, direction and kind of a relief. `felt` (N) are the forces where they are felt. Less than `misfit` (N)
/// without a wave is what a trend leaves, and none.
Relief figures_of(const SplitRelief& split, const std::vector<glm::dvec2>& felt, double misfit);

}  // namespace wale
