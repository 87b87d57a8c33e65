#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "compiler/read/bend.hpp"
#include "compiler/read/obstacles.hpp"
#include "compiler/read/tolerances.hpp"

namespace wale {
namespace {

constexpr double inner = 0.85;            // of half the patch along each axis: nothing stands there
constexpr double rounding = 1e-4;         // of the largest force beyond a line, which a line leaves there
constexpr double most_of_places = 0.04;   // of an obstacle at the edge; means over small cells show larger ones
constexpr std::size_t fewest_pushed = 12;
constexpr double one_way = 1e-3;          // of the mean square: a push along one axis has no more across it
constexpr double first_turn = 4e-3, last_turn = 5e-5;  // rad
constexpr double explained_at_edge = 1e-3;  // of the mean square, left by the obstacle

/// The places that an obstacle's line crosses, as far inside as outside.
std::vector<PlaceOnLine> about_its_line(std::span<const glm::dvec2> places, std::span<const glm::dvec2> rest,
                                        glm::dvec2 way, glm::dvec2 push, double begins) {
  double last = begins;
  for (const glm::dvec2& place : places) last = std::max(last, glm::dot(place, way));
  std::vector<PlaceOnLine> line;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (const double at = glm::dot(places[i], way); at > 2 * begins - last)
      line.push_back({at, glm::dot(rest[i], push)});
  return line;
}

double mean_square_of(const std::vector<PlaceOnLine>& line) {
  double sum = 0;
  for (const PlaceOnLine& each : line) sum += each.value * each.value;
  return sum / static_cast<double>(std::max<std::size_t>(1, line.size()));
}

/// The unit vector along which some places are least spread, outward.
glm::dvec2 narrow_way(std::span<const glm::dvec2> places) {
  glm::dvec2 middle{0};
  for (const glm::dvec2& place : places) middle += place / static_cast<double>(places.size());
  double xx = 0, xy = 0, yy = 0;
  for (const glm::dvec2& place : places) {
    const glm::dvec2 off = place - middle;
    xx += off.x * off.x, xy += off.x * off.y, yy += off.y * off.y;
  }
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  const glm::dvec2 narrow(-std::sin(angle), std::cos(angle));
  return glm::dot(middle, narrow) > 0 ? narrow : -narrow;
}

}  // namespace

std::optional<Obstacles> obstacle_at_edge(const StillForces& whole, std::span<const glm::dvec2> forces) {
  const std::vector<glm::dvec2>& places = whole.places;
  std::vector<glm::dvec2> inside, there;
  const glm::dvec2 half = 0.5 * inner * whole.size;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::dvec2 off = glm::abs(places[i] - whole.centre);
    if (off.x < half.x && off.y < half.y) inside.push_back(places[i]), there.push_back(forces[i]);
  }
  const LinearForce line = linear_force(inside, there);
  std::vector<glm::dvec2> rest(forces.begin(), forces.end());
  double most = 0;
  for (std::size_t i = 0; i < rest.size(); ++i)
    rest[i] -= line.at(places[i]), most = std::max(most, glm::length(rest[i]));
  if (most < 2 * least_force) return std::nullopt;
  const double none = rounding * most;
  for (std::size_t i = 0; i < inside.size(); ++i)
    if (glm::length(there[i] - line.at(inside[i])) > none) return std::nullopt;
  std::vector<glm::dvec2> pushed;
  glm::dvec2 sum{0};
  double squares = 0;
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (glm::length(rest[i]) > none) pushed.push_back(places[i]), sum += rest[i], squares += glm::dot(rest[i], rest[i]);
  if (pushed.size() < fewest_pushed ||
      static_cast<double>(pushed.size()) > most_of_places * static_cast<double>(rest.size()) || !(glm::length(sum) > 0))
    return std::nullopt;
  const glm::dvec2 push = glm::normalize(sum), across(-push.y, push.x);
  double aside = 0;
  for (const glm::dvec2& each : rest) aside += glm::dot(each, across) * glm::dot(each, across);
  if (aside > one_way * squares) return std::nullopt;
  const auto begins = [&](glm::dvec2 way) {
    double least = HUGE_VAL;
    for (const glm::dvec2& place : pushed) least = std::min(least, glm::dot(place, way));
    return least;
  };
  // A wall pushes straight out.
  const std::vector<PlaceOnLine> into = about_its_line(places, rest, -push, push, begins(-push));
  for (const BendKind kind : {BendKind::bends, BendKind::bends_and_jumps}) {
    const Bend bend = best_bend(into, kind);
    if (!(bend.left < explained_at_edge * mean_square_of(into)) || bend.slope < least_stiffness) continue;
    const double preload = std::max(0.0, bend.jump);
    return Obstacles{{{.inward = -push, .offset = bend.at, .stiffness = bend.slope, .preload = preload}}, {}, {}};
  }
  // The narrow way of places that lie anywhere is a little off.
  const auto step_across = [&](glm::dvec2 way) {
    const Bend bend = best_bend(about_its_line(places, rest, way, push, begins(way)), BendKind::jumps);
    return std::pair(StaticStep{way, bend.at, 0, bend.jump * push}, bend.left);
  };
  auto [step, least] = step_across(narrow_way(pushed));
  for (double turn = first_turn; turn > last_turn; turn *= 0.5)
    for (const double by : {turn, -turn}) {
      const auto [other, here] =
          step_across(glm::normalize(step.way + by * glm::dvec2(-step.way.y, step.way.x)));
      if (here < least) step = other, least = here;
    }
  if (!(least < HUGE_VAL)) return std::nullopt;
  double left = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const glm::dvec2 off = rest[i] - step.at(places[i]);
    left += glm::dot(off, off);
  }
  // At most a place or two lie on the wrong side of a jump.
  if (left > 2.5 / static_cast<double>(pushed.size()) * squares) return std::nullopt;
  return Obstacles{{}, {step}, {}};
}

}  // namespace wale
