#include "compiler/read/two_axes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "compiler/read/tolerances.hpp"

namespace wale {
namespace {

constexpr double slowest_whole = 0.05;    // m/s: no friction rises longer
constexpr double not_on_a_line = 0.01;   // of the greatest force
constexpr double alike_frictions = 0.02;  // relative, and as the sine of an angle
constexpr double plainly_other = 0.035;   // rad: two degrees

/// What a friction leaves at rest, and what is in proportion to the speed.
struct OverSpeeds {
  glm::dvec2 friction{0}, damping{0};
};

/// A line over the speeds of some strokes; nothing if they are on none.
std::optional<OverSpeeds> line_over(const std::vector<Stroke>& strokes, const std::vector<glm::dvec2>& opposed,
                                    std::size_t first, std::size_t end) {
  double count = 0, speeds = 0, squares = 0, most = 0;
  glm::dvec2 sum{0}, product{0};
  for (std::size_t i = first; i < end; ++i) {
    const double speed = strokes[i].speed;
    if (speed < slowest_whole) continue;
    count += 1, speeds += speed, squares += speed * speed, sum += opposed[i], product += speed * opposed[i];
    most = std::max(most, glm::length(opposed[i]));
  }
  const double spread = count * squares - speeds * speeds;
  if (!(spread > 0)) return std::nullopt;
  OverSpeeds found;
  found.damping = (count * product - speeds * sum) / spread;
  found.friction = (sum - speeds * found.damping) / count;
  for (std::size_t i = first; i < end; ++i) {
    if (strokes[i].speed < slowest_whole) continue;
    const glm::dvec2 off = opposed[i] - found.friction - strokes[i].speed * found.damping;
    if (glm::length(off) > std::max(0.1 * least_force, not_on_a_line * most)) return std::nullopt;
  }
  return found;
}

double crossed(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

}  // namespace

std::optional<TwoAxes> two_axes(const std::vector<Stroke>& strokes, const std::vector<glm::dvec2>& opposed) {
  const std::size_t half = strokes.size() / 2;
  const auto along_x = line_over(strokes, opposed, 0, half), along_y = line_over(strokes, opposed, half, strokes.size());
  if (!along_x || !along_y) return std::nullopt;
  const Principal damping = principal_of(along_x->damping, along_y->damping, least_damping);
  if (!damping.directed() || std::abs(damping.greatest) < least_damping) return std::nullopt;
  // A friction along one axis pushes along that and is whole on any stroke, whose sign alone it knows.
  const glm::dvec2 one = along_x->friction, other = along_y->friction;
  const double size = glm::length(one), across = glm::length(other);
  if (std::min(size, across) < least_force || std::abs(size - across) > alike_frictions * size) return std::nullopt;
  if (std::abs(crossed(one, other)) > alike_frictions * size * across) return std::nullopt;
  // It opposes the hand, or it is none.
  if (!(one.x > 0) || !(other.y > 0)) return std::nullopt;
  const glm::dvec2 axis = glm::normalize(one);
  const double apart = std::abs(crossed(axis, damping.axis)), beside = std::abs(glm::dot(axis, damping.axis));
  if (std::min(apart, beside) < plainly_other) return std::nullopt;
  return TwoAxes{{0.5 * (size + across), 0, axis}, damping};
}

std::optional<TwoAxes> two_frictions(const std::vector<Stroke>& strokes, const std::vector<glm::dvec2>& opposed) {
  const std::size_t half = strokes.size() / 2;
  const auto along_x = line_over(strokes, opposed, 0, half);
  const auto along_y = line_over(strokes, opposed, half, strokes.size());
  if (!along_x || !along_y) return std::nullopt;
  const glm::dvec2 one = along_x->friction, other = along_y->friction;
  const double size = glm::length(one);
  if (size < least_force || std::abs(size - glm::length(other)) > alike_frictions * size) return std::nullopt;
  // Both strokes feel both frictions, one of them turned about: half the sum is one, half the difference the other.
  const glm::dvec2 sum = 0.5 * (one + other), difference = 0.5 * (other - one);
  const bool first = glm::length(sum) >= glm::length(difference);
  const glm::dvec2 greater = first ? sum : difference, smaller = first ? difference : sum;
  if (glm::length(smaller) < least_force) return std::nullopt;
  const glm::dvec2 axis = glm::normalize(greater);
  if (std::min(std::abs(axis.x), std::abs(axis.y)) < plainly_other) return std::nullopt;
  return TwoAxes{{glm::length(greater), glm::length(smaller), axis},
                 principal_of(along_x->damping, along_y->damping, least_damping)};
}

bool shows(const TwoAxes& told, const std::vector<Stroke>& strokes, const std::vector<glm::dvec2>& opposed) {
  const std::size_t half = strokes.size() / 2;
  // On a stroke along one axis the sign along the other is that of what rounding leaves.
  std::vector<glm::dvec2> straight;
  for (std::size_t i = 0; i < opposed.size(); ++i)
    straight.push_back(glm::dot(opposed[i], strokes[i].direction) * strokes[i].direction);
  const auto along = line_over(strokes, straight, 0, half), across = line_over(strokes, straight, half, strokes.size());
  if (!along || !across) return false;
  const double near = alike_frictions * told.friction.greatest;
  return std::abs(glm::dot(along->friction, strokes.front().direction) - told.friction.greatest) < near &&
         std::abs(glm::dot(across->friction, strokes[half].direction) - told.friction.across) < near;
}

}  // namespace wale
