#pragma once

#include <optional>
#include <vector>

#include "compiler/read/features.hpp"
#include "compiler/read/obstacles.hpp"
#include "compiler/read/waves.hpp"

namespace wale {

/// The number of a wave's harmonics that are worth a fit.
std::size_t harmonics_worth(const FoundWave& wave);

/// Walls and steps that stand beside waves.
struct BesideWaves {
  Obstacles obstacles;
  std::vector<Feature> features;  ///< the same as features
  FoundWaves waves;               ///< those beside them
};

/// Looks for walls and steps beside a slow wave. The wave is known from a quarter of the patch where nothing stands;
/// without it they are seen, and then all is fitted together. `whole` are the forces of `field`, `beyond` the same (N)
/// less a line, `features` what is known already, and `waves` those found beside it. Nothing if none stand there.
std::optional<BesideWaves> obstacles_beside_waves(const StillField& field, const StillForces& whole,
                                                  const std::vector<glm::dvec2>& beyond,
                                                  const std::vector<Feature>& features, const FoundWaves& waves);

}  // namespace wale
