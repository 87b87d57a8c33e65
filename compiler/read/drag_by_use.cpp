#include "compiler/read/drag_by_use.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "compiler/read/dependence.hpp"
#include "compiler/read/tolerances.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

constexpr double speed_in_use = 0.2;   // m/s
constexpr double seconds_in_use = 2.5;  // so that half a metre is gone
constexpr double changes_plainly = 0.1;  // of the greater one
constexpr double goes_back = 0.1;        // of the whole change, from one time to the next
constexpr std::size_t fewest_times = 4;

}  // namespace

DragByUse drag_by_use(const Bank& bank, const std::vector<Stroke>& strokes, const Outside& outside) {
  const PatchProgram& program = bank.program().description();
  if (!remembers_anything(program) || remembers_time_only(program) || goes_by_time(program)) return {};
  const auto stroke = std::ranges::find(strokes, speed_in_use, &Stroke::speed);
  if (stroke == strokes.end()) return {};
  const double rate = program.device.rate;
  Bank own = bank;
  Memory memory(own.program());
  std::vector<double> times;
  double sum = 0;
  long count = 0;
  const auto ticks = static_cast<long>(seconds_in_use * rate);
  for (long now = 0; now < ticks; ++now) {
    const auto [along, forth] = stroke->at(now, rate);
    Hand hand = stroke->hand(along, forth);
    hand.time = static_cast<double>(now) / rate;
    if (now == 0) memory.enter(own, hand);
    const double pushed = glm::dot(glm::dvec2(tick(own, memory, hand)), stroke->direction);
    // The first half of a way settles what turns about with the hand.
    if (now < stroke->pass / 2) continue;
    if (stroke->counts_at(along) && outside.at(glm::dvec2(hand.position))) sum += forth ? -pushed : pushed, ++count;
    if ((now - stroke->pass / 2 + 1) % (2 * stroke->pass) != 0) continue;
    if (count > 0) times.push_back(sum / static_cast<double>(count));
    sum = 0, count = 0;
  }
  if (times.size() < fewest_times) return {};
  DragByUse found{.first = times.front(), .last = times.back()};
  const double change = found.last - found.first;
  if (std::abs(change) <
      std::max(least_force, changes_plainly * std::max(std::abs(found.first), std::abs(found.last))))
    return {};
  // What swings goes to and fro too.
  for (std::size_t i = 1; i < times.size(); ++i)
    if ((times[i] - times[i - 1]) * change < -goes_back * change * change) return {};
  found.changes = true, found.way = static_cast<double>(ticks) / rate * speed_in_use;
  return found;
}

}  // namespace wale
