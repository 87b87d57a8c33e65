#include "compiler/read/coming_force.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "compiler/measure/hands.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/strokes.hpp"
#include "compiler/read/tolerances.hpp"
#include "wale/batch.hpp"

namespace wale {
namespace {

constexpr std::size_t hands_waiting = 8, hands_looking = 1024, best_hands = 4;
constexpr double half_there = 0.5;
constexpr double everywhere_alike = 0.8;
constexpr double patience = 60;         // s, of a program that remembers time
constexpr double longest_wait = 1e4;    // s
constexpr double waits_grow = 1.01;     // from one moment to the next
constexpr double first_spread = 0.02;   // of half the patch: beside the best places
constexpr double finest_spread = 1e-5;  // likewise

/// The root mean square over places of what changed since the first of some moments, and its mean.
struct ChangeAt {
  double seconds = 0, size = 0;
  double gained = 0;  ///< N^2: by how much the mean square of the force is more
  glm::dvec2 mean{0};
};

ChangeAt change_at(double seconds, const std::vector<Force>& first, const std::vector<Force>& now) {
  ChangeAt found{.seconds = seconds};
  for (std::size_t i = 0; i < now.size(); ++i) {
    const glm::dvec2 change = glm::dvec2(now[i]) - glm::dvec2(first[i]);
    found.gained += (glm::dot(now[i], now[i]) - glm::dot(first[i], first[i])) / static_cast<double>(now.size());
    found.size += glm::dot(change, change), found.mean += change / static_cast<double>(now.size());
  }
  found.size = std::sqrt(found.size / static_cast<double>(now.size()));
  return found;
}

/// s: when the first half of the largest change is there; 0 if none comes.
double half_there_at(const std::vector<ChangeAt>& changes) {
  double largest = 0;
  for (const ChangeAt& each : changes) largest = std::max(largest, each.size);
  if (largest < least_force) return 0;
  const auto there =
      std::ranges::find_if(changes, [&](const ChangeAt& each) { return each.size >= half_there * largest; });
  return there == changes.end() ? 0 : there->seconds;
}

/// Whether the largest change takes more away than it brings.
bool takes_away(const std::vector<ChangeAt>& changes) {
  constexpr double plainly = 0.5;  // of the square of the change, of which a push that ends loses all
  const auto largest = std::ranges::max_element(changes, {}, &ChangeAt::size);
  return largest != changes.end() && largest->gained < -plainly * largest->size * largest->size;
}

/// What hands feel that wait for longer than the others did.
std::vector<ChangeAt> changes_of_waiting(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  const double rate = program.device.rate;
  std::vector<Hand> hands = hands_at_rest(hands_waiting, glm::vec2(half_of(bank)));
  std::vector<Force> first(hands.size()), now(hands.size());
  std::vector<ChangeAt> changes;
  if (!remembers_anything(program)) {
    tick_all(bank, hands, first);
    for (double seconds = still_seconds; seconds < longest_wait; seconds *= waits_grow) {
      for (Hand& hand : hands) hand.time = seconds;
      tick_all(bank, hands, now);
      changes.push_back(change_at(seconds, first, now));
    }
    return changes;
  }
  if (!remembers_time_only(program)) return changes;
  Batch batch(bank, hands.size());
  batch.enter(hands);
  for (std::size_t tick = 0; tick < static_cast<std::size_t>(patience * rate); ++tick) {
    for (Hand& hand : hands) hand.time = static_cast<double>(tick) / rate;
    batch.tick(hands, tick == 0 ? first : now);
    if (tick > static_cast<std::size_t>(still_seconds * rate)) changes.push_back(change_at(hands[0].time, first, now));
  }
  return changes;
}

/// Whether what comes goes about as far the other way as it goes farthest.
bool goes_both_ways(const std::vector<ChangeAt>& changes, const ChangeAt& largest) {
  constexpr double about_as_far = 0.5;
  const glm::dvec2 way = largest.mean / glm::dot(largest.mean, largest.mean);
  return std::ranges::any_of(changes, [&](const ChangeAt& each) { return glm::dot(each.mean, way) < -about_as_far; });
}

/// What hands feel for some seconds from a moment on.
std::vector<ChangeAt> changes_from(const Bank& bank, double begin) {
  constexpr double looked_on = 2;  // s
  std::vector<Hand> hands = hands_at_rest(hands_waiting, glm::vec2(half_of(bank)));
  std::vector<Force> first(hands.size()), now(hands.size());
  tick_all(bank, hands, first);
  std::vector<ChangeAt> changes;
  const double rate = bank.program().description().device.rate;
  for (double seconds = begin; seconds < begin + looked_on; seconds += 1 / rate) {
    for (Hand& hand : hands) hand.time = seconds;
    tick_all(bank, hands, now);
    changes.push_back(change_at(seconds, first, now));
  }
  return changes;
}

/// Hz: how often a force turns about, by the first and the last time that it does; 0 if it hardly does.
double rate_of_turning(const std::vector<ChangeAt>& changes, glm::dvec2 way) {
  double first = 0, last = 0, before = 0;
  long count = 0;
  for (const ChangeAt& each : changes) {
    const double now = glm::dot(each.mean, way);
    if (before < 0 && now >= 0) last = each.seconds, first = count++ == 0 ? last : first;
    if (now != 0) before = now;
  }
  return count > 1 ? static_cast<double>(count - 1) / (last - first) : 0;
}

/// Sizes (N) at the places of hands.
using SizesOf = std::function<std::vector<double>(const std::vector<Hand>& hands)>;

/// The largest size over resting hands in the patch: of many places, then closer and closer about the best.
double largest_over_patch(const Bank& bank, const SizesOf& sizes_of) {
  const glm::dvec2 half = half_of(bank);
  std::vector<Hand> hands = hands_at_rest(hands_looking, glm::vec2(half));
  std::vector<double> sizes = sizes_of(hands);
  std::vector<std::size_t> order(hands.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::partial_sort(order, order.begin() + best_hands, std::greater(), [&](std::size_t i) { return sizes[i]; });
  std::vector<Hand> best;
  std::vector<double> largest;
  for (std::size_t i = 0; i < best_hands; ++i) best.push_back(hands[order[i]]), largest.push_back(sizes[order[i]]);
  constexpr std::array<glm::dvec2, 8> ways = {
      {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {0.7, 0.7}, {-0.7, 0.7}, {0.7, -0.7}, {-0.7, -0.7}}};
  for (double spread = first_spread; spread > finest_spread; spread *= 0.6) {
    hands.clear();
    for (const Hand& each : best)
      for (const glm::dvec2 way : ways) {
        Hand& hand = hands.emplace_back(each);
        hand.position = hand.workspace =
            glm::vec2(glm::clamp(glm::dvec2(each.position) + spread * half * way, -half, half));
      }
    sizes = sizes_of(hands);
    for (std::size_t i = 0; i < hands.size(); ++i)
      if (sizes[i] > largest[i / ways.size()]) largest[i / ways.size()] = sizes[i], best[i / ways.size()] = hands[i];
  }
  return std::ranges::max(largest);
}

/// N: the largest change of the force on a resting hand that `after` makes of it.
double largest_change(const Bank& bank, const std::function<void(Hand&)>& after) {
  return largest_over_patch(bank, [&](const std::vector<Hand>& hands) {
    std::vector<Hand> later = hands;
    for (Hand& hand : later) after(hand);
    std::vector<Force> before(hands.size()), now(hands.size());
    tick_all(bank, hands, before), tick_all(bank, later, now);
    std::vector<double> sizes(hands.size());
    for (std::size_t i = 0; i < hands.size(); ++i) sizes[i] = glm::length(glm::dvec2(now[i]) - glm::dvec2(before[i]));
    return sizes;
  });
}

}  // namespace

ComingForce coming_force(const Bank& bank, const std::vector<std::vector<Force>>& felt, const OtherForce& other) {
  ComingForce found;
  const double rate = bank.program().description().device.rate;
  if (other.slowly >= least_force && !felt.empty()) {
    std::vector<ChangeAt> changes;
    std::vector<Force> first, now(felt.size());
    for (const std::vector<Force>& each : felt) first.push_back(each.front());
    for (std::size_t tick = 0; tick < felt.front().size(); ++tick) {
      for (std::size_t i = 0; i < felt.size(); ++i) now[i] = felt[i][tick];
      changes.push_back(change_at(static_cast<double>(tick) / rate, first, now));
    }
    found.after = half_there_at(changes), found.goes = takes_away(changes);
  }
  if (other.later < least_force) return found;
  const std::vector<ChangeAt> changes = changes_of_waiting(bank);
  if (found.after == 0) found.after = half_there_at(changes), found.goes = takes_away(changes);
  const auto largest = std::ranges::max_element(changes, {}, &ChangeAt::size);
  if (largest == changes.end() || largest->size < least_force ||
      glm::length(largest->mean) < everywhere_alike * largest->size)
    return found;
  if (!goes_both_ways(changes, *largest)) {
    found.later_push = largest->mean;
    return found;
  }
  const bool each_tick = remembers_anything(bank.program().description());
  found.later_rate = rate_of_turning(each_tick ? changes : changes_from(bank, largest->seconds), largest->mean);
  found.later_swing = glm::length(largest->mean);
  return found;
}

void look_all_over(const Bank& bank, const std::vector<std::vector<Force>>& felt, OtherForce& other) {
  if (remembers_anything(bank.program().description())) return;
  const auto look = [&](double& known, const std::function<void(Hand&)>& after) {
    const double largest = largest_change(bank, after);
    known = std::max(known, largest);
  };
  if (other.button >= least_force) look(other.button, [](Hand& hand) { hand.button = true; });
  if (other.slowly < least_force || felt.empty()) return;
  double most = 0, seconds = 0;
  for (const std::vector<Force>& forces : felt)
    for (std::size_t tick = 0; tick < forces.size(); ++tick) {
      const double change = glm::length(glm::dvec2(forces[tick]) - glm::dvec2(forces.front()));
      if (change > most) most = change, seconds = static_cast<double>(tick) / bank.program().description().device.rate;
    }
  look(other.slowly, [seconds](Hand& hand) { hand.time = seconds; });
}

}  // namespace wale
