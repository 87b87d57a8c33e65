#include "compiler/grade/step_ahead.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "compiler/grade/exploring_place.hpp"
#include "compiler/measure/strokes.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

constexpr double seconds = exploring_seconds;
constexpr std::size_t hands_in_a_tick = 6;
constexpr double most_cost = 2e8;      // units of cost of all their ticks, about a fifth of a second
constexpr int halvings_for_jump = 5;   // of one encoder count
constexpr double share_of_jump = 0.5;  // of the change over a count, which a smooth one does not keep so far down

/// The forces on an exploring hand whose places are ahead on its way, for some ticks, with the hand of the last one.
/// Its motion is that of the hand that is not ahead: a friction that turns with the motion is no jump by place.
struct RunAhead {
  std::vector<glm::dvec2> forces;
  Hand last;
};

RunAhead run_ahead(Bank bank, const GradingHand& hand, bool circles, double seconds_ahead, std::size_t ticks) {
  const double radius = std::min(hand.radius, room_to_stroke(bank.size()));
  const double period = 1 / bank.program().description().device.rate;
  const auto at = [&](double time) { return exploring_place(time, radius, hand.frequency, circles); };
  Memory memory(bank.program());
  RunAhead run;
  for (std::size_t i = 0; i < ticks; ++i) {
    const double time = static_cast<double>(i) * period;
    run.last = hand_along(at, time, period);
    run.last.position = run.last.workspace = glm::vec2(at(time + seconds_ahead));
    if (i == 0) memory.enter(bank, run.last);
    run.forces.emplace_back(tick(bank, memory, run.last));
  }
  return run;
}

}  // namespace

StepAhead largest_step_ahead(const Bank& bank, const GradingHand& hand) {
  const PatchProgram& program = bank.program().description();
  const double period = 1 / program.device.rate, count = program.device.position_step();
  const auto ticks = static_cast<std::size_t>(std::lround(seconds * program.device.rate));
  if (static_cast<double>(cost_of(program.tick)) * static_cast<double>(4 * hands_in_a_tick * ticks) > most_cost)
    return {};
  // The hands of one tick share the way to the next, so one of them is the first to meet a jump on it.
  double width = period / hands_in_a_tick, largest = 0, ahead = 0;
  std::size_t when = 0;
  bool circling = false;
  for (const bool circles : {false, true}) {
    std::vector<glm::dvec2> before;
    for (std::size_t i = 0; i <= hands_in_a_tick; ++i) {
      auto forces = run_ahead(bank, hand, circles, static_cast<double>(i) * width, ticks).forces;
      for (std::size_t tick = 0; tick < before.size(); ++tick)
        if (const double newton = glm::length(forces[tick] - before[tick]); newton > largest)
          largest = newton, when = tick, circling = circles, ahead = static_cast<double>(i - 1) * width;
      before = std::move(forces);
    }
  }
  StepAhead found;
  if (largest == 0) return found;
  const auto at = [&](double by) { return run_ahead(bank, hand, circling, by, when + 1); };
  const auto change = [](const RunAhead& from, const RunAhead& to) {
    return glm::length(to.forces.back() - from.forces.back());
  };
  RunAhead low = at(ahead), high = at(ahead + width);
  const auto halve = [&] {
    width /= 2;
    RunAhead middle = at(ahead + width);
    if (change(middle, high) > change(low, middle))
      low = std::move(middle), ahead += width;
    else
      high = std::move(middle);
  };
  while (glm::distance(low.last.position, high.last.position) > count) halve();
  found.hand = low.last;
  found.newton = change(low, high);
  for (int i = 0; i < halvings_for_jump; ++i) halve();
  found.jumps = change(low, high) > share_of_jump * found.newton;
  return found;
}

}  // namespace wale
