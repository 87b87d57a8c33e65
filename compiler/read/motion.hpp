#pragma once

#include <glm/vec2.hpp>

#include "compiler/read/wall.hpp"
#include "wale/program.hpp"

namespace wale {

/// A size that may differ with the direction of the hand, in the unit of the size.
struct Principal {
  double greatest = 0;  ///< of the two principal values, by its size
  double across = 0;    ///< the other one; the same if it is alike in all directions
  glm::dvec2 axis{0};   ///< of length 1: of the greatest; (0, 0) if it is alike in all directions

  bool directed() const { return axis != glm::dvec2(0); }
};

/// The principal values of a resistance: the force against a unit of motion along x, and along y. They are alike if
/// they differ by no more than `least`, or by a tenth.
Principal principal_of(glm::dvec2 by_x, glm::dvec2 by_y, double least);

/// The resistance to a moving hand, without forces that depend on position or time only.
struct OpposingForce {
  /// N: of a hand that slides, at any speed above `saturation_speed`; negative if the force pushes the hand on
  double friction = 0;
  double saturation_speed = 0;  ///< m/s: at which the friction is fully there; 0 if it is at any that was tried
  double damping = 0;           ///< N s/m: in proportion to the speed
  double scatter = 0;           ///< N: standard deviation of the strokes from these laws
  /// Across the axis of the greatest friction and damping; the same as along it if they are alike everywhere.
  double friction_across = 0, damping_across = 0;
  glm::dvec2 friction_axis{0}, damping_axis{0};  ///< as of `Principal`
  double aside = 0;                              ///< N: on a hand at 0.2 m/s, square to its way and turning with it

  Principal frictions() const { return {friction, friction_across, friction_axis}; }
  Principal dampings() const { return {damping, damping_across, damping_axis}; }
};

/// Strokes with hands to and fro at several speeds, along both axes and through several positions. Each goes over the
/// same stretch both ways, so that forces that depend on position only cancel. States and memories work as they do
/// under a hand. Only what is felt outside of `wall` counts, if there is one.
OpposingForce opposing_force(const Bank& bank, const WallFace* wall = nullptr);

/// The mass that opposes the acceleration of a hand at rest, kg: the program's own use of acceleration, with states as
/// on entry.
Principal inertia(const Bank& bank);

}  // namespace wale
