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
#include "wale/memory.hpp"

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
constexpr int lines_through = 6;      // each way along an axis
constexpr double side_by_side = 5e-3;                      // m
constexpr double another_drag = 2 * least_force;           // N, on such a line
constexpr double taken_up = 8e-3, averaged = 6e-3;         // m, at the beginning of a line, and along it
constexpr double short_reach = 10e-3, short_counts = 4e-3;  // m, of a stroke where a line shows more or less

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

/// N: what pushes along an axis whichever way a hand goes, on each stroke. The mean over both ways of beginning it: what
/// a memory still takes up after the first turn pushes against the first way, and is not the way's.
std::vector<double> pushed_along(const Bank& bank, std::vector<Stroke> strokes, int axis, const Outside& outside) {
  if (strokes.empty()) return {};
  const std::vector<glm::dvec2> pushes = pushed_either_way(bank, strokes, outside);
  for (Stroke& each : strokes) each.direction = -each.direction;
  const std::vector<glm::dvec2> mirrored = pushed_either_way(bank, strokes, outside);
  std::vector<double> mean;
  for (std::size_t i = 0; i < pushes.size(); ++i) mean.push_back(0.5 * (pushes[i] + mirrored[i])[axis]);
  return mean;
}

/// Where hands that go all through the patch on lines along an axis are resisted least and most, m. What a hand that
/// rests there feels, having just come, is none of it; what a memory stores may be, so that it is a place to look at.
std::vector<glm::dvec2> least_and_most_on_lines(const Bank& bank, int axis, const Outside& outside) {
  const double rate = bank.program().description().device.rate, most = bank.program().description().device.most();
  const glm::dvec2 half = half_of(bank), along = axis == 0 ? glm::dvec2(1, 0) : glm::dvec2(0, 1);
  const auto apart = static_cast<std::size_t>(averaged / speed_of_hands * rate);
  const auto ticks = static_cast<std::size_t>(2 * half[axis] / speed_of_hands * rate);
  Bank own = bank;
  double least = HUGE_VAL, greatest = -HUGE_VAL;
  glm::dvec2 least_at{0}, greatest_at{0};
  for (int line = 0; line < 2 * lines_through; ++line) {
    const double sense = line % 2 == 0 ? 1 : -1;
    const glm::dvec2 aside = half * glm::dvec2(along.y, along.x) * ((line / 2 + 0.5) / (0.5 * lines_through) - 1);
    Memory memory(own.program());
    std::vector<Hand> still(ticks);
    std::vector<Force> moving(ticks), at_rest(ticks);
    for (std::size_t i = 0; i < ticks; ++i) {
      const double gone = speed_of_hands * (static_cast<double>(i) + 0.5) / rate;
      still[i].position = still[i].workspace = glm::vec2(aside + sense * (gone - half[axis]) * along);
      still[i].time = static_cast<double>(i) / rate;
      Hand hand = still[i];
      hand.velocity = hand.raw_velocity = glm::vec2(sense * speed_of_hands * along);
      if (i == 0) memory.enter(own, hand);
      moving[i] = tick(own, memory, hand);
    }
    tick_all(bank, still, at_rest);
    double sum = 0;
    std::size_t cut = 0;  // of the places that are averaged
    const auto is_cut = [&](std::size_t i) {
      return at_limit(moving[i], most) || !outside.at(glm::dvec2(still[i].position));
    };
    for (std::size_t i = 0; i < ticks; ++i) {
      const auto against = [&](std::size_t k) { return -sense * (moving[k] - at_rest[k])[axis]; };
      sum += against(i), cut += is_cut(i);
      if (i >= apart) sum -= against(i - apart), cut -= is_cut(i - apart);
      if (i < apart || cut > 0 || static_cast<double>(i - apart) < taken_up / speed_of_hands * rate) continue;
      const glm::dvec2 middle(still[i - apart / 2].position);
      if (sum < least) least = sum, least_at = middle;
      if (sum > greatest) greatest = sum, greatest_at = middle;
    }
  }
  return greatest > least ? std::vector{least_at, greatest_at} : std::vector<glm::dvec2>{};
}

