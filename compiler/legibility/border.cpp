#include "compiler/legibility/border.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace wale {
namespace {

constexpr double usual_depth = 5e-3;     // m, in which a push is looked at behind the rim
constexpr double deepest = 0.25;         // of the shorter side
constexpr int places_of_period = 16;     // so that the mean of a wave is none
constexpr int fewest_places = 16;
constexpr std::size_t most_crossings = 64;
constexpr double of_one_side = 0.7;      // the cosine of half a right angle: ways within it lead over one side

/// The mean static force of a patch just within its border, which a hand leaves at `leaves` along `way` (of length 1).
glm::dvec2 mean_push(const LaidPatch& patch, const Cues& cues, std::span<const glm::dvec2> leaves,
                     std::span<const glm::dvec2> ways) {
  // Whole periods: of what swings, nothing is left in the mean.
  const double period = cues[CueKind::period].value_or(0);
  const double most = deepest * std::min(patch.size.width, patch.size.height);
  const double wanted = std::min(usual_depth, most);
  const double depth = period > 0 ? period * std::max(1.0, std::floor(wanted / period + 0.5)) : wanted;
  const int count = period > 0 ? places_of_period * static_cast<int>(std::lround(depth / period)) : fewest_places;
  const Bank bank(*patch.program, patch.program->default_parameters(), patch.size);
  std::vector<Hand> hands;
  for (std::size_t i = 0; i < leaves.size(); ++i)
    for (int at = 0; at < count; ++at) {
      const double within = patch.size.rim + (at + 0.5) / count * depth;
      const glm::dvec2 place = leaves[i] - within * ways[i] - glm::dvec2(patch.patch->at[0], patch.patch->at[1]);
      if (!patch.shape.contains(glm::vec2(place))) continue;
      Hand hand;
      hand.position = glm::vec2(place);
      hand.workspace = glm::vec2(leaves[i] - within * ways[i]);
      if (!patch.shape.is_rectangle()) {
        const EdgeDistance edge = patch.shape.edge(hand.position);
        hand.edge = edge.metres, hand.edge_slope = edge.slope;
      }
      hands.push_back(hand);
    }
  if (hands.empty()) return {0, 0};
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  glm::dvec2 sum{0};
  for (const Force each : forces)
    if (std::isfinite(each.x) && std::isfinite(each.y)) sum += glm::dvec2(each.x, each.y);
  return sum / static_cast<double>(forces.size());
}

}  // namespace

double border_step(const LaidPatch& a, const Cues& cues_of_a, const LaidPatch& b, const Cues& cues_of_b,
                   std::span<const Ground::Crossing> crossings) {
  std::vector<glm::dvec2> of_a, of_b, ways, back;
  const std::size_t step = std::max<std::size_t>(1, crossings.size() / most_crossings);
  for (std::size_t i = 0; i < crossings.size(); i += step) {
    const glm::dvec2 way = crossings[i].of_b - crossings[i].of_a;
    const double length = std::hypot(way.x, way.y);
    if (!(length > 0)) continue;
    of_a.push_back(crossings[i].of_a), of_b.push_back(crossings[i].of_b);
    ways.push_back(way / length), back.push_back(-way / length);
  }
  // A ring around the other patch pushes each way: its sides are told apart by where they lie.
  double most = 0;
  for (const glm::dvec2 side : {glm::dvec2(1, 0), glm::dvec2(-1, 0), glm::dvec2(0, 1), glm::dvec2(0, -1)}) {
    std::vector<glm::dvec2> from_a, from_b, along, against;
    for (std::size_t i = 0; i < ways.size(); ++i)
      if (ways[i].x * side.x + ways[i].y * side.y > of_one_side) {
        from_a.push_back(of_a[i]), from_b.push_back(of_b[i]), along.push_back(ways[i]), against.push_back(back[i]);
      }
    if (from_a.empty()) continue;
    const glm::dvec2 step = mean_push(a, cues_of_a, from_a, along) - mean_push(b, cues_of_b, from_b, against);
    most = std::max(most, std::hypot(step.x, step.y));
  }
  return most;
}

}  // namespace wale
