#include "wale/felt.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <numbers>
#include <span>

#include "runtime/stage/felt_response.hpp"

namespace wale {
namespace {

ForceSize size_of(std::vector<float> magnitudes) {
  if (magnitudes.empty()) return {};
  double squares = 0;
  for (const float magnitude : magnitudes) squares += static_cast<double>(magnitude) * magnitude;
  const auto n = static_cast<double>(magnitudes.size());
  const auto rank = magnitudes.begin() + static_cast<std::ptrdiff_t>(std::ceil(0.99 * n)) - 1;
  std::nth_element(magnitudes.begin(), rank, magnitudes.end());
  return {*rank, *std::max_element(rank, magnitudes.end()), static_cast<float>(std::sqrt(squares / n))};
}

/// For each tick, whether the hand moved at most `distance` (m) on each axis within `ticks` ticks around it.
std::vector<bool> find_stuck(std::span<const TickRecord> record, std::ptrdiff_t ticks, double distance) {
  const auto n = static_cast<std::ptrdiff_t>(record.size());
  std::vector<bool> stuck(record.size());
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const std::ptrdiff_t from = std::max(std::ptrdiff_t{0}, i - ticks / 2), to = std::min(n - 1, i + ticks / 2);
    glm::vec2 low = record[i].position, high = low;
    for (std::ptrdiff_t k = from; k <= to; ++k) {
      low = glm::min(low, record[k].position);
      high = glm::max(high, record[k].position);
    }
    stuck[i] = std::max(high.x - low.x, high.y - low.y) <= distance;
  }
  return stuck;
}

/// The axis with more force: 0 x, 1 y.
int main_axis(std::span<const TickRecord> record) {
  glm::dvec2 squares(0);
  for (const TickRecord& tick : record) squares += glm::dvec2(tick.force) * glm::dvec2(tick.force);
  return squares.y > squares.x ? 1 : 0;
}

int sign_of(float value) { return (value > 0) - (value < 0); }

/// Counts swings of the force along its main axis between its two sides, and those of them during which the hand keeps
/// its direction. A texture may push more to one side than to the other, as ridges with one steep flank do. So its sides
/// are told by its own range, as far as the amplitude goes: the upper and the lower quarter. A force that stays below
/// half of the amplitude has none.
void count_swings(std::span<const TickRecord> record, float amplitude, Felt& felt) {
  const int axis = main_axis(record);
  float least = amplitude, most = -amplitude;
  for (const TickRecord& tick : record) {
    const float force = std::clamp(tick.force[axis], -amplitude, amplitude);
    least = std::min(least, force), most = std::max(most, force);
  }
  if (!(std::max(std::abs(least), std::abs(most)) > amplitude / 2)) return;
  const float middle = (least + most) / 2, quarter = (most - least) / 4;
  int side = 0;
  glm::vec2 direction(0);  // of the hand at the last swing
  for (const TickRecord& tick : record) {
    const float off = tick.force[axis] - middle;
    if (std::abs(off) <= quarter || sign_of(off) == side) continue;
    if (side != 0) {
      ++felt.alternations;
      if (glm::dot(tick.velocity, direction) > 0) ++felt.crossings;
    }
    side = sign_of(off);
    direction = tick.velocity;
  }
}

/// Makes the forces that actuators were told those that they exert: of each tick the mean until the next,
/// behind a low-pass of the first order whose input is held: the solution of dy/dt = (u - y) / T for a constant u.
void let_through(std::vector<TickRecord>& ticks, double seconds_per_tick, glm::dvec2 bandwidth) {
  for (const int axis : {0, 1}) {
    const double turn = 2 * std::numbers::pi * bandwidth[axis] * seconds_per_tick;
    if (!(turn > 0)) continue;
    double exerted = 0;  // N, when the tick begins
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      const double periods = i + 1 < ticks.size() ? 1.0 + ticks[i + 1].skipped : 1;
      const double wanted = ticks[i].force[axis], off = exerted - wanted;
      ticks[i].force[axis] = static_cast<float>(wanted - off * std::expm1(-turn * periods) / (turn * periods));
      exerted = wanted + off * std::exp(-turn * periods);
    }
  }
}

void measure_movement(std::span<const TickRecord> record, Felt& felt) {
  if (record.empty()) return;
  const auto n = static_cast<double>(record.size());
  glm::dvec2 mean(0);
  for (const TickRecord& tick : record) mean += glm::dvec2(tick.position) / n;
  glm::vec2 low = record.front().position, high = low;
  double squares = 0;
  for (const TickRecord& tick : record) {
    const glm::dvec2 off = glm::dvec2(tick.position) - mean;
    squares += glm::dot(off, off);
    low = glm::min(low, tick.position);
    high = glm::max(high, tick.position);
  }
  felt.position_rms = std::sqrt(squares / n);
  felt.position_range = std::max(high.x - low.x, high.y - low.y);
}

