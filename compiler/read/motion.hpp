#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <utility>
#include <vector>

#include "compiler/read/wall.hpp"
#include "wale/program.hpp"

namespace wale {

/// A size that may differ with the direction of the hand, in the unit of the size.
struct Principal {
  double greatest = 0;  ///< of the two principal values, by its size
  double across = 0;    ///< the other one; the same if it is alike in all directions
  glm::dvec2 axis{0};   ///< of length 1: of the greatest; (0, 0) if it is alike in all directions

  bool directed() const { return axis != glm::dvec2(0); }
  /// Along a way of length 1.
  double along(glm::dvec2 way) const;
};

/// The principal values of a resistance: the force against a unit of motion along x, and along y. They are alike if
/// they differ by no more than `least`, or by a tenth.
Principal principal_of(glm::dvec2 by_x, glm::dvec2 by_y, double least);

/// Two such sizes along one axis: that along which they differ most.
std::pair<double, double> where_they_differ(const Principal& one, const Principal& other, double least);

/// The force against a hand at one speed, over ways to and fro.
struct DragAt {
  double speed = 0;   ///< m/s
  double newton = 0;  ///< negative if it pushes the hand on
};

/// The resistance to a moving hand, without forces that depend on position or time only.
struct OpposingForce {
  /// N: of a hand that slides, at any speed above `saturation_speed`; negative if the force pushes the hand on
  double friction = 0;
  double saturation_speed = 0;  ///< m/s: at which the friction is fully there; 0 if it is at any that was tried
  double damping = 0;           ///< N s/m: in proportion to the speed
  double limit = 0;             ///< N: at which the damping is cut, within the speeds that were tried; 0 if at none
  double scatter = 0;           ///< N: standard deviation of the strokes from these laws
  /// Across the axis of the greatest friction and damping; the same as along it if they are alike everywhere.
  double friction_across = 0, damping_across = 0;
  glm::dvec2 friction_axis{0}, damping_axis{0};  ///< as of `Principal`
  double aside = 0;                              ///< N: on a hand at 0.2 m/s, square to its way and turning with it
  /// The friction is so much at least: it still grows where the patch ends.
  bool friction_grows = false;
  bool friction_cut = false;  ///< it is so much at least: the device gives no more

  /// Whether one friction and one viscosity tell the resistance; otherwise those are none.
  bool explained = true;
  /// The resistance by speed, slow ones first; along the axis where it is greatest.
  std::vector<DragAt> by_speed;
  /// The same along x and along y, whatever the axis.
  std::array<std::vector<DragAt>, 2> along;
  double exponent = 0;  ///< of the speed, to whose power that resistance grows; 0 if to none
  /// N at 0.2 m/s: the resistance to a hand that goes towards +x and +y, and towards -x and -y, if they differ.
  glm::dvec2 forward{0}, backward{0};
  /// N at 0.2 m/s: the resistance at the places where it is least and greatest, if it is not alike everywhere.
  double least_by_place = 0, most_by_place = 0;

  /// Whether the resistance changes with time; then N at 0.2 m/s, over some seconds. The law is that of the mean, if
  /// there is one.
  bool changes_in_time = false;
  double least_in_time = 0, most_in_time = 0;

  /// Whether the resistance changes as a hand goes to and fro over one place; then N at 0.2 m/s, the first time and after
  /// `way_of_use`, m. The law is that of the mean over some strokes.
  bool changes_by_use = false;
  double at_first_use = 0, after_use = 0, way_of_use = 0;

  Principal frictions() const { return {friction, friction_across, friction_axis}; }
  Principal dampings() const { return {damping, damping_across, damping_axis}; }
  /// N s/m: with which a friction grows from rest, if exploring hands are often too slow to feel it whole; 0 otherwise.
  double rise() const;
  /// Whether a hand is resisted, or pushed on, in a way that one friction or one viscosity alone does not tell.
  bool by_no_figure() const;
  /// N at a speed (m/s), whether it is explained or not.
  double at(double speed) const;
  /// N at a speed (m/s), if it is not explained; 0 otherwise.
  double unexplained_at(double speed) const;
  /// N at 0.01 m/s, if it is not explained and was looked at; 0 otherwise.
  double creeping() const;
  /// N at 0.2 m/s: what pushes a hand along each axis, whichever way it goes, and no resting one.
  glm::dvec2 one_way() const { return 0.5 * (backward - forward); }
  /// N at 0.2 m/s: by how much the resistance differs from place to place.
  double uneven() const { return most_by_place - least_by_place; }
  /// N at 0.2 m/s: by how much the resistance is less after some use; negative if it is more.
  double lost_by_use() const { return at_first_use - after_use; }
};

/// N: two drags at a speed (m/s) as means over the same ways, along x or along y: where they differ most.
std::pair<double, double> drags_where_they_differ(const OpposingForce& one, const OpposingForce& other, double speed);

/// Strokes with hands to and fro at several speeds, along both axes and through several positions. Each goes over the
/// same stretch both ways, so that forces that depend on position only cancel. States and memories work as they do
/// under a hand. Only what is felt outside of `wall` counts, if there is one.
OpposingForce opposing_force(const Bank& bank, const WallFace* wall = nullptr);

/// What opposes the acceleration of a hand at rest, kg. One that is mostly on one way or in a part of the patch is no
/// mass: then the principal values are 0.
struct Mass : Principal {
  /// On a hand that speeds up towards +x and +y, and towards -x and -y, if they differ.
  glm::dvec2 forward{0}, backward{0};
  /// At the places where it is least and greatest, if it is not alike everywhere.
  double least_by_place = 0, most_by_place = 0;

  /// kg: by how much it is more along each axis on the way back than on the way forth.
  glm::dvec2 one_way() const { return backward - forward; }
  /// kg: by how much it differs from place to place.
  double uneven() const { return most_by_place - least_by_place; }
  /// Whether one figure tells it.
  bool is_one() const { return one_way() == glm::dvec2(0) && uneven() == 0; }
};

/// The program's own use of acceleration, with states as on entry.
Mass inertia(const Bank& bank);

}  // namespace wale
