#include "compiler/read/other_force.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/measure/hands.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/relief_figures.hpp"
#include "compiler/read/slow_change.hpp"
#include "compiler/read/tolerances.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

constexpr std::size_t hands_pressing = 64, hands_moving = 1024;
constexpr double tour = 3, pause = 0.3, click = 0.15;  // s
constexpr std::size_t tours = 4;
constexpr double reach = 0.8;      // of half of the patch
constexpr double swiftest = 0.25;  // m/s
constexpr double plainly_more = 1.2;
constexpr std::size_t moments_moving = 32;
constexpr long moving_apart = 211;  // ticks: a prime, so that no vibration keeps step with the moments
constexpr double stopping = 0.4;    // s
constexpr std::size_t some_ticks = 8;
constexpr double straight_back = 0.7;  // cosine
constexpr double creeping_speed = 0.02, creeping_length = 8e-3, turning_length = 2e-3;  // m/s, m

glm::dvec2 half_without_rim(const Bank& bank) {
  const PatchSize patch = bank.size();
  return 0.5 * glm::dvec2(patch.width, patch.height) - static_cast<double>(patch.rim);
}

double by_button(const Bank& bank, glm::dvec2& push) {
  if (!reads(bank.program().description(), {Input::button})) return 0;
  std::vector<Hand> hands = hands_at_rest(hands_pressing, glm::vec2(half_without_rim(bank)));
  std::vector<Force> open(hands.size()), pressed(hands.size());
  tick_all(bank, hands, open);
  for (Hand& hand : hands) hand.button = true;
  tick_all(bank, hands, pressed);
  double largest = 0;
  for (std::size_t i = 0; i < hands.size(); ++i) {
    largest = std::max(largest, double{glm::length(pressed[i] - open[i])});
    push += glm::dvec2(pressed[i] - open[i]) / static_cast<double>(hands.size());
  }
  return largest;
}

/// A hand on its way over the patch, which ends in a rest.
Hand on_tour(std::size_t number, double seconds, glm::dvec2 half, bool presses) {
  const auto along = [&](double now) {
    const double phase = static_cast<double>(number) * 0.7;
    const double turns = std::min(0.45, swiftest / (2 * std::numbers::pi * reach * std::max(half.x, half.y)));
    // It slows down evenly.
    const double slow = std::clamp((now - (tour - stopping)) / stopping, 0.0, 1.0);
    const double gone = std::min(now, tour - stopping) + stopping * (slow - 0.5 * slow * slow);
    const double angle = 2 * std::numbers::pi * turns * gone;
    return reach * half * glm::dvec2(std::sin(2 * angle + phase), std::sin(3 * angle + 2 * phase));
  };
  Hand hand;
  hand.position = hand.workspace = glm::vec2(along(seconds));
  constexpr double moment = 1e-4;
  hand.velocity = hand.raw_velocity = glm::vec2((along(seconds + moment) - along(seconds)) / moment);
  hand.time = seconds;
  // Every other one presses once for long; the others click.
  const bool down = number % 2 == 0 || std::fmod(seconds, click) < 0.5 * click;
  hand.button = presses && down && seconds > 0.25 * tour && seconds < 0.5 * tour;
  return hand;
}

/// What a program gives a hand beyond what it gives one that enters at the same place, N.
glm::dvec2 beyond_entry(Bank& own, Force felt, const Hand& hand) {
  Memory fresh(own.program());
  fresh.enter(own, hand);
  return glm::dvec2(felt - tick(own, fresh, hand));
}

/// How much otherwise a hand that rests after a tour feels a short stroke than one that has just come to the same place,
/// N. Friction holds both back alike, once it has turned about.
double beyond_entry_on_stroke(Bank& own, Memory& memory, const Hand& rest, glm::dvec2 towards) {
  const double rate = own.program().description().device.rate;
  Memory fresh(own.program());
  fresh.enter(own, rest);
  const auto ticks = static_cast<long>(creeping_length / creeping_speed * rate),
             turned = static_cast<long>(turning_length / creeping_speed * rate);
  double largest = 0;
  Hand hand = rest;
  hand.velocity = hand.raw_velocity = glm::vec2(creeping_speed * towards);
  for (long now = 1; now <= ticks; ++now) {
    const double gone = static_cast<double>(now) / rate;
    hand.position = hand.workspace = glm::vec2(glm::dvec2(rest.position) + creeping_speed * gone * towards);
    hand.time = rest.time + gone;
    const Force felt = tick(own, memory, hand), at_first = tick(own, fresh, hand);
    if (now > turned) largest = std::max(largest, double{glm::length(felt - at_first)});
  }
  return largest;
}

