#include "compiler/extract/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>
#include <vector>

#include "compiler/extract/dependence.hpp"
#include "compiler/extract/force_field.hpp"
#include "compiler/extract/fourier.hpp"
#include "compiler/measure/hands.hpp"
#include "wale/batch.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

constexpr std::array<double, 3> speeds = {0.05, 0.1, 0.2};  // m/s, speeds of an exploring hand
constexpr double stretch = 0.024;                           // m, length of a stroke, which goes there and back
constexpr double least_stretch = 0.5;                       // of the patch's extent, if that is smaller
constexpr double looked_at = 0.5;  // of the stretch, in its middle: there a program with memory has settled
constexpr int lines = 4;           // parallel strokes
constexpr int places = 64;         // of a stroke, for programs without memory
constexpr double push = 1;         // m/s^2
constexpr std::size_t still_places = 8;
constexpr double still_seconds = 1;
constexpr double nothing = 1e-5;  // N

/// A stroke goes over half of its stretch, back over the whole, and forward over the whole. The first half settles a
/// program with memory. The middles of the other two are evaluated: they pass the same positions, so that forces that
/// depend on position cancel.
struct Stroke {
  glm::dvec2 direction{0}, middle{0};
  double speed = 0;
  long pass = 0;  // ticks, an even number

  long ticks() const { return pass / 2 + 2 * pass; }

  /// A hand at `along` (m from the middle of the stroke), moving there or back.
  Hand hand(double along, bool forth) const {
    Hand hand;
    hand.position = hand.workspace = glm::vec2(middle + along * direction);
    hand.velocity = hand.raw_velocity = glm::vec2((forth ? 1 : -1) * speed * direction);
    return hand;
  }

  /// The distance from the middle in m at a tick, and whether the hand moves there or back.
  std::pair<double, bool> at(long tick, double rate) const {
    const double half = 0.5 * static_cast<double>(pass) * speed / rate;
    const long since = tick + pass / 2;  // as if the stroke had begun at the end of its stretch
    const double gone = (static_cast<double>(since % pass) + 0.5) * speed / rate;
    const bool forth = since / pass % 2 == 0;
    return {forth ? gone - half : half - gone, forth};
  }
};

/// Half the extent of the patch without its rim, m.
glm::dvec2 half_of(const Bank& bank) {
  const PatchSize patch = bank.size();
  return 0.5 * glm::dvec2(patch.width, patch.height) - static_cast<double>(patch.rim);
}

/// m on either side of the middle of a stroke.
double reach_of(const Bank& bank) {
  const glm::dvec2 half = half_of(bank);
  return std::min(stretch / 2, least_stretch * std::min(half.x, half.y));
}

std::vector<Stroke> strokes_over(const Bank& bank) {
  const double rate = bank.program().description().device.rate;
  std::vector<Stroke> strokes;
  for (const glm::dvec2 direction : {glm::dvec2(1, 0), glm::dvec2(0, 1)})
    for (int line = 0; line < lines; ++line)
      for (const double speed : speeds) {
        const glm::dvec2 aside =
            half_of(bank) * ((line + 0.5) / (0.5 * lines) - 1) * glm::dvec2(direction.y, direction.x);
        strokes.push_back({direction, aside, speed, 2 * std::max(2L, std::lround(reach_of(bank) / speed * rate))});
      }
  return strokes;
}

/// The mean force against each stroke, N, for a program whose ticks are independent.
std::vector<double> opposed_anywhere(const Bank& bank, const std::vector<Stroke>& strokes) {
  std::vector<Hand> hands;
  hands.reserve(strokes.size() * 2 * places);
  for (const Stroke& stroke : strokes)
    for (const bool forth : {true, false})
      for (int i = 0; i < places; ++i)
        hands.push_back(stroke.hand(looked_at * reach_of(bank) * (2 * (i + 0.5) / places - 1), forth));
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  std::vector<double> means(strokes.size());
  for (std::size_t i = 0; i < hands.size(); ++i) {
    const std::size_t stroke = i / (2 * places);
    means[stroke] -=
        glm::dot(glm::dvec2(forces[i]), glm::dvec2(hands[i].velocity)) / strokes[stroke].speed / (2 * places);
  }
  return means;
}

/// The same for a program that remembers in states only, tick by tick. The hands run one after another: there are too
/// few to fill the lanes of a block.
std::vector<double> opposed_one_by_one(const Bank& bank, const std::vector<Stroke>& strokes) {
  const double rate = bank.program().description().device.rate, middle = looked_at * reach_of(bank);
  Bank own = bank;
  Memory memory(own.program());
  std::vector<double> means(strokes.size());
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const Stroke& stroke = strokes[i];
    double sum = 0;
    long count = 0;
    for (long now = 0; now < stroke.ticks(); ++now) {
      const auto [along, forth] = stroke.at(now, rate);
      Hand hand = stroke.hand(along, forth);
      hand.time = static_cast<double>(now) / rate;
      if (now == 0) memory.enter(own, hand);
      const Force force = tick(own, memory, hand);
      if (now < stroke.pass / 2 || std::abs(along) > middle) continue;
      sum -= glm::dot(glm::dvec2(force), glm::dvec2(hand.velocity)) / stroke.speed;
      ++count;
    }
    means[i] = sum / static_cast<double>(std::max(1L, count));
  }
  return means;
}

