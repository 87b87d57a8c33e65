#pragma once

#include <optional>

#include "compiler/extract/motion.hpp"
#include "compiler/extract/texture.hpp"
#include "compiler/extract/wall.hpp"

namespace wale {

/// What a program's force is made of, whatever its text says: the carriers of percepts, each read from something of its
/// own, so that none is taken for another.
struct Extraction {
  /// N: about the 99th percentile of the force on hands at rest; below 0 where on the whole it pushes them away from
  /// the middle.
  double force = 0;
  TextureForce texture, bumps;
  /// N/m: of what draws the hand back, alike over the whole patch and in its middle. What saturates, or is a wall, has
  /// no one stiffness, and 0 here.
  double stiffness = 0;
  OpposingForce opposing;
  double inertia = 0;  ///< kg
  Vibration vibration;
  std::optional<WallFace> wall;
};

/// Runs the program at this bank's parameters. The bands are those of the percepts that are read. Deterministic.
Extraction extract(const Bank& bank, const PeriodBand& textures, const PeriodBand& bumps);

}  // namespace wale