/// What a hand that came from elsewhere feels at rest and on a short stroke. If that holds a resting hand back on the
/// way that it came, with no more than it did on that way, it is friction's.
double by_memory(const Bank& bank, double& rehearsed) {
  const PatchProgram& program = bank.program().description();
  if (!remembers_anything(program) || remembers_time_only(program)) return 0;
  const glm::dvec2 half = half_without_rim(bank);
  const bool presses = reads(program, {Input::button});
  const double rate = program.device.rate;
  const auto ticks = static_cast<std::size_t>((tour + pause) * rate);
  Bank own = bank;
  double largest = 0;
  for (std::size_t number = 0; number < tours; ++number) {
    Memory memory(own.program());
    Force felt{0};
    Hand hand;
    glm::dvec2 way{0};
    double held = 0;
    for (std::size_t now = 0; now < ticks; ++now) {
      const double seconds = static_cast<double>(now) / rate;
      hand = on_tour(number, seconds, half, presses);
      if (now == 0) memory.enter(own, hand);
      felt = tick(own, memory, hand);
      rehearsed = std::max(rehearsed, double{glm::length(felt)});
      if (seconds < tour - stopping || now % some_ticks != 0 || hand.velocity == glm::vec2(0)) continue;
      way = glm::normalize(glm::dvec2(hand.velocity));
      held = std::max(held, -glm::dot(beyond_entry(own, felt, hand), way));
    }
    const glm::dvec2 left = beyond_entry(own, felt, hand);
    const bool friction =
        -glm::dot(left, way) > straight_back * glm::length(left) && glm::length(left) < plainly_more * held;
    if (friction) continue;
    // Where the hand happens to rest, a texture that wears off may be flat. What the hand changed lies where it came.
    largest = std::max({largest, glm::length(left), beyond_entry_on_stroke(own, memory, hand, -way)});
  }
  return largest;
}

}  // namespace

double OtherForce::largest() const { return std::max({button, slowly, remembered, moving}); }

glm::dvec2 OtherForce::push() const {
  constexpr double everywhere = 0.8;
  const bool pressed = button >= slowly;
  const double size = pressed ? button : slowly;
  const glm::dvec2 mean = pressed ? button_push : slow_push;
  return size >= std::max(remembered, moving) && glm::length(mean) >= everywhere * size ? mean : glm::dvec2(0);
}

double force_on_moving(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  if (remembers_anything(program) && !remembers_time_only(program)) return 0;
  if (!reads(program, {Input::velocity_x, Input::velocity_y, Input::raw_velocity_x, Input::raw_velocity_y})) return 0;
  std::vector<Hand> hands = hands_at_rest(hands_moving, glm::vec2(half_without_rim(bank)));
  // What goes by time is felt at some moments, by some of the hands at each.
  const std::size_t moments = goes_by_time(program) ? moments_moving : 1;
  Bank own = bank;
  Memory clock(own.program());
  clock.enter(own, {});
  std::vector<double> sizes(hands.size());
  long now = 0;
  for (std::size_t i = 0; i < hands.size(); ++i) {
    const auto moment = static_cast<long>(i * moments / hands.size()) * moving_apart;
    for (; now < moment; ++now) {
      Hand still;
      still.time = static_cast<double>(now) / program.device.rate;
      tick(own, clock, still);
    }
    const double angle = static_cast<double>(i) * std::numbers::pi * (3 - std::sqrt(5.0));
    hands[i].time = static_cast<double>(moment) / program.device.rate;
    Hand moving = hands[i];
    moving.velocity = moving.raw_velocity = glm::vec2(swiftest * glm::dvec2(std::cos(angle), std::sin(angle)));
    Memory at_rest = clock, in_motion = clock;
    sizes[i] = glm::length(tick(own, in_motion, moving) - tick(own, at_rest, hands[i]));
  }
  const double usual = percentile(sizes, percentile_of_amplitude);
  // What fills less than a hundredth of the patch has no percentile.
  return usual >= least_force ? usual : std::ranges::max(sizes);
}

OtherForce other_force(const Bank& bank, const std::vector<std::vector<Force>>& felt, const SlowChange& slow,
                       double swinging, double held) {
  OtherForce found;
  found.button = by_button(bank, found.button_push);
  found.slowly = slow.newton, found.slow_push = slow.push;
  for (const std::vector<Force>& forces : felt)
    for (const Force& force : forces) found.rehearsed = std::max(found.rehearsed, double{glm::length(force)});
  found.remembered = by_memory(bank, found.rehearsed);
  // A swing that begins when the hand comes is elsewhere in its period for a hand that came before.
  if (found.remembered < plainly_more * (held + 2 * swinging)) found.remembered = 0;
  return found;
}

}  // namespace wale
