#include "compiler/grade/explore.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compiler/measure/strokes.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

using std::numbers::pi;
constexpr double seconds = 1;

/// The hand's place, m. It begins at rest at the centre and reaches its full radius after a quarter of the time.
glm::dvec2 place(double time, double radius, double frequency, bool circles) {
  const double angle = 2 * pi * frequency * time;
  return radius * coming_up(time, seconds / 4) * glm::dvec2(std::sin(angle), circles ? std::cos(angle) : 0.0);
}

}  // namespace

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
    double work = 0, gained = 0, moved = 0;
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
      gained = std::max(gained, work);
    }
    exploration.gained_joule = std::max(exploration.gained_joule, gained);
    exploration.moved_joule = std::max(exploration.moved_joule, moved);
  }
  return exploration;
}

}  // namespace wale
