#include "compiler/grade/steep_places.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>

namespace wale {
namespace {

using std::numbers::pi;
constexpr std::size_t climbers = 8;    // places from which steeper ones are searched
constexpr std::size_t directions = 8;  // tried in each step
constexpr int climbs = 14;             // steps, each half as long as the one before

/// The numbers of the steepest hands; of equally steep ones the first.
std::vector<std::size_t> steepest_of(std::span<const ProgramSlopes::ByPlace> at) {
  std::vector<double> steep(at.size());
  std::ranges::transform(at, steep.begin(), steepness, &ProgramSlopes::ByPlace::place);
  return greatest_of(steep, climbers);
}

}  // namespace

std::vector<std::size_t> greatest_of(std::span<const double> values, std::size_t most) {
  std::vector<std::size_t> numbers(values.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = i;
  const std::size_t count = std::min(most, numbers.size());
  std::ranges::partial_sort(
      numbers, numbers.begin() + static_cast<std::ptrdiff_t>(count),
      [&](std::size_t a, std::size_t b) { return values[a] > values[b] || (values[a] == values[b] && a < b); });
  numbers.resize(count);
  return numbers;
}

double steepness(const Slopes& by_place) {
  const double norm = spectral_norm(by_place);
  return std::isfinite(norm) ? norm : 0;
}

SteepPlaces find_steepest(ProgramSlopes& slopes, const LookedAt& looked_at, glm::vec2 extent) {
  if (looked_at.hands.empty()) return {};
  const std::size_t state_count = looked_at.states.size() / looked_at.hands.size();
  const auto states_of = [state_count](std::span<const float> states, std::size_t hand) {
    return states.subspan(hand * state_count, state_count);
  };
  SteepPlaces best;
  std::vector<double> steepest;
  for (const std::size_t i : steepest_of(looked_at.at)) {
    best.hands.push_back(looked_at.hands[i]);
    const auto states = states_of(looked_at.states, i);
    best.states.insert(best.states.end(), states.begin(), states.end());
    steepest.push_back(steepness(looked_at.at[i].place));
  }
  // The first step is the distance between the hands of the lattice.
  glm::vec2 step = extent / std::sqrt(static_cast<float>(lattice_hands));
  std::vector<Hand> tried;
  std::vector<float> tried_states;
  for (int round = 0; round < climbs; ++round, step *= 0.5f) {
    tried.clear(), tried_states.clear();
    for (std::size_t i = 0; i < best.hands.size(); ++i)
      for (std::size_t direction = 0; direction < directions; ++direction) {
        const auto angle = static_cast<float>(static_cast<double>(direction) * pi / 4);
        Hand& hand = tried.emplace_back(best.hands[i]);
        const glm::vec2 moved = step * glm::vec2(std::cos(angle), std::sin(angle));
        hand.position = glm::clamp(hand.position + moved, -extent, extent);
        hand.workspace += moved;
        const auto states = states_of(best.states, i);
        tried_states.insert(tried_states.end(), states.begin(), states.end());
      }
    const auto at = slopes.by_place(tried, tried_states);
    for (std::size_t i = 0; i < tried.size(); ++i)
      if (const double here = steepness(at[i].place); here > steepest[i / directions])
        steepest[i / directions] = here, best.hands[i / directions] = tried[i];
  }
  const auto top = static_cast<std::size_t>(std::ranges::max_element(steepest) - steepest.begin());
  best.stiffness = steepest[top];
  best.where = {best.hands[top].position, best.hands[top].velocity};
  return best;
}

}  // namespace wale
