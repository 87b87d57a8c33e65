#include "compiler/read/sharp_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <vector>

#include "compiler/read/still_forces.hpp"

namespace wale {
namespace {

constexpr std::size_t places_on_step = 15;  // along the step's line
constexpr std::size_t fewest_on_step = 5;   // of them, at which it is seen to jump
constexpr double looked_from = 0.75e-3;     // m beside the line, from where it is looked for at least
constexpr double widths_away = 3;           // the same, of its width
constexpr int times_halved = 14;            // from millimetres to a tenth of a micrometre
constexpr double half_of_a_jump = 0.5e-6;   // m on either side, over which a jump happens
constexpr double most_of_step = 0.7;        // of the step
constexpr double off_its_line = 5e-6;       // m: the jump of something else
constexpr double same_step = 0.25;          // of the size: otherwise it is another step

/// A place where the force jumps.
struct Jump {
  double along = 0, across = 0;  // m along the line that was found, and across it
  glm::dvec2 change{0};          // N
};

/// The places of a line within the patch.
std::vector<glm::dvec2> places_on_line(const Bank& bank, const StaticStep& step) {
  const glm::dvec2 half =
      0.5 * glm::dvec2(bank.size().width, bank.size().height) - static_cast<double>(bank.size().rim);
  const glm::dvec2 middle = step.offset * step.way, along(-step.way.y, step.way.x);
  double low = -glm::length(half), high = glm::length(half);
  for (const int axis : {0, 1}) {
    if (std::abs(along[axis]) < 1e-9) continue;
    const double one = (-half[axis] - middle[axis]) / along[axis], other = (half[axis] - middle[axis]) / along[axis];
    low = std::max(low, std::min(one, other)), high = std::min(high, std::max(one, other));
  }
  std::vector<glm::dvec2> found;
  for (std::size_t i = 0; low < high && i < places_on_step; ++i)
    found.push_back(middle + (low + (high - low) * (static_cast<double>(i) + 0.5) / places_on_step) * along);
  return found;
}

/// Where the force jumps across the line, by halving at all places at once.
std::vector<Jump> jumps_across(const Bank& bank, const StaticStep& step) {
  const std::vector<glm::dvec2> line = places_on_line(bank, step);
  const glm::dvec2 of = glm::normalize(step.change), along(-step.way.y, step.way.x);
  const double far = std::max(looked_from, widths_away * step.width);
  std::vector<double> before(line.size(), -far), behind(line.size(), far);
  const auto felt = [&](const std::vector<double>& across, double more) {
    std::vector<glm::dvec2> there = line;
    for (std::size_t i = 0; i < there.size(); ++i) there[i] += (across[i] + more) * step.way;
    return forces_at(bank, there);
  };
  if (line.empty()) return {};
  const std::vector<glm::dvec2> first = felt(before, 0), last = felt(behind, 0);
  for (int turn = 0; turn < times_halved; ++turn) {
    std::vector<double> middle(line.size());
    for (std::size_t i = 0; i < middle.size(); ++i) middle[i] = 0.5 * (before[i] + behind[i]);
    const std::vector<glm::dvec2> here = felt(middle, 0);
    for (std::size_t i = 0; i < middle.size(); ++i)
      (glm::dot(here[i] - 0.5 * (first[i] + last[i]), of) < 0 ? before : behind)[i] = middle[i];
  }
  const std::vector<glm::dvec2> lower = felt(before, -half_of_a_jump), higher = felt(behind, half_of_a_jump);
  std::vector<Jump> found;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const glm::dvec2 change = higher[i] - lower[i];
    if (glm::dot(change, of) >= most_of_step * glm::length(step.change))
      found.push_back({glm::dot(line[i], along), 0.5 * (before[i] + behind[i]), change});
  }
  return found;
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// The straight line through jumps, as their place across at no place along, and its slope. What is farthest off is
/// left out until all others are on it; nothing if too few are.
std::optional<glm::dvec2> line_through_jumps(std::vector<Jump>& jumps) {
  while (jumps.size() >= fewest_on_step) {
    const auto count = static_cast<double>(jumps.size());
    double x = 0, y = 0, xx = 0, xy = 0;
    for (const Jump& each : jumps) x += each.along / count, y += each.across / count;
    for (const Jump& each : jumps)
      xx += (each.along - x) * (each.along - x), xy += (each.along - x) * (each.across - y);
    const double slope = xx > 0 ? xy / xx : 0;
    const auto off = [&](const Jump& each) { return std::abs(each.across - y - slope * (each.along - x)); };
    const auto farthest = std::ranges::max_element(jumps, {}, off);
    if (off(*farthest) <= off_its_line) return glm::dvec2(y - slope * x, slope);
    jumps.erase(farthest);
  }
  return std::nullopt;
}

}  // namespace

void sharpen(const Bank& bank, StaticStep& step) {
  if (!(glm::length(step.change) > 0)) return;
  std::vector<Jump> jumps = jumps_across(bank, step);
  const auto line = line_through_jumps(jumps);
  if (!line) return;
  std::vector<double> x, y;
  for (const Jump& each : jumps) x.push_back(each.change.x), y.push_back(each.change.y);
  const glm::dvec2 change(median_of(x), median_of(y));
  if (glm::distance(change, step.change) > same_step * glm::length(step.change)) return;
  const glm::dvec2 along(-step.way.y, step.way.x);
  const glm::dvec2 on_line = (step.offset + line->x) * step.way;
  step.way = glm::normalize(step.way - line->y * along);
  step.offset = glm::dot(on_line, step.way), step.width = 0, step.change = change;
}

}  // namespace wale
