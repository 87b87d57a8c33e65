#include "compiler/read/drag_by_place.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <vector>

#include "compiler/measure/hands.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/tolerances.hpp"
#include "compiler/read/unlimited.hpp"

namespace wale {
namespace {

constexpr std::size_t hands_all_over = 256, way_count = 8;
constexpr std::size_t fewest_hands = 32;
constexpr double speed_of_hands = 0.2;  // m/s
constexpr double plainly_differs = 0.05,
                 by_place = 0.2;      // of the greater one: two way_count, and two places, that differ
constexpr double surely_differs = 4;  // standard errors of a mean over places
constexpr double as_a_drag = 0.15;    // natural logarithms
constexpr double rarest = 0.05;       // of the places, at either end

/// A mean over places, and its standard error.
struct OverPlaces {
  double mean = 0, error = 0;
};
OverPlaces over(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  OverPlaces found;
  double squares = 0;
  for (const double value : values) found.mean += value / count;
  for (const double value : values) squares += (value - found.mean) * (value - found.mean);
  found.error = std::sqrt(squares) / count;
  return found;
}

double if_it_counts(double newton) { return std::abs(newton) < least_force ? 0 : newton; }

/// The resistance along an axis, and what pushes along it on either way, at some places.
void tell_ways(DragByPlace& found, int axis, const std::vector<double>& against, const std::vector<double>& either) {
  const OverPlaces mean = over(against), differs = over(either);
  const double forth = mean.mean - differs.mean, back = mean.mean + differs.mean;
  const double greater = std::max({std::abs(forth), std::abs(back), least_force});
  if (std::abs(differs.mean) < std::max(plainly_differs * greater, surely_differs * differs.error)) return;
  found.forward[axis] = if_it_counts(forth), found.backward[axis] = if_it_counts(back);
}

void tell_places(DragByPlace& found, double low, double high) {
  const double differs = high - low;
  if (differs < std::max({least_force, by_place * std::max(std::abs(low), std::abs(high)), found.most - found.least}))
    return;
  found.least = if_it_counts(low), found.most = if_it_counts(high);
}

/// Whether what pushes on either way goes with the speed as a drag may: not at all, or in proportion to it or its
/// square root. What a memory stores goes by the time that a stroke takes.
bool goes_with_speed(const std::map<double, std::vector<double>>& either) {
  const double usual = over(either.at(speed_of_hands)).mean;
  return std::ranges::all_of(either, [&](const auto& each) {
    const double times = std::log(over(each.second).mean / usual), proportional = std::log(each.first / speed_of_hands);
    // In logarithms, so that what changes its sign is none.
    return times >= std::min(0.0, proportional) - as_a_drag && times <= std::max(0.0, proportional) + as_a_drag;
  });
}

/// The same on both ways of beginning the strokes: what a memory still takes up after the first turn pushes against the
/// first way, and is not the way's.
std::vector<glm::dvec2> pushed_whichever_begins(const Bank& bank, std::vector<Stroke> strokes, const Outside& outside) {
  std::vector<glm::dvec2> pushes = pushed_either_way(bank, strokes, outside);
  for (Stroke& each : strokes) each.direction = -each.direction;
  const std::vector<glm::dvec2> mirrored = pushed_either_way(bank, strokes, outside);
  for (std::size_t i = 0; i < pushes.size(); ++i) pushes[i] = 0.5 * (pushes[i] + mirrored[i]);
  return pushes;
}

DragByPlace drag_by_strokes(const Bank& bank, const std::vector<Stroke>& strokes,
                            const std::vector<glm::dvec2>& opposed, const Outside& outside) {
  DragByPlace found;
  for (const int axis : {0, 1}) {
    const std::size_t half = strokes.size() / 2, first = axis == 0 ? 0 : half;
    std::vector<Stroke> some;
    std::vector<double> against;
    for (std::size_t i = first; i < first + half; ++i) {
      if (strokes[i].speed == speed_of_hands) against.push_back(opposed[i][axis]);
      if (strokes[i].speed >= 0.5 * speed_of_hands) some.push_back(strokes[i]);
    }
    if (against.empty()) continue;
    const std::vector<glm::dvec2> pushes = pushed_whichever_begins(bank, some, outside);
    std::map<double, std::vector<double>> either;
    for (std::size_t i = 0; i < some.size(); ++i) either[some[i].speed].push_back(pushes[i][axis]);
    if (goes_with_speed(either)) tell_ways(found, axis, against, either.at(speed_of_hands));
    const auto [low, high] = std::ranges::minmax(against);
    tell_places(found, low, high);
  }
  return found;
}

}  // namespace

DragByPlace drag_by_place(const Bank& bank, const std::vector<Stroke>& strokes, const std::vector<glm::dvec2>& opposed,
                          const Outside& outside) {
  const PatchProgram& program = bank.program().description();
  if (!program.grids.empty()) return {};
  if (remembers_anything(program)) return drag_by_strokes(bank, strokes, opposed, outside);
  if (!reads(program, {Input::velocity_x, Input::velocity_y, Input::raw_velocity_x, Input::raw_velocity_y})) return {};
  std::vector<Hand> hands;
  for (const Hand& still : hands_at_rest(hands_all_over, glm::vec2(half_of(bank)))) {
    hands.push_back(still);
    for (std::size_t way = 0; way < way_count; ++way) {
      constexpr double diagonal = std::numbers::sqrt2 / 2;
      // Exactly along the axes, so that a sign of what is no motion is none.
      constexpr std::array<glm::dvec2, way_count> directions = {{{1, 0},
                                                                 {0, 1},
                                                                 {-1, 0},
                                                                 {0, -1},
                                                                 {diagonal, diagonal},
                                                                 {-diagonal, diagonal},
                                                                 {-diagonal, -diagonal},
                                                                 {diagonal, -diagonal}}};
      Hand moving = still;
      moving.velocity = moving.raw_velocity = glm::vec2(speed_of_hands * directions[way]);
      hands.push_back(moving);
    }
  }
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  const double most = program.device.most();
  std::array<std::vector<double>, 4> against;
  std::array<std::vector<double>, 2> one_way;
  std::vector<double> resistance, greatest;
  for (std::size_t i = 0; i < hands.size(); i += 1 + way_count) {
    const Force* const felt = &forces[i];
    if (!outside.at(glm::dvec2(hands[i].position))) continue;
    if (std::any_of(felt, felt + 1 + way_count, [&](const Force& force) { return at_limit(force, most); })) continue;
    double mean = 0, most_on_a_way = 0;
    for (std::size_t way = 1; way <= way_count; ++way) {
      const glm::dvec2 direction = glm::normalize(glm::dvec2(hands[i + way].velocity));
      const double held = -glm::dot(glm::dvec2(felt[way] - felt[0]), direction);
      mean += held / way_count;
      if (std::abs(held) > std::abs(most_on_a_way)) most_on_a_way = held;
      if (way <= against.size()) against[way - 1].push_back(held);
    }
    resistance.push_back(mean), greatest.push_back(most_on_a_way);
    for (const std::size_t axis : {0, 1})
      one_way[axis].push_back(0.5 * (against[axis + 2].back() - against[axis].back()));
  }
  if (resistance.size() < fewest_hands) return {};
  DragByPlace found;
  for (const int axis : {0, 1}) {
    std::vector<double> mean;
    for (std::size_t i = 0; i < resistance.size(); ++i) mean.push_back(0.5 * (against[axis][i] + against[axis + 2][i]));
    tell_ways(found, axis, mean, one_way[axis]);
  }
  std::ranges::sort(resistance);
  const auto rank = static_cast<std::size_t>(rarest * static_cast<double>(resistance.size()));
  tell_places(found, resistance[rank], resistance[resistance.size() - 1 - rank]);
  if (found.least == found.most) return found;
  // What resists on one way only is felt there, and not in the mean.
  std::ranges::sort(greatest);
  const double low = greatest[rank], high = greatest[greatest.size() - 1 - rank];
  if (high - low > found.most - found.least) found.least = if_it_counts(low), found.most = if_it_counts(high);
  return found;
}

}  // namespace wale
