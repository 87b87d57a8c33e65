#pragma once

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <utility>
#include <vector>

#include "compiler/read/room.hpp"
#include "compiler/read/wall.hpp"
#include "wale/program.hpp"

namespace wale {

/// Parallel strokes along one axis.
inline constexpr int stroke_lines = 4;

/// A stroke goes over half of its stretch, back over the whole, and forward over the whole. The first half settles a
/// program with memory. The middles of the other two are evaluated: they pass the same positions, so that forces that
/// depend on position cancel.
struct Stroke {
  glm::dvec2 direction{0}, middle{0};
  double speed = 0;
  long pass = 0;      ///< ticks, an even number
  double counts = 0;  ///< m on either side of the middle: what is looked at
  /// Rounding must not leave one way a place more than the other.
  bool counts_at(double along) const { return std::abs(along) <= counts + 1e-9; }

  long ticks() const { return pass / 2 + 2 * pass; }
  /// A hand at `along` (m from the middle of the stroke), moving there or back.
  Hand hand(double along, bool forth) const;
  /// The distance from the middle in m at a tick, and whether the hand moves there or back.
  std::pair<double, bool> at(long tick, double rate) const;
};

/// Where strokes count.
struct Outside {
  const WallFace* wall = nullptr;

  bool at(glm::dvec2 place) const { return !wall || glm::dot(place - wall->place, wall->inward) <= 0; }
  /// The middle of the patch, or of what a wall leaves of it, m.
  glm::dvec2 middle(glm::dvec2 half) const;
};

/// Half the extent of the patch without its rim, m.
glm::dvec2 half_of(const Bank& bank);

/// How far a line through a place goes on within the patch on both sides, m.
double reach_within(glm::dvec2 half, glm::dvec2 place, glm::dvec2 direction);

/// Strokes along `axis` (of length 1), then as many across it, `stroke_lines` of each speed. Where a resting hand feels
/// all that the device gives, strokes say nothing: they go elsewhere. Each goes on for `settling` (m) before it counts,
/// if the patch is large enough. Those of a program that remembers are at fewer speeds, unless slow ones are wanted.
std::vector<Stroke> strokes_over(const Bank& bank, glm::dvec2 axis, const Outside& outside, const Room& space,
                                 double settling, bool slowly = false);

/// m/s: the speed at which `slow_strokes` go: just above 20 mm/s, up to which a friction may hold a hand.
inline constexpr double slow_stroke_speed = 0.021;

/// One stroke along each axis of some strokes, at that speed.
std::vector<Stroke> slow_strokes(const Bank& bank, const std::vector<Stroke>& strokes);

/// The mean force on each stroke, N, turned about for a hand that goes forth: its part along the stroke opposes the
/// hand, and the other part pushes it aside. States and memories work as they do under a hand; memories stay as they
/// are at the start. Strokes of a program that remembers go on to and fro for so many seconds, at least.
std::vector<glm::dvec2> opposed_on(const Bank& bank, const std::vector<Stroke>& strokes, const Outside& outside,
                                   double seconds = 0);

/// The mean force on each stroke, N, that pushes a hand whichever way it goes, and no resting hand that has just come.
/// For a program without memories over the patch.
std::vector<glm::dvec2> pushed_either_way(const Bank& bank, const std::vector<Stroke>& strokes, const Outside& outside);

/// What motion makes of a force on strokes, N^2: the square of its mean along each, and the mean square of what is
/// beside that mean. Forces of the place and of the time, which resting hands feel too, are in neither.
struct Steadiness {
  double mean = 0, beside = 0;

  /// Whether the mean says how a hand is resisted. A soft bristle that turns about leaves as much beside it; what swings
  /// leaves several times as much.
  bool told_by_mean() const { return 4 * mean >= beside; }
};
/// Of a program that remembers, and no grids; on one line of strokes along each axis.
Steadiness steadiness_of(const Bank& bank, const std::vector<Stroke>& strokes, const Outside& outside);

}  // namespace wale
