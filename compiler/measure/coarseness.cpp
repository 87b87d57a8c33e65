#include "compiler/measure/coarseness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "compiler/measure/rehearsal.hpp"
#include "compiler/text/readable.hpp"
#include "wale/picture.hpp"

namespace wale {

namespace {

/// Units of cost of a tick up to which every hand is run: a description then takes a second or two.
constexpr double most_for_every_hand = 1 << 19;
/// Units of cost of all samples of a picture: about two seconds, since a block of hands is run at once.
constexpr double most_for_a_picture = 0x1p35;
constexpr double of_remembering = 4;

std::size_t coarseness_at(double cost) {
  return static_cast<std::size_t>(std::max(1.0, std::ceil(cost / most_for_every_hand)));
}

/// Runs `run` on every so-many-th item, and lets each result stand for those behind it.
template <typename Item, typename Value, typename Run>
void run_coarsely(std::size_t every, std::span<const Item> items, std::span<Value> values, Run run) {
  std::vector<Item> some;
  for (std::size_t i = 0; i < items.size(); i += every) some.push_back(items[i]);
  std::vector<Value> found(some.size());
  run(some, found);
  for (std::size_t i = 0; i < items.size(); ++i) values[i] = found[i / every];
}

}  // namespace

std::size_t coarseness_of(const PatchProgram& program) {
  const auto cost = static_cast<double>(cost_of(program.enter) + cost_of(program.tick));
  return coarseness_at(remembers(program) ? of_remembering * cost : cost);
}

bool leaves_out_motion(const PatchProgram& program) { return remembers(program) && coarseness_of(program) > 1; }

std::size_t parameters_searched(const PatchProgram& program) {
  constexpr std::size_t most_units = std::size_t{1} << 18, least = 4, most = 64;
  const auto units = static_cast<std::size_t>(cost_of(program.setup) + cost_of(program.enter) + cost_of(program.tick)) +
                     program.register_count();
  return std::clamp(most_units / std::max<std::size_t>(1, units), least, most);
}

void tick_coarsely(const Bank& bank, std::span<const Hand> hands, std::span<Force> forces) {
  const std::size_t every = coarseness_of(bank.program().description());
  if (every == 1) return tick_all(bank, hands, forces);
  run_coarsely(every, hands, forces, [&](const auto& some, auto& felt) { tick_all(bank, some, felt); });
}

void surface_coarsely(const Bank& bank, const Memory* memory, std::span<const glm::vec2> positions,
                      std::span<float> heights) {
  const std::size_t every = coarseness_at(static_cast<double>(cost_of(bank.program().description().picture.code)));
  if (every == 1) return surface_all(bank, memory, positions, heights);
  run_coarsely(every, positions, heights,
               [&](const auto& some, auto& found) { surface_all(bank, memory, some, found); });
}

int pixels_of_a_sample(double cost, int side) {
  const double whole = cost * side * side;
  return static_cast<int>(std::max(1.0, std::ceil(std::sqrt(whole / most_for_a_picture))));
}

std::string coarseness_note(const std::string& material, std::size_t coarseness) {
  return readable(
      "the tick of `{}` costs so much that only one of {} places was sampled; if it remembers, its answer "
      "to motion was not measured",
      material, coarseness);
}

}  // namespace wale
