#include "compiler/read/cues.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "compiler/measure/coarseness.hpp"
#include "compiler/read/tolerances.hpp"
#include "schema/fnv1a.hpp"

namespace wale {
namespace {

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
constexpr double none_is_little = -1;                                  // 0 is a value
constexpr double slow_hand = 0.05, usual_hand = 0.2, fast_hand = 0.4;  // m/s

/// The principal value across the axis of the greatest, 0 if that is less than counts; not-a-number if it is alike in
/// all directions.
double across(const Principal& found, double least) {
  if (!found.directed() || std::abs(found.greatest) < least) return no_value;
  return std::abs(found.across) < least ? 0 : found.across;
}
/// The direction of the greatest principal value, rad in [0, pi).
double axis(const Principal& found, double least) {
  if (!found.directed() || std::abs(found.greatest) < least) return no_value;
  const double angle = std::atan2(found.axis.y, found.axis.x) + 2 * std::numbers::pi;
  const double turned = std::fmod(angle, std::numbers::pi);
  return std::numbers::pi - turned < 1e-3 ? 0 : turned;
}

/// rad in [0, 2 pi): towards which a straight wall stands; not-a-number of a round one.
double wall_direction(const ForceReading& found) {
  if (!found.wall || found.wall->radius > 0 || found.wall->inward == glm::dvec2(0)) return no_value;
  const double whole = 2 * std::numbers::pi, angle = std::atan2(found.wall->inward.y, found.wall->inward.x);
  const double turned = std::fmod(angle + whole, whole);
  return whole - turned < 1e-3 ? 0 : turned;
}

/// 1 or -1 if a skew is plain to be one, else 0.
double side_of(double skew) {
  constexpr double plainly_skew = 0.5;
  return std::abs(skew) < plainly_skew ? 0 : std::copysign(1.0, skew);
}

/// Of several waves that cross plainly, the one with the least or the greatest period; none of a relief that changes in
/// one direction.
template <typename Better>
ReliefWave crossing_wave(const Relief& relief, Better better) {
  constexpr double plainly = 0.1, alike = 0.02;
  ReliefWave best;
  std::size_t count = 0;
  for (const ReliefWave& each : relief.waves) {
    if (each.share < plainly) continue;
    const bool first = ++count == 1;
    // Of waves of one period, the one nearest to x is told.
    const bool same = std::abs(each.period - best.period) <= alike * best.period;
    if (first || (same ? each.orientation < best.orientation : better(each.period, best.period))) best = each;
  }
  return count > 1 && !relief.oriented() ? best : ReliefWave{};
}
ReliefWave finest_of(const Relief& relief) { return crossing_wave(relief, std::less()); }
ReliefWave coarsest_of(const Relief& relief) { return crossing_wave(relief, std::greater()); }

/// m: the periods of a sum of waves along one direction by which it is felt, of those that are plainly there. A single
/// one is told if the sum has another period, that after which all its waves repeat.
struct SummedPeriods {
  double finest = 0, coarsest = 0;  ///< 0 of what is no such sum
};
SummedPeriods summed_periods(const Relief& relief) {
  constexpr double plainly = 0.1, alike = 0.02, one_way = 0.02;
  if (!relief.regular() || !relief.oriented()) return {};
  SummedPeriods found;
  std::size_t along = 0;
  for (const ReliefWave& each : relief.waves) {
    const double turned = std::remainder(each.orientation - relief.waves.front().orientation, std::numbers::pi);
    if (std::abs(turned) > one_way) continue;
    ++along;
    if (each.share < plainly) continue;
    found.finest = found.finest > 0 ? std::min(found.finest, each.period) : each.period;
    found.coarsest = std::max(found.coarsest, each.period);
  }
  const bool told_by_period =
      found.finest == found.coarsest && std::abs(found.finest - relief.period) <= alike * relief.period;
  return along < 2 || told_by_period ? SummedPeriods{} : found;
}
double finest_period(const Relief& relief) {
  return relief.oriented() ? summed_periods(relief).finest : finest_of(relief).period;
}
double coarsest_period(const Relief& relief) {
  return relief.oriented() ? summed_periods(relief).coarsest : coarsest_of(relief).period;
}
/// 0 .. 1: of the mean square of such a sum, whether its waves repeat together or not.
double in_waves(const Relief& relief) {
  return summed_periods(relief).finest > 0 ? relief.in_waves() : no_value;
}

/// N: the force that none of the other cues reads, the largest of some; negative if it mostly pushes a resting hand
/// away from the middle.
double unread_force(const ForceReading& found) {
  const bool pushed = found.relief().amplitude >= least_force || std::abs(found.stiffness) >= least_stiffness ||
                      found.wall || !found.steps.empty() || std::abs(found.opposing.friction) >= least_force ||
                      glm::length(found.constant) >= least_force;
  const bool resisted = pushed || std::abs(found.opposing.damping) >= least_damping || !found.opposing.explained ||
                        std::abs(found.inertia.greatest) >= least_mass || !found.inertia.is_one() || found.vibration.amplitude >= least_force ||
                        found.sway.amplitude >= least_force;
  const double noise = found.vibration.noise ? found.vibration.amplitude : 0;
  const double alone = std::max(0.0, found.still.largest - std::max(found.at_first, noise));
  const double still = pushed ? 0 : found.still.pushes_away ? -alone : alone;
  const double moving = resisted ? 0 : found.opposing.scatter;
  const double other = std::max({moving, found.opposing.aside, found.other.largest()});
  return std::abs(still) < other ? other : still;
}

/// Empty if the value of this cue is less than counts.
std::optional<double> counting(double value, double least) {
  if (std::isnan(value) || std::abs(value) < least || (least == 0 && value == 0)) return std::nullopt;
  return value;
}

std::optional<double> cue_of(CueKind kind, const ForceReading& found) {
  switch (kind) {
#define CUE(kind, name, unit, extractor, threshold, exerts, least, value) \
  case CueKind::kind:                                                     \
    return counting(value, least);
#include "compiler/read/cue.def"
#undef CUE
  }
  return std::nullopt;
}

}  // namespace

PeriodBand band_of(const Percept& percept, const Declarations& declarations) {
  constexpr double border = 1 + reading_of_period;
  PeriodBand band{percept.period.low / border, percept.period.high * border};
  declarations.percepts.each([&](const std::string&, const Percept& other) {
    if (other.extractor == percept.extractor && other.period.high == percept.period.low)
      band.low = percept.period.low * border;
  });
  return band;
}

const std::array<CueFacts, cue_count>& cue_table() {
  static constexpr std::array<CueFacts, cue_count> table{{
#define CUE(kind, name, unit, extractor, threshold, exerts, least, value) \
  {CueKind::kind, name, unit, Extractor::extractor, threshold, exerts},
#include "compiler/read/cue.def"
#undef CUE
  }};
  return table;
}

std::optional<double> carrier_of(const ForceReading& found, const Percept& percept, const Declarations& declarations) {
  switch (percept.extractor) {
    case Extractor::lateral_force: {
      const double size = found.relief().within(band_of(percept, declarations));
      const bool counts = size >= std::max(least_force, least_of_relief * found.relief().amplitude);
      return counts ? std::optional(size) : std::nullopt;
    }
    case Extractor::steepness:
      return found.relief().amplitude >= least_force ? std::optional(found.relief().steepness) : std::nullopt;
    default: break;
  }
  for (const CueFacts& facts : cue_table())
    if (facts.extractor == percept.extractor && facts.extractor != Extractor::none) return cue_of(facts.kind, found);
  return std::nullopt;
}

namespace {

/// A hash of what a bank executes on a hand: without names, levels and pictures.
std::uint64_t executed_by(const Bank& bank) {
  const PatchProgram& whole = bank.program().description();
  PatchProgram program;
  program.constants = whole.constants, program.setup_registers = whole.setup_registers;
  program.temporaries = whole.temporaries;
  program.setup = whole.setup, program.peaks = whole.peaks, program.states = whole.states, program.enter = whole.enter;
  program.grids = whole.grids, program.tick = whole.tick, program.outputs = whole.outputs;
  program.writes = whole.writes, program.tables = whole.tables, program.device = whole.device;
  for (State& each : program.states) each.name.clear();
  for (Grid& each : program.grids) each.name.clear();
  Fnv1a<std::uint64_t> hash;
  const std::vector<std::byte> bytes = write_patch_program(program);
  hash.take_all(bytes);
  hash.take_all(std::as_bytes(bank.registers()));
  const PatchSize size = bank.size();
  return hash.take_all(std::as_bytes(std::span(&size, 1))).hash();
}

}  // namespace

Cues cues_of(const Bank& bank, const ForceReading& reading) {
  const PatchProgram& program = bank.program().description();
  Cues cues{program.material, program.device.name, {}, coarseness_of(program), 0};
  for (const CueFacts& facts : cue_table()) cues[facts.kind] = cue_of(facts.kind, reading);
  if (cues[CueKind::other_force]) cues.executed = executed_by(bank);
  if (cues[CueKind::amplitude]) return cues;
  for (const CueFacts& facts : cue_table())
    if (whole_of(facts.kind) == CueKind::amplitude) cues[facts.kind] = std::nullopt;
  return cues;
}

std::optional<CueKind> whole_of(CueKind kind) {
  switch (kind) {
    case CueKind::period:
    case CueKind::grain:
    case CueKind::orientation:
    case CueKind::push_axis:
    case CueKind::regularity:
    case CueKind::crest:
    case CueKind::abruptness:
    case CueKind::stronger_x:
    case CueKind::stronger_y:
    case CueKind::steep_side:
    case CueKind::steep_side_across:
    case CueKind::finest_wave:
    case CueKind::finest_axis:
    case CueKind::coarsest_wave:
    case CueKind::coarsest_axis:
    case CueKind::in_waves:
    case CueKind::other_waves: return CueKind::amplitude;
    case CueKind::wall_direction:
    case CueKind::wall_push:
    case CueKind::wall_preload: return CueKind::wall_stiffness;
    case CueKind::spring_force:
    case CueKind::stiffness_across:
    case CueKind::stiffness_axis: return CueKind::stiffness;
    case CueKind::viscosity_limit:
    case CueKind::viscosity_across:
    case CueKind::viscosity_axis: return CueKind::viscosity;
    case CueKind::friction_rise:
    case CueKind::friction_across:
    case CueKind::friction_axis: return CueKind::friction;
    case CueKind::mass_across:
    case CueKind::mass_axis: return CueKind::mass;
    case CueKind::vibration_frequency:
    case CueKind::vibration_half:
    case CueKind::vibration_axis: return CueKind::vibration;
    case CueKind::other_vibration_rate: return CueKind::other_vibration;
    case CueKind::other_sway_rate: return CueKind::other_sway;
    case CueKind::steps_x:
    case CueKind::steps_y:
    case CueKind::step_push_x:
    case CueKind::step_push_y:
    case CueKind::step_axis: return CueKind::steps;
    case CueKind::drag_across:
    case CueKind::drag_axis: return CueKind::drag;
    case CueKind::noise_rate:
    case CueKind::noise_axis: return CueKind::noise_in_time;
    case CueKind::later_rate:
    case CueKind::later_x:
    case CueKind::later_y: return CueKind::later_force;
    case CueKind::sway_frequency:
    case CueKind::sway_half:
    case CueKind::sway_axis: return CueKind::sway;
    case CueKind::outward_push: return CueKind::amplitude;
    case CueKind::other_push_x:
    case CueKind::other_push_y: return CueKind::other_force;
    default: return std::nullopt;
  }
}

std::string condition_name(const CueFacts& facts) {
  if (facts.kind == CueKind::vibration_frequency) return "rate";
  std::string name = facts.name;
  std::ranges::replace(name, ' ', '_');
  return name;
}

Sizes sizes_of(const Cues& cues, const std::optional<double>& speed) {
  Sizes sizes;
  for (const CueFacts& facts : cue_table())
    if (cues[facts.kind]) sizes[condition_name(facts)] = *cues[facts.kind];
  if (speed) sizes["speed"] = *speed;
  return sizes;
}

std::optional<double> speed_of_strokes(const Declarations& declarations) {
  const HandDeclaration* hand = declarations.hands.find("normal");
  if (!hand || !(hand->lateral_frequency > 0)) return std::nullopt;
  // A stroke goes from one end to the other and back: four amplitudes.
  return 4 * hand->lateral_amplitude * hand->lateral_frequency;
}

Cues cues_of(const Bank& bank, const Declarations& declarations) { return cues_of(bank, read(bank, declarations)); }

}  // namespace wale