/// On a pad the first number of each tick's output is the amplitude, the second the frequency.
FeltVibration vibration_of(std::span<const TickRecord> record) {
  FeltVibration felt;
  std::vector<float> amplitudes;
  for (const TickRecord& tick : record)
    if (tick.inside) amplitudes.push_back(tick.force.x);
  felt.ticks = static_cast<long>(amplitudes.size());
  felt.acceleration = size_of(std::move(amplitudes));
  for (const TickRecord& tick : record) {
    if (!tick.inside || !(tick.force.x > 0) || tick.force.x < felt.acceleration.p99 / 2) continue;
    felt.lowest = felt.highest > 0 ? std::min(felt.lowest, tick.force.y) : tick.force.y;
    felt.highest = std::max(felt.highest, tick.force.y);
  }
  return felt;
}

Error not_measured(const PerceptRecord& percept, std::string sentence) {
  return {.code = Code::not_measured, .sentence = std::move(sentence), .place = {.name = percept.name}};
}

/// The carrier's size on a pad, m/s^2.
Result<float> size_from_vibration(const PerceptRecord& percept, const FeltVibration& vibration) {
  if (percept.extractor != Extractor::acceleration)
    return not_measured(percept, "a vibration does not carry " + percept.name);
  if (!percept.alone)
    return not_measured(percept,
                        "the vibration has other sources too, so it does not give the level of " + percept.name);
  if (vibration.ticks == 0) return not_measured(percept, "the hand was never on the patch");
  return vibration.acceleration.p99;
}

/// What a hand must do to show the carrier of a percept, and what was measured of it.
struct Shown {
  std::optional<float> size;
  const char* needed = "";  ///< "the hand slid"
  const char* motion = "";  ///< the hand of `wale feel` that does it; empty if that depends on the material
};

Shown shown_of(const PerceptRecord& percept, const FeltResponse& response) {
  switch (percept.extractor) {
    case Extractor::opposing_force: return {response.drag, "slid over it", "lateral"};
    case Extractor::damping: return {response.viscosity, "moved through it", "lateral"};
    case Extractor::stiffness: return {response.stiffness, "moved to and fro in it", "lateral"};
    case Extractor::wall_stiffness: return {response.wall_stiffness, "pressed into its wall", ""};
    case Extractor::wall_damping: return {response.wall_damping, "pressed into its wall", ""};
    case Extractor::inertia: return {response.mass, "started and stopped with it", "lateral"};
    case Extractor::vibration: return {response.shaking, "stayed on the patch", "rest"};
    default: return {};
  }
}

/// The carrier's size from a run on a device that pushes, in the carrier's unit.
Result<float> size_from_run(const PerceptRecord& percept, const Felt& felt, long least_crossings) {
  const bool texture = percept.extractor == Extractor::lateral_force;
  const Shown shown = shown_of(percept, felt.response);
  if (!texture && *shown.needed == 0)
    return not_measured(percept, "no motion of a hand shows the carrier of " + percept.name);
  if (!percept.alone)
    return not_measured(percept, (percept.basis.summand
                                      ? "other forces push besides the " + percept.carrier
                                      : "the " + percept.carrier + " is changed on its way to the handle, or others push") +
                                     ", so the force at the handle does not give the level of " + percept.name);
  if (texture && felt.crossings < least_crossings)
    return not_measured(percept, "the hand crossed the texture " + std::to_string(felt.crossings) +
                                     " times, expected at least " + std::to_string(least_crossings));
  if (texture) return felt.force_rubbing.p99 * percept.basis.share;
  if (shown.size) return *shown.size;
  Error error = not_measured(
      percept, std::string("the hand hardly ") + shown.needed + ", so it did not show the " + percept.carrier);
  if (*shown.motion != 0) error.mend = std::string("the hand `") + shown.motion + "` does";
  return error;
}

}  // namespace

