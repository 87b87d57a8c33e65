#include "compiler/read/other_force.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/measure/hands.hpp"
#include "compiler/read/dependence.hpp"
#include "compiler/read/relief_figures.hpp"
#include "compiler/read/tolerances.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

constexpr std::size_t hands_pressing = 64, hands_moving = 1024;
constexpr double slow_window = 4;         // s: long enough that a sway has no mean in it
constexpr double slow_step = 0.5;         // s
constexpr double left_of_a_swing = 0.03;  // of its amplitude, in a mean over that window
constexpr double left_of_noise = 0.3;     // likewise of a noise, whose means differ by chance
constexpr double tour = 3, pause = 0.3;   // s
constexpr std::size_t tours = 4;
constexpr double reach = 0.8;      // of half of the patch
constexpr double swiftest = 0.25;  // m/s
constexpr double plainly_more = 1.2;
constexpr double stopping = 0.4;  // s
constexpr std::size_t some_ticks = 8;
constexpr double straight_back = 0.7;  // cosine

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

glm::dvec2 longer(glm::dvec2 one, glm::dvec2 other) { return glm::length(other) > glm::length(one) ? other : one; }

/// The largest change of a force since its beginning.
glm::dvec2 change_of(const std::vector<Force>& forces) {
  glm::dvec2 largest{0};
  for (const Force& force : forces) largest = longer(largest, glm::dvec2(force - forces.front()));
  return largest;
}

/// The largest change of a force's mean over a window, in which a swing has none: the window is Hann's.
glm::dvec2 change_of_mean(const std::vector<Force>& forces, double rate) {
  const auto width = std::min(forces.size(), static_cast<std::size_t>(slow_window * rate));
  const auto step = std::max<std::size_t>(1, static_cast<std::size_t>(slow_step * rate));
  std::vector<glm::dvec2> means;
  for (std::size_t first = 0; first + width <= forces.size(); first += step) {
    glm::dvec2 sum{0};
    for (std::size_t i = 0; i < width; ++i)
      sum += (1 - std::cos(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(width))) *
             glm::dvec2(forces[first + i]);
    means.push_back(sum / static_cast<double>(width));
  }
  glm::dvec2 largest{0};
  for (const glm::dvec2& mean : means) largest = longer(largest, mean - means.front());
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
  hand.button = presses && seconds > 0.25 * tour && seconds < 0.5 * tour;
  return hand;
}

/// What a program gives a hand beyond what it gives one that enters at the same place, N.
glm::dvec2 beyond_entry(Bank& own, Force felt, const Hand& hand) {
  Memory fresh(own.program());
  fresh.enter(own, hand);
  return glm::dvec2(felt - tick(own, fresh, hand));
}

/// What a hand that came from elsewhere feels at rest. If that holds the hand back on the way that it came, with no
/// more than it did on that way, it is friction's.
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
    if (!friction) largest = std::max(largest, glm::length(left));
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
  if (remembers_anything(program) ||
      !reads(program, {Input::velocity_x, Input::velocity_y, Input::raw_velocity_x, Input::raw_velocity_y}))
    return 0;
  std::vector<Hand> hands = hands_at_rest(hands_moving, glm::vec2(half_without_rim(bank)));
  std::vector<Force> resting(hands.size()), moving(hands.size());
  tick_all(bank, hands, resting);
  for (std::size_t i = 0; i < hands.size(); ++i) {
    const double angle = static_cast<double>(i) * std::numbers::pi * (3 - std::sqrt(5.0));
    hands[i].velocity = hands[i].raw_velocity = glm::vec2(swiftest * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
  tick_all(bank, hands, moving);
  std::vector<double> sizes(hands.size());
  for (std::size_t i = 0; i < hands.size(); ++i) sizes[i] = glm::length(moving[i] - resting[i]);
  return percentile(sizes, percentile_of_amplitude);
}

OtherForce other_force(const Bank& bank, const std::vector<std::vector<Force>>& felt, const Swing& sway,
                       const Swing& vibration, double held) {
  OtherForce found;
  found.button = by_button(bank, found.button_push);
  const bool swings = std::max(sway.amplitude, vibration.amplitude) >= least_force;
  const double rate = bank.program().description().device.rate;
  for (const std::vector<Force>& forces : felt) {
    const glm::dvec2 change = swings ? change_of_mean(forces, rate) : change_of(forces);
    found.slowly = std::max(found.slowly, glm::length(change));
    found.slow_push += change / static_cast<double>(felt.size());
  }
  if (found.slowly <
      (vibration.noise ? left_of_noise : left_of_a_swing) * std::max(sway.amplitude, vibration.amplitude))
    found.slowly = 0;
  for (const std::vector<Force>& forces : felt)
    for (const Force& force : forces) found.rehearsed = std::max(found.rehearsed, double{glm::length(force)});
  found.remembered = by_memory(bank, found.rehearsed);
  // A swing that begins when the hand comes is elsewhere in its period for a hand that came before.
  const double swinging = 2 * (sway.amplitude + vibration.amplitude);
  if (found.remembered < plainly_more * (held + swinging)) found.remembered = 0;
  return found;
}

}  // namespace wale
