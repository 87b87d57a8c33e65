#include "compiler/evidence/domain.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

#include "compiler/read/tolerances.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

/// Two waves across each other, one with a tenth of the other's amplitude, have this anisotropy.
constexpr double along_lines = (1 - least_of_relief * least_of_relief) / (1 + least_of_relief * least_of_relief);

struct ProfileName {
  SurfaceProfile profile;
  const char* one;
  const char* many;
};
constexpr std::array<ProfileName, 4> profile_names = {{{SurfaceProfile::grating, "a grating", "gratings"},
                                                       {SurfaceProfile::noise, "an irregular relief", "noises"},
                                                       {SurfaceProfile::photograph, "a picture", "pictures"},
                                                       {SurfaceProfile::bump, "a bump", "bumps"}}};

/// Whether the force is sampled from a picture. A row of samples is a curve and no picture.
bool samples_a_picture(const PatchProgram& program) {
  const auto of_picture = [&](const Instruction& instruction) {
    if (instruction.operation != static_cast<std::uint8_t>(Operation::sample)) return false;
    const HeightTable& table = program.tables[instruction.c];
    return table.width > 1 && table.height > 1;
  };
  return std::ranges::any_of(program.tick, of_picture);
}

SurfaceProfile profile_of(const PatchProgram& program, const Relief& relief) {
  if (samples_a_picture(program)) return SurfaceProfile::photograph;
  if (relief.period == 0) return SurfaceProfile::bump;
  return relief.regular() ? SurfaceProfile::grating : SurfaceProfile::noise;
}

/// Whether a relief of lines pushes along them: the slope of a height pushes across its lines.
bool pushes_aside(const Relief& relief) {
  constexpr double aside = 0.25;  // rad: of an axis that is read a little awry the cosine is still 0.97
  if (!relief.push || !(relief.anisotropy >= along_lines)) return false;
  return std::abs(std::remainder(*relief.push - relief.orientation, std::numbers::pi)) > aside;
}

/// Whether a cue tells a drag that no one friction and viscosity tell.
bool of_drag(CueKind kind) {
  constexpr CueKind all[] = {CueKind::creeping_drag, CueKind::slow_drag, CueKind::drag,       CueKind::fast_drag,
                             CueKind::one_way_x,     CueKind::one_way_y, CueKind::uneven_drag};
  return std::ranges::find(all, kind) != std::end(all);
}

/// Whether a cue tells of another one how it differs, or what pressing the button adds.
bool of_another(CueKind kind) {
  constexpr CueKind all[] = {CueKind::uneven_vibration, CueKind::drag_lost_by_use, CueKind::held_slow_drag, CueKind::held_drag, CueKind::held_mass,
                             CueKind::held_vibration, CueKind::other_vibration, CueKind::other_sway,
                             CueKind::changing_vibration, CueKind::changing_sway, CueKind::one_way_mass_x,
                             CueKind::one_way_mass_y, CueKind::uneven_mass};
  return whole_of(kind) || std::ranges::find(all, kind) != std::end(all);
}

bool of_motion(Extractor extractor) {
  return extractor == Extractor::opposing_force || extractor == Extractor::damping;
}

/// What else there is beside a percept's carrier: the other cues that push, and other parts of its relief.
std::vector<std::string> beside(const PerceptRecord& record, double size, const Cues& cues, const Relief& relief) {
  std::vector<std::string> others;
  for (const CueFacts& facts : cue_table())
    if (facts.exerts && facts.extractor != record.extractor && cues[facts.kind] && !of_another(facts.kind)) {
      const bool push = facts.kind == CueKind::push_x || facts.kind == CueKind::push_y;
      // A friction or a viscosity that differs is itself.
      if (of_drag(facts.kind) && of_motion(record.extractor)) continue;
      const std::string name = push ? "a constant push" : of_drag(facts.kind) ? "a drag" : facts.name;
      if (std::ranges::find(others, name) == others.end()) others.push_back(name);
    }
  if (record.extractor != Extractor::lateral_force) {
    // A relief is called by what it is, and not by its size.
    for (std::string& other : others)
      if (other == cue_table()[static_cast<std::size_t>(CueKind::amplitude)].name) other = "a texture";
    return others;
  }
  const double elsewhere = std::sqrt(std::max(0.0, relief.amplitude * relief.amplitude - size * size));
  // A noise has parts of all periods.
  if (relief.regular() && elsewhere >= std::max(least_force, least_of_relief * relief.amplitude))
    others.emplace_back("a relief of other periods");
  if (relief.waves.size() > 1 && relief.anisotropy >= along_lines) others.emplace_back("another wave");
  return others;
}

}  // namespace

DomainJudgement judge_domain(const PerceptRecord& record, double size, const Bank& bank, const ForceReading& found) {
  const StimulusDomain& domain = record.basis.domain;
  DomainJudgement judgement;
  if (!domain.stated) return judgement;
  const PatchProgram& program = bank.program().description();
  const Relief& relief = found.relief();
  std::vector<std::string> why;
  if (domain.profiles != 0 && relief.amplitude > 0) {
    const SurfaceProfile profile = profile_of(program, relief);
    const auto* name = std::ranges::find(profile_names, profile, &ProfileName::profile);
    std::vector<std::string> measured;
    for (const ProfileName& each : profile_names)
      if ((domain.profiles & static_cast<std::uint8_t>(each.profile)) != 0) measured.emplace_back(each.many);
    if ((domain.profiles & static_cast<std::uint8_t>(profile)) == 0)
      why.push_back(fmt::format("{}, measured with {}", name->one, fmt::join(measured, " and ")));
    else if (profile == SurfaceProfile::grating && relief.crest > 0 && domain.crest_high > 0 &&
             (relief.crest < domain.crest_low * (1 - reading) || relief.crest > domain.crest_high * (1 + reading)))
      why.push_back(readable("a waveform with a crest of {:.2g}, {} {:.2g} to {:.2g}", relief.crest,
                             domain.crest_assumed ? "assumed to feel alike from" : "measured from", domain.crest_low,
                             domain.crest_high));
  }
  if (why.empty() && domain.profiles != 0 && pushes_aside(relief))
    why.emplace_back("a push across the direction in which it changes, measured with slopes of a height");
  // Of another kind of surface, that it is another kind is enough.
  if (why.empty() && domain.dimensions != 0 && relief.amplitude > 0) {
    const int dimensions = relief.anisotropy >= along_lines ? 1 : 2;
    if (dimensions != domain.dimensions)
      why.push_back(fmt::format("in {}, measured in {}", dimensions == 1 ? "one dimension" : "two dimensions",
                                domain.dimensions == 1 ? "one" : "two"));
  }
  if (domain.alone)
    if (const auto others = beside(record, size, cues_of(bank, found), relief); !others.empty())
      why.push_back(fmt::format("beside {}, measured alone", fmt::join(others, " and ")));
  judgement.inside = why.empty();
  judgement.why = fmt::format("{}", fmt::join(why, "; "));
  return judgement;
}

}  // namespace wale
