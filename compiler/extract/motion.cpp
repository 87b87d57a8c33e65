#include "compiler/extract/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>
#include <vector>

#include "compiler/measure/hands.hpp"
#include "wale/batch.hpp"

namespace wale {
namespace {

constexpr std::array<double, 3> speeds = {0.04, 0.08, 0.16};  // m/s, those of a hand that explores
constexpr double stretch = 0.04;                              // m, gone over there and back
constexpr double least_stretch = 0.5;                         // of the patch's extent, where that is smaller
constexpr double looked_at = 0.5;  // of the stretch, in its middle: what remembers has taken up its load there
constexpr int lines = 4;           // parallel strokes
constexpr double push = 1;         // m/s^2
constexpr int still_places = 8;
constexpr double still_seconds = 1;
constexpr double nothing = 1e-5;  // N

/// A stroke goes over its stretch there, back and there again. The first way settles what remembers; the middles of
/// the other two are looked at, which see the same places, so that what depends on place cancels.
struct Stroke {
  glm::dvec2 direction{0}, middle{0};
  double speed = 0;
  long pass = 0;  // ticks

  /// m along the direction at a tick, from the middle, and whether it goes there.
  std::pair<double, bool> at(long tick, double rate) const {
    const double half = 0.5 * static_cast<double>(pass) * speed / rate;
    const double gone = (static_cast<double>(tick % pass) + 0.5) * speed / rate;
    const bool forth = tick / pass % 2 == 0;
    return {forth ? gone - half : half - gone, forth};
  }
};

}  // namespace

OpposingForce opposing_force(const Bank& bank) {
  OpposingForce found;
  const PatchProgram& program = bank.program().description();
  if (!depends_on_the_moment(program) && program.states.empty() && program.grids.empty()) return found;
  const PatchSize patch = bank.size();
  const glm::dvec2 half = 0.5 * glm::dvec2(patch.width, patch.height) - static_cast<double>(patch.rim);
  const double reach = std::min(stretch / 2, least_stretch * std::min(half.x, half.y));
  const double rate = program.device.rate;
  std::vector<Stroke> strokes;
  long longest = 0;
  for (const glm::dvec2 direction : {glm::dvec2(1, 0), glm::dvec2(0, 1)})
    for (int line = 0; line < lines; ++line)
      for (const double speed : speeds) {
        const glm::dvec2 aside = half * ((line + 0.5) / (0.5 * lines) - 1) * glm::dvec2(direction.y, direction.x);
        strokes.push_back({direction, aside, speed, std::max(4L, std::lround(2 * reach / speed * rate))});
        longest = std::max(longest, strokes.back().pass);
      }
  std::vector<double> sums(strokes.size());
  std::vector<long> counts(strokes.size());
  const auto move = [&](std::size_t first, long tick, std::span<const Force> forces, std::span<Hand> hands) {
    for (std::size_t i = 0; i < hands.size(); ++i) {
      const Stroke& stroke = strokes[first + i];
      const bool counts_now = tick > stroke.pass && tick <= 3 * stroke.pass;
      if (counts_now && std::abs(stroke.at(tick - 1, rate).first) <= looked_at * reach) {
        sums[first + i] -= glm::dot(glm::dvec2(forces[i]), glm::dvec2(hands[i].velocity)) / stroke.speed;
        ++counts[first + i];
      }
      const auto [along, forth] = stroke.at(tick, rate);
      hands[i].position = hands[i].workspace = glm::vec2(stroke.middle + along * stroke.direction);
      hands[i].velocity = hands[i].raw_velocity = glm::vec2((forth ? 1 : -1) * stroke.speed * stroke.direction);
      hands[i].time = static_cast<double>(tick) / rate;
    }
  };
  run_batch(bank, strokes.size(), 3 * longest, move);
  // Least squares of force against speed.
  double n = 0, v = 0, f = 0, vv = 0, vf = 0;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const double force = sums[i] / static_cast<double>(counts[i]), speed = strokes[i].speed;
    n += 1, v += speed, f += force, vv += speed * speed, vf += speed * force;
  }
  found.damping = (n * vf - v * f) / (n * vv - v * v);
  found.friction = (f - found.damping * v) / n;
  double squares = 0;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const double off = sums[i] / static_cast<double>(counts[i]) - found.friction - found.damping * strokes[i].speed;
    squares += off * off;
  }
  found.scatter = std::sqrt(squares / n);
  return found;
}