/// N: what opposes three strokes to and fro side by side about each of these places, along an axis.
std::vector<std::array<double, 3>> opposed_about(const Bank& bank, int axis, const std::vector<glm::dvec2>& places,
                                                 const Outside& outside) {
  const double rate = bank.program().description().device.rate;
  const glm::dvec2 half = half_of(bank), way = axis == 0 ? glm::dvec2(1, 0) : glm::dvec2(0, 1);
  const double reach = std::min(short_reach, 0.5 * half[axis]), counts = std::min(short_counts, 0.25 * half[axis]);
  const double aside = std::min(side_by_side, 0.25 * half[1 - axis]);
  std::vector<Stroke> strokes;
  for (const glm::dvec2 place : places)
    for (const double to_the_side : {-aside, 0.0, aside}) {
      glm::dvec2 middle = place;
      middle[axis] = std::clamp(middle[axis], reach - half[axis], half[axis] - reach);
      middle[1 - axis] = std::clamp(middle[1 - axis] + to_the_side, -half[1 - axis], half[1 - axis]);
      const long pass = 2 * std::max(2L, std::lround(reach / speed_of_hands * rate));
      strokes.push_back({way, middle, speed_of_hands, pass, counts});
    }
  std::vector<std::array<double, 3>> against(places.size());
  if (strokes.empty()) return against;
  const std::vector<glm::dvec2> opposed = opposed_on(bank, strokes, outside);
  for (std::size_t i = 0; i < opposed.size(); ++i) against[i / 3][i % 3] = opposed[i][axis];
  return against;
}

DragByPlace drag_by_strokes(const Bank& bank, const std::vector<Stroke>& strokes,
                            const std::vector<glm::dvec2>& opposed, const Outside& outside, bool turns_soon) {
  DragByPlace found;
  for (const int axis : {0, 1}) {
    const std::size_t half = strokes.size() / 2, first = axis == 0 ? 0 : half;
    std::vector<Stroke> usual, faster_and_slower;
    std::vector<double> against;
    for (std::size_t i = first; i < first + half; ++i) {
      if (strokes[i].speed == speed_of_hands)
        against.push_back(opposed[i][axis]), usual.push_back(strokes[i]);
      else if (strokes[i].speed >= 0.5 * speed_of_hands)
        faster_and_slower.push_back(strokes[i]);
    }
    if (against.empty()) continue;
    const std::vector<double> either = pushed_along(bank, usual, axis, outside);
    DragByPlace ways = found;
    tell_ways(ways, axis, against, either);
    // Strokes at other speeds take most of the time, and where nothing differs they have nothing to say.
    if (ways.forward != found.forward || ways.backward != found.backward) {
      std::map<double, std::vector<double>> by_speed{{speed_of_hands, either}};
      const std::vector<double> pushes = pushed_along(bank, faster_and_slower, axis, outside);
      for (std::size_t i = 0; i < pushes.size(); ++i) by_speed[faster_and_slower[i].speed].push_back(pushes[i]);
      if (goes_with_speed(by_speed)) found = ways;
    }
    auto [low, high] = std::ranges::minmax(against);
    // Where the usual strokes are all resisted alike, what is near the edge or small may be another matter. A latch that
    // keeps some energy is no drag.
    const bool alike = low >= least_force && high - low < std::max(least_force, by_place * high);
    if (alike && turns_soon && !goes_by_time(bank.program().description())) {
      // The grain of a surface is larger somewhere by chance, and not side by side.
      const auto about = opposed_about(bank, axis, least_and_most_on_lines(bank, axis, outside), outside);
      if (about.size() == 2) {
        const double less = std::ranges::max(about[0]), more = std::ranges::min(about[1]);
        if (less < low - another_drag) low = less;
        if (more > high + another_drag) high = more;
      }
    }
    tell_places(found, low, high);
  }
  return found;
}

}  // namespace

DragByPlace drag_by_place(const Bank& bank, const std::vector<Stroke>& strokes, const std::vector<glm::dvec2>& opposed,
                          const Outside& outside, bool turns_soon) {
  const PatchProgram& program = bank.program().description();
  if (!program.grids.empty()) return {};
  if (remembers_anything(program)) return drag_by_strokes(bank, strokes, opposed, outside, turns_soon);
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
