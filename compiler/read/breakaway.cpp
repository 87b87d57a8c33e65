#include "compiler/read/breakaway.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "compiler/read/dependence.hpp"
#include "compiler/read/room.hpp"
#include "compiler/read/tolerances.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

constexpr double creep = 0.003;          // m/s: too slow to keep a hand sliding
constexpr double longest_creep = 0.016;  // m: longer than any bristle stretches
constexpr double settled = 0.004;        // m without a larger force: it will not come
constexpr std::size_t ticks_at_once = 256;
constexpr double plainly_larger = 1.1;  // of the friction, and so much at most when the hand slides again
constexpr std::array<glm::dvec2, 4> ways = {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)};

/// A hand that creeps away from where it entered, and the force that held it, N.
struct Creep {
  glm::dvec2 from{0}, way{0};
  double held = 0, least_after = HUGE_VAL;  // the largest force, and the least since
  double held_at = 0;                       // m from where it entered

  void feel(double force, double gone) {
    if (force > held)
      held = force, held_at = gone, least_after = HUGE_VAL;
    else
      least_after = std::min(least_after, force);
  }
};

/// Whether all hands have slid, or will not be held more than they are.
bool all_slid(const std::vector<Creep>& creeps, double sliding, double gone) {
  return std::ranges::all_of(creeps, [&](const Creep& each) {
    return gone - each.held_at > settled ||
           (each.held > plainly_larger * sliding && each.least_after < plainly_larger * sliding);
  });
}

}  // namespace

double breakaway_of(const Bank& bank, double sliding) {
  if (!(sliding >= least_force) || bank.program().description().states.empty()) return 0;
  const PatchSize patch = bank.size();
  const glm::dvec2 half = 0.5 * glm::dvec2(patch.width, patch.height) - static_cast<double>(patch.rim);
  const double rate = bank.program().description().device.rate;
  const double most = std::min(longest_creep, std::min(half.x, half.y));
  const Room room(bank);
  std::vector<Creep> creeps;
  for (const glm::dvec2 way : ways) creeps.push_back({room.nearest({-0.3 * half * way, way, 0, most}), way});
  const auto ticks = static_cast<std::size_t>(most / creep * rate);
  // There are too few hands to fill the lanes of a block: each runs alone.
  Bank own = bank;
  std::vector<Memory> memories(creeps.size(), Memory(own.program()));
  // What time makes of a memory is in none that has just begun: resting hands feel it, where the others began.
  const bool timed = goes_by_time(bank.program().description());
  std::vector<Memory> resting = memories;
  // Hands that have just entered at the same places and moments feel what is no friction.
  std::vector<Hand> fresh(ticks_at_once * creeps.size());
  std::vector<Force> felt(fresh.size()), unheld(fresh.size()), by_time(fresh.size(), Force(0));
  std::vector<Hand> begun(timed ? fresh.size() : 0);
  std::vector<Force> at_first(begun.size());
  const auto count = creeps.size();
  for (std::size_t tick = 0; tick < ticks; tick += ticks_at_once) {
    for (std::size_t i = 0; i < ticks_at_once; ++i) {
      const double seconds = static_cast<double>(tick + i) / rate;
      const std::span<Hand> hands = std::span(fresh).subspan(i * count, count);
      for (std::size_t k = 0; k < count; ++k) {
        hands[k] = {};
        hands[k].position = hands[k].workspace = glm::vec2(creeps[k].from + seconds * creep * creeps[k].way);
        hands[k].velocity = hands[k].raw_velocity = glm::vec2(creep * creeps[k].way);
        hands[k].time = seconds;
      }
      for (std::size_t k = 0; k < count; ++k) {
        if (tick + i == 0) memories[k].enter(own, hands[k]);
        felt[i * count + k] = wale::tick(own, memories[k], hands[k]);
        if (!timed) continue;
        Hand& still = begun[i * count + k];
        still = {};
        still.position = still.workspace = glm::vec2(creeps[k].from), still.time = seconds;
        if (tick + i == 0) resting[k].enter(own, still);
        by_time[i * count + k] = wale::tick(own, resting[k], still);
      }
    }
    tick_all(bank, fresh, unheld);
    if (timed) tick_all(bank, begun, at_first);
    for (std::size_t i = 0; i < begun.size(); ++i) unheld[i] += by_time[i] - at_first[i];
    for (std::size_t i = 0; i < fresh.size(); ++i) {
      Creep& each = creeps[i % count];
      each.feel(-glm::dot(glm::dvec2(felt[i] - unheld[i]), each.way),
                static_cast<double>(tick + i / count) / rate * creep);
    }
    if (all_slid(creeps, sliding, static_cast<double>(tick + ticks_at_once) / rate * creep)) break;
  }
  // A force that does not fall back to the friction is another memory's.
  std::vector<double> held;
  for (const Creep& each : creeps)
    if (each.held > plainly_larger * sliding && each.least_after < plainly_larger * sliding) held.push_back(each.held);
  if (2 * held.size() < count) return 0;
  std::ranges::sort(held);
  return held[held.size() / 2];
}

}  // namespace wale
