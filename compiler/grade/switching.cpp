#include "compiler/grade/switching.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "compiler/grade/exploring_place.hpp"
#include "compiler/measure/hands.hpp"
#include "compiler/read/dependence.hpp"

namespace wale {
namespace {

constexpr std::size_t places_stroked = 64;
constexpr std::size_t points = 128;  // on a stroke

/// J: the most that adjacent gains come to, of which there are at most `longest`.
double most_on_part(std::span<const double> gains, std::size_t longest) {
  double most = 0;
  for (std::size_t first = 0; first < gains.size(); ++first) {
    double sum = 0;
    for (std::size_t i = first; i < std::min(first + longest, gains.size()); ++i)
      sum += gains[i], most = std::max(most, sum);
  }
  return most;
}

/// The forces on hands that go along their ways at `speed` (m/s), with the button down or up.
std::vector<Force> forces_at(const Bank& bank, std::vector<Hand> hands, std::span<const glm::dvec2> ways, double speed,
                             bool button) {
  for (std::size_t i = 0; i < hands.size(); ++i) {
    hands[i].velocity = hands[i].raw_velocity = glm::vec2(speed * ways[i / points]);
    hands[i].button = button;
  }
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  return forces;
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
  // Along the way, of a hand that swings: what a drag takes from it is what it takes at this speed.
  const double mean_speed = std::numbers::pi / 4 * hand.speed();
  const bool moving = depends_on_motion(program);
  double joule = 0;
  for (const Hand& centre : hands_at_rest(places_stroked, glm::vec2(half))) {
    std::vector<Hand> up;
    for (const glm::dvec2 way : ways)
      for (std::size_t i = 0; i < points; ++i) {
        Hand& each = up.emplace_back();
        const double along = step * (static_cast<double>(i) + 0.5) - hand.radius;
        each.position = each.workspace = glm::vec2(glm::clamp(glm::dvec2(centre.position) + along * way, -half, half));
      }
    // Without drag the longest strokes give most; with it, shorter ones in the same time, which are slower.
    for (const double pace : slower_paces) {
      const double speed = moving ? pace * mean_speed : 0;
      const std::array open = {forces_at(bank, up, ways, speed, false), forces_at(bank, up, ways, -speed, false)};
      const std::array held = {forces_at(bank, up, ways, speed, true), forces_at(bank, up, ways, -speed, true)};
      const auto longest = static_cast<std::size_t>(pace * points);
      for (std::size_t way = 0; way < ways.size(); ++way)
        for (const auto& [forth, back] : {std::pair(&open[0], &held[1]), std::pair(&held[0], &open[1])}) {
          std::vector<double> gains;
          for (std::size_t i = way * points; i < (way + 1) * points; ++i) {
            // A stroke that would leave the patch ends at its edge.
            const bool inside = std::abs(up[i].position.x) < half.x && std::abs(up[i].position.y) < half.y;
            const glm::dvec2 difference = glm::dvec2((*forth)[i]) - glm::dvec2((*back)[i]);
            gains.push_back(inside ? step * glm::dot(difference, ways[way]) : 0);
          }
          joule = std::max(joule, most_on_part(gains, longest));
        }
      if (!moving) break;
    }
  }
  return joule * hand.frequency;
}

}  // namespace wale
