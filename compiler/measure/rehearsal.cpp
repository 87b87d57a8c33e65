#include "compiler/measure/rehearsal.hpp"

#include <algorithm>
#include <cmath>

#include "compiler/measure/strokes.hpp"

namespace wale {
namespace {

constexpr double least_seconds = 1, most_seconds = 5;
constexpr double bend = 0.3;         // sideways, as a share of the stroke's reach, so that a trajectory is visible
constexpr double whole_after = 0.3;  // s until the stroke has its full reach
constexpr double last_phase = 0.9;   // rad; the picture is taken while the hand is moving
constexpr double most_rate = 20000;  // Hz; a device that claims more is rehearsed at this
constexpr long most_samples = 2400;
constexpr double two_pi = 6.283185307179586;

/// A motion to and fro like that of a declared hand (`showing` of calibration/hands/hands.wale).
struct Stroke {
  double reach = 0, frequency = 0;  ///< m to both sides of the centre; Hz
  double seconds = 0;               ///< duration
  glm::dvec2 way{1, 0};             ///< of length 1

  /// The hand's place at a time (s), in m. It begins at rest at the centre.
  glm::dvec2 operator()(double time) const {
    const double phase = two_pi * frequency * (time - seconds) + last_phase;
    const double onward = std::sin(phase), aside = bend * std::sin(phase / 2 + 0.7);
    return (onward * way + aside * glm::dvec2(-way.y, way.x)) * (coming_up(time, whole_after) * reach);
  }
};

Stroke stroke_over(PatchSize size, double seconds, const HandDeclaration* hand) {
  Stroke stroke{.reach = room_to_stroke(size), .seconds = seconds};
  if (hand) {
    stroke.reach = std::min(stroke.reach, hand->lateral_amplitude);
    stroke.frequency = hand->lateral_frequency;
  }
  return stroke;
}

double longest_trajectory(const std::vector<ShownMark>& marks) {
  double longest = 0;
  for (const ShownMark& mark : marks) {
    if (mark.kind == MarkKind::trajectory && mark.values[2] > longest) longest = mark.values[2];
  }
  return longest;
}

}  // namespace

bool remembers(const PatchProgram& program) { return !program.states.empty() || !program.grids.empty(); }

Rehearsal rehearse(Bank bank, const HandDeclaration* hand, std::optional<double> seconds, double along) {
  const PatchProgram& program = bank.program().description();
  Rehearsal result(bank.program());
  if (along != 0) result.way = {std::cos(along), std::sin(along)};
  result.memory.enter(bank, {});
  result.marks = show(bank, result.memory, {});
  result.paths.resize(result.marks.size());
  if (!remembers(program) && result.marks.empty()) return result;

  const double rate = program.device.rate > 0 ? std::min(program.device.rate, most_rate) : 1000;
  result.seconds = seconds.value_or(std::clamp(longest_trajectory(result.marks), least_seconds, most_seconds));
  Stroke stroke = stroke_over(bank.size(), result.seconds, hand);
  stroke.way = result.way;
  const long ticks = std::lround(result.seconds * rate), every = std::max(1L, ticks / most_samples);
  std::vector<std::vector<ShownMark>> shown;
  for (long i = 0; i <= ticks; ++i) {
    result.hand = hand_along(stroke, static_cast<double>(i) / rate, 1 / rate);
    const Force force = tick(bank, result.memory, result.hand);
    if ((ticks - i) % every != 0) continue;
    result.times.push_back(result.hand.time);
    result.places.push_back(result.hand.position);
    result.forces.push_back(force);
    shown.push_back(show(bank, result.memory, result.hand));
  }
  result.marks = shown.back();
  for (std::size_t mark = 0; mark < result.marks.size(); ++mark) {
    if (result.marks[mark].kind != MarkKind::trajectory) continue;
    const double since = result.hand.time - result.marks[mark].values[2];
    for (std::size_t i = 0; i < shown.size(); ++i) {
      if (result.times[i] >= since) result.paths[mark].emplace_back(shown[i][mark].values[0], shown[i][mark].values[1]);
    }
  }
  return result;
}

}  // namespace wale
