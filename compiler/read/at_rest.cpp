#include "compiler/read/at_rest.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "compiler/measure/hands.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/strokes.hpp"
#include "wale/batch.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

constexpr std::size_t still_places = 8;
constexpr std::size_t places_looked_at = 256;  // 9 mm apart on a patch of 160 mm
constexpr std::size_t moments_looked_at = 64, ticks_looked_at = 450;
constexpr long moments_apart = 101;      // ticks: a prime, so that no vibration keeps step with the moments
constexpr double plainly_busier = 1.03;  // times the size at the places of rest

/// How much the force on a hand changes with time: the sum of its squares about its mean.
class Change {
 public:
  void add(Force felt) {
    const glm::dvec2 force(felt);
    sum_ += force, squares_ += glm::dot(force, force), ++count_;
  }
  double squares() const { return count_ > 0 ? squares_ - glm::dot(sum_, sum_) / count_ : 0; }

 private:
  glm::dvec2 sum_{0};
  double squares_ = 0, count_ = 0;
};

/// The change on each of some resting hands, N^2, of a program that goes by time.
std::vector<double> changes_on(const Bank& bank, std::vector<Hand> hands) {
  const PatchProgram& program = bank.program().description();
  const double rate = program.device.rate;
  std::vector<Change> changes(hands.size());
  std::vector<Force> forces(hands.size());
  const auto add = [&] {
    for (std::size_t i = 0; i < hands.size(); ++i) changes[i].add(forces[i]);
  };
  if (program.states.empty()) {
    for (std::size_t moment = 0; moment < moments_looked_at; ++moment) {
      for (Hand& hand : hands) hand.time = static_cast<double>(static_cast<long>(moment) * moments_apart) / rate;
      tick_all(bank, hands, forces);
      add();
    }
  } else {
    Batch batch(bank, hands.size());
    batch.enter(hands);
    for (std::size_t tick = 0; tick < ticks_looked_at; ++tick) {
      for (Hand& hand : hands) hand.time = static_cast<double>(tick) / rate;
      batch.tick(hands, forces);
      add();
    }
  }
  std::vector<double> found;
  for (const Change& each : changes) found.push_back(each.squares());
  return found;
}

}  // namespace

std::vector<glm::dvec2> places_of_rest(const Bank& bank) {
  const glm::dvec2 half = half_of(bank);
  std::vector<glm::dvec2> places;
  for (std::size_t i = 0; i < still_places; ++i) {
    // On a spiral, so that no two positions have the same distance or angle.
    const auto number = static_cast<double>(i);
    const double radius = 0.8 * number / still_places, angle = number * std::numbers::pi * (3 - std::sqrt(5.0));
    places.push_back(half * radius * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  return places;
}

std::vector<std::vector<Force>> felt_at_rest(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  const bool timed = reads(program, {Input::time});
  std::vector<std::vector<Force>> felt;
  if (!timed && program.states.empty()) return felt;
  const double rate = program.device.rate;
  const auto ticks = static_cast<std::size_t>(std::lround(still_seconds * rate));
  std::vector<Hand> hands(still_places);
  const std::vector<glm::dvec2> places = places_of_rest(bank);
  for (std::size_t i = 0; i < still_places; ++i) hands[i].position = hands[i].workspace = glm::vec2(places[i]);
  felt.assign(still_places, std::vector<Force>(ticks));
  if (program.states.empty()) {
    for (std::size_t i = 0; i < still_places; ++i) {
      std::vector<Hand> moments(ticks, hands[i]);
      for (std::size_t tick = 0; tick < ticks; ++tick) moments[tick].time = static_cast<double>(tick) / rate;
      tick_all(bank, moments, felt[i]);
    }
    return felt;
  }
  Batch batch(bank, still_places);
  batch.enter(hands);
  std::vector<Force> forces(still_places);
  const std::size_t all = program.states.size() * still_places;
  std::vector<float> before(all), now(all);
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    for (Hand& hand : hands) hand.time = static_cast<double>(tick) / rate;
    batch.tick(hands, forces);
    for (std::size_t i = 0; i < still_places; ++i) felt[i][tick] = forces[i];
    for (std::size_t i = 0; i < all; ++i) now[i] = batch.state(i / still_places, i % still_places);
    // Without a clock, a force that does not change in one tick never changes.
    if (!timed && tick > 0 && now == before) {
      for (auto& each : felt) each.assign(ticks, each[tick]);
      break;
    }
    before.swap(now);
  }
  return felt;
}

std::optional<std::vector<Force>> felt_where_busiest(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  const bool by_place = reads(program, {Input::x, Input::y, Input::workspace_x, Input::workspace_y});
  if (!goes_by_time(program) || !by_place) return std::nullopt;
  std::vector<Hand> hands = hands_at_rest(places_looked_at, glm::vec2(half_of(bank)));
  for (const glm::dvec2 place : places_of_rest(bank)) {
    Hand& hand = hands.emplace_back();
    hand.position = hand.workspace = glm::vec2(place);
  }
  const std::vector<double> changes = changes_on(bank, hands);
  const auto first_known = changes.begin() + places_looked_at;
  const auto busiest = std::max_element(changes.begin(), first_known);
  const double known = *std::max_element(first_known, changes.end());
  if (!(*busiest > plainly_busier * plainly_busier * known)) return std::nullopt;
  Hand hand = hands[static_cast<std::size_t>(busiest - changes.begin())];
  std::vector<Force> felt(static_cast<std::size_t>(std::lround(still_seconds * program.device.rate)));
  Bank own = bank;
  Memory memory(own.program());
  memory.enter(own, hand);
  for (std::size_t now = 0; now < felt.size(); ++now) {
    hand.time = static_cast<double>(now) / program.device.rate;
    felt[now] = tick(own, memory, hand);
  }
  return felt;
}

}  // namespace wale
