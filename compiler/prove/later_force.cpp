#include "compiler/prove/later_force.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <vector>

#include "compiler/prove/prove.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

constexpr float lasting = 1e9f;        // s, thirty years: a time at which formulas still give numbers
constexpr float plainly_more = 0.05f;  // of what it may come to before
constexpr float least = 0.01f;         // N
constexpr std::size_t looks = 16;      // at the states, in the later half of the seconds

/// The ranges of the states that still drift at the end, as a clock does: all that they went through. Those of the
/// others, which come back as phases do or have settled, are as they were.
std::vector<Interval> drifting(const Bank& bank, double seconds, const std::vector<Interval>& whole) {
  Bank own = bank;
  Memory memory(own.program());
  const double rate = bank.program().description().device.rate;
  const auto ticks = static_cast<long>(seconds * rate);
  const std::size_t count = whole.size();
  std::vector<float> low(count), high(count), before(count);
  std::vector<int> up(count), down(count);
  Hand hand;
  memory.enter(own, hand);
  long look = ticks / 2;
  for (long now = 0; now < ticks; ++now) {
    hand.time = static_cast<double>(now) / rate;
    tick(own, memory, hand);
    const auto states = memory.states();
    const bool looked_at = now == look;
    for (std::size_t i = 0; i < count; ++i) {
      const float state = states[i];
      low[i] = now == 0 ? state : std::min(low[i], state), high[i] = now == 0 ? state : std::max(high[i], state);
      if (!looked_at) continue;
      if (now > ticks / 2) up[i] += state > before[i], down[i] += state < before[i];
      before[i] = state;
    }
    // Not evenly, so that no period looks as if it stood still or crept.
    if (looked_at) look += ticks / 2 / static_cast<long>(looks + 1) + (look * look) % 7;
  }
  std::vector<Interval> ranges = whole;
  for (std::size_t i = 0; i < count; ++i) {
    const int changes = up[i] + down[i];
    const bool drifts = changes > static_cast<int>(looks / 2) && (up[i] == 0 || down[i] == 0);
    if (drifts) ranges[i] = Interval::between(low[i], high[i]);
  }
  return ranges;
}

/// A hand whose force is proved: one alone, since over all hands a spring or the device's limit hides what time adds.
struct SomeHand {
  float x, y;    // of half of the patch
  float vx, vy;  // m/s
};
constexpr std::array<SomeHand, 4> some_hands = {
    {{0, 0, 0, 0}, {0.31f, -0.17f, 0, 0}, {-0.43f, 0.59f, 0.1f, 0.15f}, {0.07f, 0.11f, -0.2f, 0.05f}}};

Domain with(Domain domain, const Bank& bank, const SomeHand& hand) {
  const auto set = [&](std::initializer_list<Input> inputs, float value) {
    for (const Input input : inputs) domain[input] = Interval::of(value);
  };
  set({Input::x, Input::workspace_x}, hand.x * 0.5f * bank.size().width);
  set({Input::y, Input::workspace_y}, hand.y * 0.5f * bank.size().height);
  set({Input::velocity_x, Input::raw_velocity_x}, hand.vx);
  set({Input::velocity_y, Input::raw_velocity_y}, hand.vy);
  set({Input::acceleration_x, Input::acceleration_y, Input::raw_acceleration_x, Input::raw_acceleration_y}, 0);
  return domain;
}

/// Whether one of the forces may be plainly outside of all that it may be by another proof.
bool may_be_more(const Proof& ever, const Proof& before) {
  for (const std::size_t axis : {0, 1}) {
    const Interval &all = ever.force[axis], &some = before.force[axis];
    const float beyond = std::max(some.low - all.low, all.high - some.high);
    if (beyond > std::max(least, plainly_more * some.largest())) return true;
  }
  return false;
}

}  // namespace

double later_force(const Bank& bank, double seconds, bool remembers_time_only) {
  const PatchProgram& program = bank.program().description();
  const bool timed = std::ranges::any_of(program.tick, [](const Instruction& each) {
    constexpr auto time = static_cast<RegisterNumber>(Input::time);
    return each.a == time || each.b == time || each.c == time;
  });
  if (!timed && !remembers_time_only) return 0;
  Domain domain = domain_of(bank);
  Domain at_first = domain;
  domain[Input::time] = Interval::between(0, lasting);
  at_first[Input::time] = Interval::between(0, static_cast<float>(seconds));
  if (remembers_time_only) at_first.states = drifting(bank, seconds, at_first.states);
  const bool more = std::ranges::any_of(some_hands, [&](const SomeHand& hand) {
    return may_be_more(prove(bank.program(), with(domain, bank, hand)),
                       prove(bank.program(), with(at_first, bank, hand)));
  });
  return more ? prove(bank.program(), domain).bound_newton : 0;
}

}  // namespace wale