Felt measure(const Record& record, const MeasureOptions& options) {
  const auto settled = std::find_if(record.ticks.begin(), record.ticks.end(),
                                    [&](const TickRecord& tick) { return tick.time >= options.settling; });
  const std::span<const TickRecord> told(settled, record.ticks.end());
  std::vector<TickRecord> exerted;
  const bool follows = options.bandwidth == glm::dvec2(0) || options.vibrates;
  if (!follows) exerted = record.ticks, let_through(exerted, record.seconds_per_tick, options.bandwidth);
  const std::span<const TickRecord> all = follows ? told : std::span<const TickRecord>(exerted).last(told.size());
  const auto window = static_cast<std::ptrdiff_t>(std::round(options.stuck_seconds / record.seconds_per_tick));
  // Half a count more allows for positions rounded to float.
  const double distance = (options.stuck_counts + 0.5) * options.position_step;
  // The hand's way is one, but what it felt elsewhere does not count.
  std::vector<bool> stuck = find_stuck(all, window, distance);
  std::vector<TickRecord> marked, counted;  // all ticks, those elsewhere as outside; and those that count
  if (options.change) {
    marked.assign(all.begin(), all.end());
    std::vector<bool> of_counted;
    for (std::size_t i = 0; i < marked.size(); ++i) {
      marked[i].inside = marked[i].inside && marked[i].change == *options.change;
      if (!marked[i].inside) continue;
      counted.push_back(marked[i]);
      of_counted.push_back(stuck[i]);
    }
    stuck = std::move(of_counted);
  }
  const std::span<const TickRecord> ticks = options.change ? std::span<const TickRecord>(counted) : all;

  Felt felt;
  felt.ticks = static_cast<long>(ticks.size());
  if (options.vibrates) {
    felt.vibration = vibration_of(ticks);
    measure_movement(ticks, felt);
    return felt;
  }
  std::vector<float> force, force_rubbing, interaction, interaction_rubbing;
  long inside = 0, inside_stuck = 0;
  bool interaction_known = !ticks.empty();
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const float between = glm::length(ticks[i].interaction);
    interaction_known = interaction_known && !std::isnan(between);
    force.push_back(glm::length(ticks[i].force));
    interaction.push_back(between);
    inside += ticks[i].inside;
    inside_stuck += ticks[i].inside && stuck[i];
    if (!ticks[i].inside || stuck[i]) continue;
    force_rubbing.push_back(force.back());
    interaction_rubbing.push_back(between);
  }
  felt.ticks_rubbing = static_cast<long>(force_rubbing.size());
  felt.force = size_of(std::move(force));
  felt.force_rubbing = size_of(std::move(force_rubbing));
  if (interaction_known) {
    felt.interaction = size_of(std::move(interaction));
    felt.interaction_rubbing = size_of(std::move(interaction_rubbing));
  }
  if (inside > 0) felt.stuck = static_cast<double>(inside_stuck) / static_cast<double>(inside);

  const float amplitude = options.predicted_amplitude > 0 ? options.predicted_amplitude : felt.force.p99;
  felt.response = response_of(options.change ? std::span<const TickRecord>(marked) : all, record.seconds_per_tick);
  // A texture that the actuators hardly follow is crossed all the same.
  std::vector<TickRecord> wanted;
  if (!follows)
    std::ranges::copy_if(told, std::back_inserter(wanted), [&](const TickRecord& tick) {
      return !options.change || (tick.inside && tick.change == *options.change);
    });
  count_swings(follows ? ticks : std::span<const TickRecord>(wanted), amplitude, felt);
  measure_movement(ticks, felt);
  return felt;
}

std::vector<LevelBack> levels_back(const Bank& bank, const Felt& felt, long least_crossings) {
  std::vector<LevelBack> levels;
  const auto& percepts = bank.program().description().percepts;
  for (std::size_t i = 0; i < percepts.size(); ++i) {
    const float aimed = amplitude(bank, i);
    // What a device had no force left for is not hidden by the other forces: it is not there.
    const Result<float> size =
        felt.vibration ? size_from_vibration(percepts[i], *felt.vibration)
        : aimed == 0   ? not_measured(percepts[i], "nothing in the finished program carries " + percepts[i].name)
                       : size_from_run(percepts[i], felt, least_crossings);
    Result<Prediction> back = size ? Result<Prediction>(predict(bank, i, *size)) : size.error();
    levels.push_back({i, percepts[i].name, aimed, size ? *size : 0, std::move(back)});
  }
  return levels;
}

float predicted_amplitude(const Bank& bank) {
  const auto& percepts = bank.program().description().percepts;
  for (std::size_t i = 0; i < percepts.size(); ++i)
    if (percepts[i].extractor == Extractor::lateral_force || percepts[i].extractor == Extractor::acceleration)
      return amplitude(bank, i) / percepts[i].basis.share;
  return 0;
}

}  // namespace wale
