#pragma once

#include <optional>
#include <vector>

#include "compiler/declarations/declarations.hpp"
#include "compiler/read/coming_force.hpp"
#include "compiler/read/directions.hpp"
#include "compiler/read/held_button.hpp"
#include "compiler/read/motion.hpp"
#include "compiler/read/other_force.hpp"
#include "compiler/read/relief.hpp"
#include "compiler/read/swing.hpp"
#include "compiler/read/wall.hpp"

namespace wale {

/// What a finished program does to a hand, read from its forces, whatever its text says. Each carrier is read from its
/// own part of the force, so that none is mistaken for another.
struct ForceReading {
  StaticForce still;
  /// N/m: of the force that draws the hand back, if it is alike over the patch; along the axis where it is greatest. A
  /// spring that saturates before, or a wall, has no single stiffness: 0.
  double stiffness = 0;
  double stiffness_across = 0;   ///< N/m: across that axis; the same if it is alike in all directions
  glm::dvec2 stiffness_axis{0};  ///< of length 1; (0, 0) if it is alike in all directions
  double at_first = 0;           ///< N: how much more it pushes a hand that has just come than in the mean over time
  /// N: what pushes everywhere alike. Beside a spring, what pushes in the patch's middle.
  glm::dvec2 constant{0};
  /// N: what the law of a spring asks for where `constant` is felt, before any limit cuts it.
  glm::dvec2 asked_in_middle{0};
  std::optional<WallFace> wall;      ///< the stiffest
  double wall_push = 0;              ///< N: with which it pushes a hand at most, that goes in to the patch's edge
  std::vector<WallFace> more_walls;  ///< that stand beside it, the stiffest first
  std::vector<StaticStep> steps;     ///< lines where the force jumps, the largest first
  OpposingForce opposing;
  double breakaway = 0;  ///< N: what makes a resting hand slide, if it is more than the friction of a sliding one
  Mass inertia;          ///< kg
  Swing sway;            ///< slower than 10 Hz
  Swing vibration;
  OtherForce other;
  std::optional<HeldButton> held;  ///< of a program that reads the button
  ComingForce coming;
  Directions directions;
  /// N: the amplitude of single features that push the hand out of their middle, as a hill does; negative if they draw
  /// it in, as a hole does; 0 if they do neither or repeat.
  double outward = 0;

  /// N/m: of all walls but the stiffest together.
  double more_wall_stiffness() const;
  /// N: of all steps together.
  double stepped() const;
  /// N: at which a spring that its author or the device limits grows no more; 0 if nothing limits it.
  double cut_spring() const;
  /// What holding the button adds: to the drag at a speed (m/s), N; to the mass, kg; and to what swings, N.
  double held_drag(double speed) const;
  double held_mass() const;
  double held_swing() const;
  /// N: by how much what swings differs from place to place.
  double uneven_swing() const;
  Principal stiffnesses() const { return {stiffness, stiffness_across, stiffness_axis}; }
  const Relief& relief() const { return still.relief; }
};

/// What is read of a program.
struct ReadParts {
  bool still = true;   ///< hands at rest: trends, walls, the relief
  bool moving = true;  ///< resistance to motion, and what goes by time
};

/// Reads a program at this bank's parameters. The only place where a figure of feel is computed. The forces alone
/// decide it: `declarations`, by which `carrier_of` tells percepts from it, change nothing here. Deterministic. Parts
/// that are not wanted are as those of a program without a force.
ForceReading read(const Bank& bank, const Declarations& declarations, ReadParts wanted = {});

/// The size of a percept's carrier by the percept's extractor, in SI units; nothing if the program has no such carrier,
/// or less of it than the least that counts (read/cue.def).
std::optional<double> carrier_of(const ForceReading& reading, const Percept& percept, const Declarations& declarations);

/// The band of a percept's periods. What lies on the border of two percepts' bands belongs to the finer one, as well as
/// a period is read.
PeriodBand band_of(const Percept& percept, const Declarations& declarations);

}  // namespace wale
