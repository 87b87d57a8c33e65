#include "compiler/grade/explore.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "compiler/measure/strokes.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

using std::numbers::pi;
constexpr double seconds = 1;
constexpr std::size_t hands_in_a_tick = 6;
constexpr double most_cost = 2e8;      // units of cost of all their ticks, about a fifth of a second
constexpr int halvings_for_jump = 5;   // of one encoder count
constexpr double share_of_jump = 0.5;  // of the change over a count, which a smooth one does not keep so far down
constexpr std::size_t moments = 60;    // of a second, at which the energy is summed up
constexpr std::size_t way_back = 64;   // places on a way back

/// The hand's place, m. It begins at rest at the centre and reaches its full radius after a quarter of the time.
glm::dvec2 place(double time, double radius, double frequency, bool circles) {
  const double angle = 2 * pi * frequency * time;
  return radius * coming_up(time, seconds / 4) * glm::dvec2(std::sin(angle), circles ? std::cos(angle) : 0.0);
}

/// The forces on an exploring hand whose places are ahead on its way, for some ticks, with the hand of the last one.
/// Its motion is that of the hand that is not ahead: a friction that turns with the motion is no jump by place.
struct RunAhead {
  std::vector<glm::dvec2> forces;
  Hand last;
};

RunAhead run_ahead(Bank bank, const GradingHand& hand, bool circles, double seconds_ahead, std::size_t ticks) {
  const double radius = std::min(hand.radius, room_to_stroke(bank.size()));
  const double period = 1 / bank.program().description().device.rate;
  const auto at = [&](double time) { return place(time, radius, hand.frequency, circles); };
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

/// What a hand has gained at some moment, J, and where it is, m.
struct Gained {
  double joule = 0;
  glm::dvec2 place{0};
};

/// The most that a hand has gained at one of some moments, J. What a force by place gave it on its way, it takes back
/// on the way to where the hand began: of a gain counts what is left after the straight way back through the forces on
/// hands that have just entered.
double gained_for_good(const Bank& bank, glm::dvec2 from, std::vector<Gained> all) {
  std::erase_if(all, [](const Gained& each) { return !(each.joule > 0); });
  std::vector<Hand> hands;
  for (const Gained& each : all)
    for (std::size_t i = 0; i < way_back; ++i) {
      Hand& hand = hands.emplace_back();
      const double part = (static_cast<double>(i) + 0.5) / way_back;
      hand.position = hand.workspace = glm::vec2(each.place + part * (from - each.place));
    }
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  double most = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    glm::dvec2 mean{0};
    for (std::size_t k = 0; k < way_back; ++k) mean += glm::dvec2(forces[i * way_back + k]) / (1.0 * way_back);
    most = std::max(most, std::min(all[i].joule, all[i].joule + glm::dot(mean, from - all[i].place)));
  }
  return most;
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

Exploration explore(Bank bank, const GradingHand& hand) {
  const DeviceProfile& device = bank.program().description().device;
  const double radius = std::min(hand.radius, room_to_stroke(bank.size())), period = 1 / device.rate;
  const long ticks = std::lround(seconds * device.rate);
  Exploration exploration;
  exploration.changing.assign(bank.program().description().states.size(), false);
  for (const bool circles : {false, true}) {
    Memory memory(bank.program());
    const auto at = [&](double time) { return place(time, radius, hand.frequency, circles); };
    std::vector<float> entered;
    std::vector<Gained> gained;
    double work = 0, moved = 0;
    for (long i = 0; i < ticks; ++i) {
      const double time = static_cast<double>(i) * period;
      const Hand now = hand_along(at, time, period);
      if (i == 0) {
        memory.enter(bank, now);
        entered.assign(memory.states().begin(), memory.states().end());
      }
      for (std::size_t state = 0; state < entered.size(); ++state)
        if (memory.states()[state] != entered[state]) exploration.changing[state] = true;
      exploration.hands.push_back(now);
      exploration.states.insert(exploration.states.end(), memory.states().begin(), memory.states().end());
      // The step is centred on the hand's place, so that sampling gives almost no energy to a conservative field.
      const glm::dvec2 force = glm::dvec2(tick(bank, memory, now)),
                       step = 0.5 * (at(time + period) - at(time - period));
      const double joule = force.x * step.x + force.y * step.y;
      work += joule;
      moved += std::abs(joule);
      if ((i + 1) % std::max(1L, ticks / static_cast<long>(moments)) == 0)
        gained.push_back({work, at(time + 0.5 * period)});
    }
    exploration.gained_joule = std::max(exploration.gained_joule, gained_for_good(bank, at(0), std::move(gained)));
    exploration.moved_joule = std::max(exploration.moved_joule, moved);
  }
  return exploration;
}

}  // namespace wale