/// The same for any program; memories stay as they are at the start.
std::vector<double> opposed_on_the_way(const Bank& bank, const std::vector<Stroke>& strokes) {
  if (bank.program().description().grids.empty()) return opposed_one_by_one(bank, strokes);
  const double rate = bank.program().description().device.rate, middle = looked_at * reach_of(bank);
  const long longest = std::ranges::max(strokes, {}, &Stroke::ticks).ticks();
  std::vector<double> sums(strokes.size());
  std::vector<long> counts(strokes.size());
  const auto move = [&](std::size_t first, long tick, std::span<const Force> forces, std::span<Hand> hands) {
    for (std::size_t i = 0; i < hands.size(); ++i) {
      const Stroke& stroke = strokes[first + i];
      const bool counts_now = tick > stroke.pass / 2 && tick <= stroke.ticks();
      if (counts_now && std::abs(stroke.at(tick - 1, rate).first) <= middle) {
        sums[first + i] -= glm::dot(glm::dvec2(forces[i]), glm::dvec2(hands[i].velocity)) / stroke.speed;
        ++counts[first + i];
      }
      const auto [along, forth] = stroke.at(tick, rate);
      hands[i] = stroke.hand(along, forth);
      hands[i].time = static_cast<double>(tick) / rate;
    }
  };
  run_batch(bank, strokes.size(), longest, move);
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= static_cast<double>(std::max(1L, counts[i]));
  return sums;
}

/// The forces on hands that hold still at a few positions, for each tick; empty if they cannot change.
std::vector<std::vector<Force>> felt_at_rest(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  const bool timed = reads(program, {Input::time});
  std::vector<std::vector<Force>> felt;
  if (!timed && program.states.empty()) return felt;
  const double rate = program.device.rate;
  const auto ticks = static_cast<std::size_t>(std::lround(still_seconds * rate));
  std::vector<Hand> hands(still_places);
  for (std::size_t i = 0; i < still_places; ++i) {
    // On a spiral, so that no two positions have the same distance or angle.
    const auto number = static_cast<double>(i);
    const double radius = 0.8 * number / still_places, angle = number * std::numbers::pi * (3 - std::sqrt(5.0));
    hands[i].position = hands[i].workspace =
        glm::vec2(half_of(bank) * radius * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
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

}  // namespace

OpposingForce opposing_force(const Bank& bank) {
  OpposingForce found;
  const PatchProgram& program = bank.program().description();
  if (!depends_on_the_moment(program) && !remembers_anything(program)) return found;
  const std::vector<Stroke> strokes = strokes_over(bank);
  const bool alone = !remembers_anything(program) && !reads(program, {Input::time});
  const std::vector<double> opposed = alone ? opposed_anywhere(bank, strokes) : opposed_on_the_way(bank, strokes);
  // Least squares of force against speed.
  double n = 0, v = 0, f = 0, vv = 0, vf = 0;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const double force = opposed[i], speed = strokes[i].speed;
    n += 1, v += speed, f += force, vv += speed * speed, vf += speed * force;
  }
  found.damping = (n * vf - v * f) / (n * vv - v * v);
  found.friction = (f - found.damping * v) / n;
  double squares = 0;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    const double off = opposed[i] - found.friction - found.damping * strokes[i].speed;
    squares += off * off;
  }
  found.scatter = std::sqrt(squares / n);
  return found;
}

double inertia(const Bank& bank) {
  if (!reads(bank.program().description(),
             {Input::acceleration_x, Input::acceleration_y, Input::raw_acceleration_x, Input::raw_acceleration_y}))
    return 0;
  const glm::dvec2 half = half_of(bank);
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
  std::vector<std::complex<float>> busiest;
  for (const std::vector<Force>& forces : felt_at_rest(bank)) {
    const auto ticks = static_cast<double>(forces.size());
    glm::dvec2 mean{0};
    for (const Force& force : forces) mean += glm::dvec2(force) / ticks;
    double squares = 0;
    for (const Force& force : forces) squares += glm::dot(glm::dvec2(force) - mean, glm::dvec2(force) - mean);
    const double amplitude = std::sqrt(2 * squares / ticks);
    if (amplitude <= std::max(found.amplitude, nothing)) continue;
    found.amplitude = amplitude;
    busiest = as_complex(forces);
    for (auto& value : busiest) value -= std::complex<float>(static_cast<float>(mean.x), static_cast<float>(mean.y));
  }
  // The transform of x + i y holds one of theirs in a coefficient and the other in its mirror image.
  const Spectrum spectrum = busiest.empty() ? Spectrum{} : fourier_of_line(busiest);
  double strongest = 0;
  for (std::size_t cycles = 1; cycles < spectrum.size() / 2; ++cycles) {
    const double power = std::norm(spectrum[cycles]) + std::norm(spectrum[spectrum.size() - cycles]);
    if (power > strongest) strongest = power, found.frequency = static_cast<double>(cycles) / still_seconds;
  }
  return found;
}

}  // namespace wale
