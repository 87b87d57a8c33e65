#include "compiler/read/drag_by_time.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "compiler/read/dependence.hpp"
#include "compiler/read/tolerances.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

constexpr double looked_for = 8;          // s
constexpr double speed_in_time = 0.2;     // m/s
constexpr long apart_in_time = 61;        // ticks: a prime, so that no vibration keeps step with the moments
constexpr double plainly_changes = 0.1;   // of the mean: standard deviation
constexpr double alike_in_halves = 0.15;  // of the greater one
constexpr double mostly_resists = 0.3;    // of the standard deviation: a lesser mean is none

/// Whether the hand changes nothing that the program remembers, so that any hand may come at any moment.
bool any_hand_any_time(const PatchProgram& program) {
  return !remembers_anything(program) || remembers_time_only(program);
}

/// What resists on the line of a stroke, moment by moment, N: at its middle on both ways at once, or over one way to
/// and fro after the other.
std::vector<double> resistances_in_time(const Bank& bank, const Stroke& stroke) {
  const double rate = bank.program().description().device.rate;
  const auto ticks = static_cast<long>(looked_for * rate);
  const bool any_hand = any_hand_any_time(bank.program().description());
  Bank own = bank;
  Memory forth_memory(own.program()), back_memory(own.program());
  std::vector<double> found;
  double sum = 0;
  long count = 0;
  for (long now = 0; now < ticks; ++now) {
    const auto [along, forth] = any_hand ? std::pair{0.0, true} : stroke.at(now, rate);
    // A hand that rests in the middle feels what is no drag.
    Hand hand = stroke.hand(along, forth), other = stroke.hand(0, false);
    if (!any_hand) other.velocity = other.raw_velocity = glm::vec2(0);
    hand.time = other.time = static_cast<double>(now) / rate;
    if (now == 0) forth_memory.enter(own, hand), back_memory.enter(own, other);
    const glm::dvec2 differs(tick(own, forth_memory, hand) - tick(own, back_memory, other));
    const double against = -glm::dot(differs, stroke.direction);
    if (any_hand) {
      found.push_back(0.5 * against);
      continue;
    }
    if (stroke.counts_at(along)) sum += forth ? against : -against, ++count;
    if ((now + stroke.pass / 2 + 1) % (2 * stroke.pass) != 0) continue;
    // The first way is not whole.
    if (now > 2 * stroke.pass && count > 0) found.push_back(sum / static_cast<double>(count));
    sum = 0, count = 0;
  }
  return found;
}

/// At some moments, every hand on its own from the memory that time has left.
std::vector<glm::dvec2> opposed_at_moments(const Bank& bank, const std::vector<Stroke>& strokes,
                                           const Outside& outside) {
  const double rate = bank.program().description().device.rate;
  const auto ticks = static_cast<long>(looked_for * rate);
  Bank own = bank;
  Memory clock(own.program());
  std::vector<glm::dvec2> sums(strokes.size());
  std::vector<long> counts(strokes.size());
  long moment = 0;
  for (long now = 0; now < ticks; ++now) {
    Hand still;
    still.time = static_cast<double>(now) / rate;
    if (now == 0) clock.enter(own, still);
    if (now % apart_in_time == 0) {
      const double part = std::fmod(0.5 + static_cast<double>(moment++) * 0.618034, 1.0);
      for (std::size_t i = 0; i < strokes.size(); ++i) {
        std::array<glm::dvec2, 2> felt{};
        const double along = strokes[i].counts * (2 * part - 1);
        for (const bool forth : {false, true}) {
          Hand hand = strokes[i].hand(along, forth);
          hand.time = still.time;
          Memory memory = clock;
          felt[forth] = glm::dvec2(tick(own, memory, hand));
        }
        if (!outside.at(strokes[i].middle + along * strokes[i].direction)) continue;
        sums[i] += 0.5 * (felt[0] - felt[1]), ++counts[i];
      }
    }
    tick(own, clock, still);
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= static_cast<double>(std::max(1L, counts[i]));
  return sums;
}

}  // namespace

DragByTime drag_by_time(const Bank& bank, const std::vector<Stroke>& strokes) {
  DragByTime told;
  if (!goes_by_time(bank.program().description())) return told;
  for (const std::size_t first : {std::size_t{0}, strokes.size() / 2}) {
    const auto stroke = std::ranges::find(strokes.begin() + static_cast<std::ptrdiff_t>(first), strokes.end(),
                                          speed_in_time, &Stroke::speed);
    if (stroke == strokes.end()) continue;
    const std::vector<double> all = resistances_in_time(bank, *stroke);
    if (all.size() < 4) continue;
    const auto count = static_cast<double>(all.size());
    double mean = 0, earlier = 0, squares = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      mean += all[i] / count;
      if (i < all.size() / 2) earlier += all[i];
    }
    earlier /= static_cast<double>(all.size() / 2);
    const double later = 2 * mean - earlier;
    for (const double each : all) squares += (each - mean) * (each - mean);
    const double deviation = std::sqrt(squares / count);
    if (deviation < std::max(least_force, plainly_changes * std::abs(mean))) continue;
    const auto [low, high] = std::ranges::minmax(all);
    const bool alike = std::abs(later - earlier) <=
                           std::max(least_force, alike_in_halves * std::max(std::abs(earlier), std::abs(later))) &&
                       std::abs(mean) >= mostly_resists * deviation;
    told.has_mean = alike && (told.has_mean || !told.changes);
    if (!told.changes || high - low > told.most - told.least) told.least = low, told.most = high;
    told.changes = true;
  }
  return told;
}

std::vector<glm::dvec2> opposed_over_time(const Bank& bank, const std::vector<Stroke>& strokes,
                                          const Outside& outside) {
  if (any_hand_any_time(bank.program().description())) return opposed_at_moments(bank, strokes, outside);
  return opposed_on(bank, strokes, outside, looked_for);
}

}  // namespace wale