double inertia(const Bank& bank) {
  if (!depends_on_the_moment(bank.program().description())) return 0;
  const PatchSize patch = bank.size();
  const glm::dvec2 half = 0.5 * glm::dvec2(patch.width, patch.height) - static_cast<double>(patch.rim);
  std::vector<Hand> hands;
  constexpr int side = 8;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      for (const glm::dvec2 direction : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)}) {
        Hand& hand = hands.emplace_back();
        hand.position = hand.workspace = glm::vec2(half * ((glm::dvec2(column, row) + 0.5) / (0.5 * side) - 1.0));
        hand.acceleration = hand.raw_acceleration = glm::vec2(push * direction);
      }
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  double sum = 0;
  for (std::size_t i = 0; i < hands.size(); ++i)
    sum -= glm::dot(glm::dvec2(forces[i]), glm::dvec2(hands[i].acceleration));
  return sum / (push * push * static_cast<double>(hands.size()));
}

Vibration vibration(const Bank& bank) {
  Vibration found;
  const PatchProgram& program = bank.program().description();
  if (!depends_on_the_moment(program) && program.states.empty()) return found;
  const PatchSize patch = bank.size();
  const glm::dvec2 half = 0.5 * glm::dvec2(patch.width, patch.height) - static_cast<double>(patch.rim);
  const double rate = program.device.rate;
  const long ticks = std::lround(still_seconds * rate);
  std::vector<std::vector<Force>> felt(still_places, std::vector<Force>(static_cast<std::size_t>(ticks)));
  run_batch(bank, still_places, ticks,
            [&](std::size_t first, long tick, std::span<const Force> forces, std::span<Hand> hands) {
              for (std::size_t i = 0; i < hands.size(); ++i) {
                const auto number = static_cast<double>(first + i);
                if (tick > 0) felt[first + i][static_cast<std::size_t>(tick - 1)] = forces[i];
                // On a spiral, so that no two are at the same distance or angle.
                const double radius = 0.8 * number / still_places,
                             angle = number * std::numbers::pi * (3 - std::sqrt(5.0));
                hands[i].position = hands[i].workspace =
                    glm::vec2(half * radius * glm::dvec2(std::cos(angle), std::sin(angle)));
                hands[i].time = static_cast<double>(tick) / rate;
              }
            });
  const std::vector<Force>* busiest = nullptr;
  glm::dvec2 rest{0};
  for (const auto& forces : felt) {
    glm::dvec2 mean{0};
    for (const Force& force : forces) mean += glm::dvec2(force) / static_cast<double>(ticks);
    double squares = 0;
    for (const Force& force : forces) squares += glm::dot(glm::dvec2(force) - mean, glm::dvec2(force) - mean);
    const double amplitude = std::sqrt(2 * squares / static_cast<double>(ticks));
    if (amplitude > std::max(found.amplitude, nothing)) found.amplitude = amplitude, busiest = &forces, rest = mean;
  }
  if (busiest == nullptr) return found;
  double strongest = 0;
  for (long cycles = 1; cycles < ticks / 2; ++cycles) {
    // Both components turn by one angle a tick; a recurrence spares their sines.
    const double angle = 2 * std::numbers::pi * static_cast<double>(cycles) / static_cast<double>(ticks);
    const glm::dvec2 turn{std::cos(angle), std::sin(angle)};
    glm::dvec2 at{1, 0}, cosines{0}, sines{0};
    for (const Force& force : *busiest) {
      const glm::dvec2 moved = glm::dvec2(force) - rest;
      cosines += at.x * moved, sines += at.y * moved;
      at = {at.x * turn.x - at.y * turn.y, at.x * turn.y + at.y * turn.x};
    }
    const double power = glm::dot(cosines, cosines) + glm::dot(sines, sines);
    if (power > strongest) strongest = power, found.frequency = static_cast<double>(cycles) / still_seconds;
  }
  return found;
}

}  // namespace wale
