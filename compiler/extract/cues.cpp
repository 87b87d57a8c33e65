#include "compiler/extract/cues.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "compiler/extract/tolerances.hpp"
#include "compiler/measure/coarseness.hpp"

namespace wale {
namespace {

std::optional<double> unless_little(double value, double least) {
  return std::abs(value) < least ? std::nullopt : std::optional(value);
}

bool has_any(const Cues& cues, std::initializer_list<CueKind> kinds) {
  return std::ranges::any_of(kinds, [&](CueKind kind) { return cues[kind].has_value(); });
}

/// N: the force that none of the cues reads, on a hand at rest, or on a moving hand that is held back along one axis
/// and pushed along the other; the smaller of the two.
double unread_force(const Cues& cues, const Extraction& found) {
  using enum CueKind;
  const bool at_rest = has_any(cues, {amplitude, bump_amplitude, stiffness, wall_stiffness, friction});
  const bool moving = at_rest || has_any(cues, {viscosity, mass, vibration});
  const double still = at_rest ? 0 : found.force, under_way = moving ? 0 : found.opposing.scatter;
  return std::abs(still) < under_way ? under_way : still;
}

PeriodBand band_of(const Declarations& declarations, std::string_view percept) {
  const Percept* found = declarations.percepts.find(percept);
  return found ? PeriodBand{found->period.low, found->period.high} : PeriodBand{};
}

}  // namespace

const std::array<CueFacts, cue_count>& cue_table() {
  static constexpr std::array<CueFacts, cue_count> table{{
      {CueKind::amplitude, "amplitude", "N", "amplitude"},
      {CueKind::period, "period", "m", "period"},
      {CueKind::orientation, "orientation", "rad", "orientation"},
      {CueKind::regularity, "regularity", "", "periodicity"},
      {CueKind::bump_amplitude, "bump amplitude", "N", "amplitude"},
      {CueKind::bump_period, "bump period", "m", "period"},
      {CueKind::stiffness, "stiffness", "N/m", "stiffness"},
      {CueKind::wall_stiffness, "wall stiffness", "N/m", "wall_stiffness"},
      {CueKind::viscosity, "viscosity", "N s/m", "viscosity"},
      {CueKind::friction, "friction", "N", "friction"},
      {CueKind::mass, "mass", "kg", "mass"},
      {CueKind::vibration, "vibration", "N", "vibration"},
      {CueKind::vibration_frequency, "vibration frequency", "Hz", "vibration_frequency"},
      {CueKind::other_force, "other force", "N", "amplitude"},
  }};
  return table;
}

Extraction extract(const Bank& bank, const Declarations& declarations) {
  return extract(bank, band_of(declarations, "roughness"), band_of(declarations, "bumpiness"));
}

Cues cues_of(const Bank& bank, const Declarations& declarations) { return cues_of(bank, extract(bank, declarations)); }

Cues cues_of(const Bank& bank, const Extraction& found) {
  const PatchProgram& program = bank.program().description();
  Cues cues{program.material, program.device.name, {}, coarseness_of(program)};
  const TextureForce &texture = found.texture, &bumps = found.bumps;
  cues[CueKind::amplitude] =
      unless_little(texture.amplitude, std::max(least_force, least_of_texture * bumps.amplitude));
  if (cues[CueKind::amplitude]) {
    cues[CueKind::regularity] = texture.regularity;
    if (texture.regular()) cues[CueKind::period] = texture.period;
    if (texture.oriented()) cues[CueKind::orientation] = texture.orientation;
  }
  const double mostly = std::max(least_force, least_of_texture * texture.amplitude);
  if (!found.wall) cues[CueKind::bump_amplitude] = unless_little(bumps.amplitude, mostly);
  if (cues[CueKind::bump_amplitude] && bumps.regular()) cues[CueKind::bump_period] = bumps.period;
  cues[CueKind::stiffness] = unless_little(found.stiffness, least_stiffness);
  if (found.wall) cues[CueKind::wall_stiffness] = found.wall->stiffness;
  cues[CueKind::viscosity] = unless_little(found.opposing.damping, least_damping);
  cues[CueKind::friction] = unless_little(found.opposing.friction, least_force);
  cues[CueKind::mass] = unless_little(found.inertia, least_mass);
  cues[CueKind::vibration] = unless_little(found.vibration.amplitude, least_force);
  if (cues[CueKind::vibration]) cues[CueKind::vibration_frequency] = found.vibration.frequency;
  cues[CueKind::other_force] = unless_little(unread_force(cues, found), least_force);
  return cues;
}

}  // namespace wale
