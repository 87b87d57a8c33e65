#pragma once

#include <optional>

#include "compiler/extract/motion.hpp"
#include "compiler/extract/texture.hpp"
#include "compiler/extract/wall.hpp"

namespace wale {

/// The carriers of percepts in a program's force, whatever its text says. Each carrier is read from its own part of the
/// force, so that none is mistaken for another.
struct Extraction {
  /// N: about the 99th percentile of the force on hands at rest; negative if the force mostly pushes away from the
  /// middle.
  double force = 0;
  TextureForce texture, bumps;
  /// N/m: of the force that draws the hand back, if it is alike over the whole patch and in its middle. A force that
  /// saturates, or a wall, has no single stiffness: 0.
  double stiffness = 0;
  OpposingForce opposing;
  double inertia = 0;  ///< kg
  Vibration vibration;
  std::optional<WallFace> wall;
};

/// Runs the program at this bank's parameters. The bands of periods are those of the percepts. Deterministic.
Extraction extract(const Bank& bank, const PeriodBand& textures, const PeriodBand& bumps);

}  // namespace wale
