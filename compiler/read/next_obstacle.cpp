#include "compiler/read/next_obstacle.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/read/tolerances.hpp"

namespace wale {
namespace {

constexpr std::size_t every_bend = 6;        // that is tried, before it is fitted
constexpr double first_period_share = 0.25;  // of half the patch: between the centres that are tried for round walls
constexpr int centres_aside = 2;

}  // namespace

SortedWays::SortedWays(std::span<const glm::dvec2> places) {
  for (std::size_t i = 0; i < ways_.size(); ++i) {
    const double angle = static_cast<double>(i) * std::numbers::pi / ways_tried;
    ways_[i] = Way(places, {std::cos(angle), std::sin(angle)});
  }
}

SortedWays::Way::Way(std::span<const glm::dvec2> places, glm::dvec2 way) : along(way) {
  for (std::size_t k = 0; k < places.size(); ++k) order.emplace_back(glm::dot(places[k], along), k);
  std::ranges::sort(order);
}

NextObstacle::NextObstacle(const SortedWays& ways, std::span<const glm::dvec2> places, std::span<const glm::dvec2> rest)
    : ways_(ways), places_(places), rest_(rest) {
  for (const glm::dvec2& place : places) half_ = glm::max(half_, glm::abs(place));
}

Candidate NextObstacle::found(const Kinds& kinds, const std::vector<Wall>& beside) {
  for (const Wall& each : beside)
    if (kinds.straight && !each.round()) try_straight({places_, each.inward}, kinds.jumps);
  if (kinds.round) {
    try_round();
    return std::move(best_);
  }
  const glm::dvec2 push = axis_of_rest();
  for (const SortedWays::Way& way : ways_.all()) {
    if (kinds.straight) try_straight(way, kinds.jumps);
    if (!kinds.steps) continue;
    try_step(way, push);
    try_step(way, glm::dvec2(-push.y, push.x));
  }
  return std::move(best_);
}

/// The axis along which the rest pushes most.
glm::dvec2 NextObstacle::axis_of_rest() const {
  double xx = 0, xy = 0, yy = 0;
  for (const glm::dvec2& each : rest_) xx += each.x * each.x, xy += each.x * each.y, yy += each.y * each.y;
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  return {std::cos(angle), std::sin(angle)};
}

/// What a bend explains of the parts of the rest along `push`, over the places along a way.
std::pair<Bend, double> NextObstacle::bend_along(const SortedWays::Way& way, glm::dvec2 push, BendKind kind) const {
  std::vector<PlaceOnLine> line;
  line.reserve(places_.size());
  double squares = 0;
  for (const auto& [at, place] : way.order) {
    line.push_back({at, glm::dot(rest_[place], push)});
    squares += line.back().value * line.back().value;
  }
  const Bend best = best_bend_of_sorted(std::move(line), kind, every_bend);
  return {best, squares / static_cast<double>(places_.size()) - best.left};
}

void NextObstacle::try_straight(const SortedWays::Way& way, bool jump) {
  const auto [best, explained] = bend_along(way, way.along, jump ? BendKind::bends_and_jumps : BendKind::bends);
  if (!(explained > best_.explained)) return;
  // Where it is less steep beyond the bend, the wall is on the other side.
  const double side = best.slope > 0 ? -1 : 1;
  best_ = {{{{.inward = side * way.along,
              .offset = side * best.at,
              .stiffness = std::abs(best.slope),
              .preload = -best.jump > least_force ? -best.jump : 0}},
            {},
            {}},
           explained};
}

void NextObstacle::try_step(const SortedWays::Way& way, glm::dvec2 push) {
  const auto [best, explained] = bend_along(way, push, BendKind::jumps);
  if (explained > best_.explained) best_ = {{{}, {{way.along, best.at, first_width, best.jump * push}}}, explained};
}

/// A round wall about a point; returns what it explains.
double NextObstacle::try_round(glm::dvec2 centre) {
  std::vector<PlaceOnLine> line(places_.size());
  double squares = 0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const glm::dvec2 off = places_[i] - centre;
    const double far = glm::length(off);
    line[i] = {far, far > 0 ? glm::dot(rest_[i], off / far) : 0};
    squares += line[i].value * line[i].value;
  }
  const Bend best = best_bend(line, BendKind::bends, every_bend);
  const double explained = squares / static_cast<double>(places_.size()) - best.left;
  // Outwards ever less: a wall around. Inwards ever more: within it, and the even force is that outside.
  if (explained > best_.explained && best.at > 0)
    best_ = {{{{.centre = centre, .offset = best.at, .fills = best.slope > 0, .stiffness = std::abs(best.slope)}}, {}},
             explained};
  return explained;
}

void NextObstacle::try_round() {
  glm::dvec2 best{0};
  double most = -1;
  const auto look = [&](glm::dvec2 centre) {
    const double here = try_round(centre);
    if (here > most) most = here, best = centre;
  };
  for (int row = -centres_aside; row <= centres_aside; ++row)
    for (int column = -centres_aside; column <= centres_aside; ++column)
      look(first_period_share * half_ * glm::dvec2(column, row));
  for (double step = 0.5 * first_period_share; step > 0.05; step *= 0.5) {
    const glm::dvec2 middle = best;
    for (const glm::dvec2 aside : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)})
      look(middle + step * aside * half_);
  }
}

}  // namespace wale
