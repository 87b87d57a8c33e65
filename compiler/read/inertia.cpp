#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "compiler/measure/hands.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/motion.hpp"
#include "compiler/read/room.hpp"
#include "compiler/read/strokes.hpp"
#include "compiler/read/tolerances.hpp"
#include "compiler/read/unlimited.hpp"

namespace wale {
namespace {

constexpr double speeding_up = 1;  // m/s^2
constexpr int places_a_row = 8;
constexpr double ways_differ = 0.05, places_differ = 0.2;  // of the greater one
constexpr double surely_by_way = 4;                        // standard errors of a mean over places
constexpr double rarest_masses = 0.05;                     // of the places, at either end
constexpr double on_one_way = 1.0 / 3, in_some_places = 0.5;  // of the greater one, or less: no mass

double if_it_weighs(double mass) { return std::abs(mass) < least_mass ? 0 : mass; }

/// The mass at some places on one way and on the way back, kg.
struct OnWays {
  std::vector<double> forth, back;
};

/// Tells what differs between the ways along an axis.
void tell_ways_of(Mass& found, int axis, const OnWays& ways) {
  const auto count = static_cast<double>(ways.forth.size());
  glm::dvec2 mean{0};
  double squares = 0;
  for (std::size_t i = 0; i < ways.forth.size(); ++i) mean += glm::dvec2(ways.forth[i], ways.back[i]) / count;
  for (std::size_t i = 0; i < ways.forth.size(); ++i) {
    const double off = ways.back[i] - ways.forth[i] - (mean.y - mean.x);
    squares += off * off;
  }
  const double greater = std::max({std::abs(mean.x), std::abs(mean.y), least_mass});
  const double apart = std::abs(mean.y - mean.x);
  if (apart < std::max({least_mass, ways_differ * greater, surely_by_way * std::sqrt(squares) / count})) return;
  found.forward[axis] = if_it_weighs(mean.x), found.backward[axis] = if_it_weighs(mean.y);
}

/// Whether one of two masses is none, or much less than the other, or pushes on.
bool far_apart(double a, double b, double share) {
  const double greater = std::max(std::abs(a), std::abs(b)), smaller = std::min(std::abs(a), std::abs(b));
  return greater >= least_mass && !(a * b > 0 && smaller > share * greater);
}

void tell_differences_of(Mass& found, const std::array<OnWays, 2>& ways) {
  for (const int axis : {0, 1}) tell_ways_of(found, axis, ways[static_cast<std::size_t>(axis)]);
  // At each place the greatest, on whichever way.
  std::vector<double> masses;
  for (std::size_t i = 0; i < ways[0].forth.size(); ++i) {
    double greatest = 0;
    for (const OnWays& each : ways)
      for (const double mass : {each.forth[i], each.back[i]})
        if (std::abs(mass) > std::abs(greatest)) greatest = mass;
    masses.push_back(greatest);
  }
  std::ranges::sort(masses);
  const auto rank = static_cast<std::size_t>(rarest_masses * static_cast<double>(masses.size()));
  const double low = masses[rank], high = masses[masses.size() - 1 - rank];
  if (high - low >= std::max(least_mass, places_differ * std::max(std::abs(low), std::abs(high))))
    found.least_by_place = if_it_weighs(low), found.most_by_place = if_it_weighs(high);
  if (far_apart(found.forward.x, found.backward.x, on_one_way) ||
      far_apart(found.forward.y, found.backward.y, on_one_way) ||
      far_apart(found.least_by_place, found.most_by_place, in_some_places))
    found.greatest = found.across = 0, found.axis = {0, 0};
}

}  // namespace

Mass inertia(const Bank& bank) {
  if (!reads(bank.program().description(),
             {Input::acceleration_x, Input::acceleration_y, Input::raw_acceleration_x, Input::raw_acceleration_y}))
    return {};
  const glm::dvec2 half = half_of(bank);
  // One place is sure to have room, if there is any.
  std::vector<glm::dvec2> at = {Room(bank).nearest({})};
  for (int row = 0; row < places_a_row; ++row)
    for (int column = 0; column < places_a_row; ++column)
      at.push_back(half * ((glm::dvec2(column, row) + 0.5) / (0.5 * places_a_row) - 1.0));
  constexpr std::array<glm::dvec2, 5> directions = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {0, 0}}};
  std::vector<Hand> hands;
  for (const glm::dvec2 place : at)
    for (const glm::dvec2 direction : directions) {
      Hand& hand = hands.emplace_back();
      hand.position = hand.workspace = glm::vec2(place);
      hand.acceleration = hand.raw_acceleration = glm::vec2(speeding_up * direction);
    }
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  const double most = bank.program().description().device.most();
  glm::dvec2 by_x{0}, by_y{0};
  std::array<OnWays, 2> ways;
  for (std::size_t i = 0; i < hands.size(); i += directions.size()) {
    const auto cut = [&](const Force& force) { return at_limit(force, most); };
    if (std::any_of(&forces[i], &forces[i] + directions.size(), cut)) continue;
    by_x -= glm::dvec2(forces[i]) - glm::dvec2(forces[i + 1]);
    by_y -= glm::dvec2(forces[i + 2]) - glm::dvec2(forces[i + 3]);
    const Force at_rest = forces[i + 4];
    for (const std::size_t axis : {0, 1}) {
      const int along = static_cast<int>(axis);
      ways[axis].forth.push_back((double{at_rest[along]} - forces[i + 2 * axis][along]) / speeding_up);
      ways[axis].back.push_back((double{forces[i + 2 * axis + 1][along]} - at_rest[along]) / speeding_up);
    }
  }
  const auto places = static_cast<double>(ways[0].forth.size());
  if (places == 0) return {};
  Mass found{principal_of(by_x / (2 * speeding_up * places), by_y / (2 * speeding_up * places), least_mass)};
  tell_differences_of(found, ways);
  return found;
}

}  // namespace wale
