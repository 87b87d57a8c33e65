#include "compiler/grade/switching.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "compiler/measure/hands.hpp"
#include "compiler/read/dependence.hpp"

namespace wale {
namespace {

constexpr std::size_t places_stroked = 64;
constexpr std::size_t points = 128;  // on a stroke

/// J: the most that the difference of two fields gives on a part of a line.
double most_on_part(const std::vector<double>& gains) {
  double sum = 0, least = 0, most = 0;
  for (const double each : gains) sum += each, least = std::min(least, sum), most = std::max(most, sum);
  return most - least;
}

}  // namespace

double switching_watt(const Bank& bank, const GradingHand& hand) {
  const PatchProgram& program = bank.program().description();
  if (!reads(program, {Input::button})) return 0;
  if (!program.grids.empty() || (!program.states.empty() && !remembers_time_only(program))) return 0;
  const glm::dvec2 half = 0.5 * glm::dvec2(bank.size().width, bank.size().height);
  const double diagonal = 1 / std::numbers::sqrt2;
  const std::array<glm::dvec2, 4> ways = {{{1, 0}, {0, 1}, {diagonal, diagonal}, {diagonal, -diagonal}}};
  const double step = 2 * hand.radius / points;
  double joule = 0;
  for (const Hand& centre : hands_at_rest(places_stroked, glm::vec2(half))) {
    std::vector<Hand> up;
    for (const glm::dvec2 way : ways)
      for (std::size_t i = 0; i < points; ++i) {
        Hand& each = up.emplace_back();
        const double along = step * (static_cast<double>(i) + 0.5) - hand.radius;
        each.position = each.workspace = glm::vec2(glm::clamp(glm::dvec2(centre.position) + along * way, -half, half));
      }
    std::vector<Hand> down = up;
    for (Hand& each : down) each.button = true;
    std::vector<Force> open(up.size()), pressed(up.size());
    tick_all(bank, up, open), tick_all(bank, down, pressed);
    for (std::size_t way = 0; way < ways.size(); ++way) {
      std::vector<double> gains;
      for (std::size_t i = way * points; i < (way + 1) * points; ++i) {
        // A stroke that would leave the patch ends at its edge.
        const bool inside = std::abs(up[i].position.x) < half.x && std::abs(up[i].position.y) < half.y;
        gains.push_back(inside ? step * glm::dot(glm::dvec2(pressed[i]) - glm::dvec2(open[i]), ways[way]) : 0);
      }
      joule = std::max(joule, most_on_part(gains));
    }
  }
  return joule * hand.frequency;
}

}  // namespace wale
