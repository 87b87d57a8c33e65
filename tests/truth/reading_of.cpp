#include "tests/truth/reading_of.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/compare/compare.hpp"
#include "compiler/compile.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/read/cues.hpp"

namespace wale::truth {
namespace {

const Declarations& declarations() {
  static const auto common = common_modules();
  return common->declarations;
}

/// The cues of both vocabularies.
constexpr std::pair<Cue, CueKind> words[] = {
    {Cue::amplitude, CueKind::amplitude},
    {Cue::period, CueKind::period},
    {Cue::orientation, CueKind::orientation},
    {Cue::stiffness, CueKind::stiffness},
    {Cue::wall_stiffness, CueKind::wall_stiffness},
    {Cue::viscosity, CueKind::viscosity},
    {Cue::friction, CueKind::friction},
    {Cue::breakaway, CueKind::breakaway},
    {Cue::mass, CueKind::mass},
    {Cue::vibration, CueKind::vibration},
    {Cue::vibration_rate, CueKind::vibration_frequency},
    {Cue::sway, CueKind::sway},
    {Cue::sway_rate, CueKind::sway_frequency},
    {Cue::constant, CueKind::other_force},
    {Cue::stiffness_across, CueKind::stiffness_across},
    {Cue::viscosity_across, CueKind::viscosity_across},
    {Cue::friction_across, CueKind::friction_across},
    {Cue::mass_across, CueKind::mass_across},
    {Cue::wall_damping, CueKind::wall_damping},
    {Cue::other_vibration, CueKind::other_vibration},
    {Cue::other_vibration_rate, CueKind::other_vibration_rate},
    {Cue::other_sway, CueKind::other_sway},
    {Cue::other_sway_rate, CueKind::other_sway_rate},
    {Cue::uneven_mass, CueKind::uneven_mass},
};

}  // namespace

Reading reading_of(const Program& program) {
  const Bank bank(program);
  const ForceReading found = read(bank, declarations());
  const Cues cues = cues_of(bank, found);
  Reading reading;
  for (const auto& [cue, kind] : words) reading[cue] = cues[kind];
  if (cues[CueKind::push_x] || cues[CueKind::push_y])
    reading[Cue::constant] = std::hypot(cues[CueKind::push_x].value_or(0), cues[CueKind::push_y].value_or(0));
  for (const CueKind kind :
       {CueKind::stiffness_axis, CueKind::viscosity_axis, CueKind::friction_axis, CueKind::mass_axis})
    if (cues[kind]) reading[Cue::axis] = cues[kind];
  if (cues[CueKind::one_way_mass_x] || cues[CueKind::one_way_mass_y])
    reading[Cue::one_way_mass] =
        std::hypot(cues[CueKind::one_way_mass_x].value_or(0), cues[CueKind::one_way_mass_y].value_or(0));
  if (found.wall) {
    reading[Cue::face] = glm::dot(found.wall->place, found.wall->inward);
    reading[Cue::wall_jump] = found.wall->preload, reading[Cue::wall_push] = found.wall_push;
  }
  const auto tell_wall = [&](const WallFace& wall) {
    if (wall.radius > 0)
      reading.walls.push_back({wall.stiffness, wall.radius, 0, wall.fills ? -1 : 1, wall.centre.x, wall.centre.y});
    else
      reading.walls.push_back({.stiffness = wall.stiffness,
                               .face = glm::dot(wall.place, wall.inward),
                               .inward = std::atan2(wall.inward.y, wall.inward.x),
                               .power = wall.power});
  };
  if (found.wall) tell_wall(*found.wall);
  std::ranges::for_each(found.more_walls, tell_wall);
  for (const StaticStep& step : found.steps)
    reading.steps.push_back({step.offset, std::atan2(step.way.y, step.way.x), step.change.x, step.change.y});
  reading[Cue::roughness] = carrier_of(found, *declarations().percepts.find("roughness"), declarations());
  reading[Cue::bumpiness] = carrier_of(found, *declarations().percepts.find("bumpiness"), declarations());
  if (cues[CueKind::amplitude] && found.relief().regular())
    for (const ReliefWave& wave : found.relief().waves) reading.waves.push_back({wave.period, wave.orientation});
  return reading;
}

ShapeReading shape_of(const Program& program) {
  const ForceReading found = read(Bank(program), declarations());
  const auto carrier = [&](const char* percept) {
    return carrier_of(found, *declarations().percepts.find(percept), declarations());
  };
  return {found.relief().crest, found.relief().abruptness, found.relief().regularity,
          carrier("sharpness"), carrier("crispness"),      carrier("bumpiness")};
}

std::array<std::optional<double>, cue_count> differences_of(const Program& a, const Program& b) {
  const Cues first = cues_of(Bank(a), declarations()), second = cues_of(Bank(b), declarations());
  std::array<std::optional<double>, cue_count> differences;
  for (const CueDifference& each : Comparer(declarations(), first.device).compare(first, second).cues)
    for (const auto& [cue, kind] : words)
      if (kind == each.kind && each.noticeable) {
        auto& difference = differences[static_cast<std::size_t>(cue)];
        difference = std::max(difference.value_or(0), std::abs(*each.noticeable));
      }
  return differences;
}

bool told_apart(const Program& a, const Program& b) {
  const Cues first = cues_of(Bank(a), declarations()), second = cues_of(Bank(b), declarations());
  return Comparer(declarations(), first.device).compare(first, second).verdict == wale::Verdict::apart;
}

std::optional<double> difference_of(Cue cue, double a, double b) {
  const auto* word = std::ranges::find(words, cue, &std::pair<Cue, CueKind>::first);
  if (word == std::end(words)) return std::nullopt;
  Cues first{"a", default_device, {}}, second = first;
  first[word->second] = a, second[word->second] = b;
  for (const CueDifference& each : Comparer(declarations(), default_device).compare(first, second).cues)
    if (each.kind == word->second && each.noticeable) return std::abs(*each.noticeable);
  return std::nullopt;
}

bool says_outside(const Program& program) {
  const std::string text = description_text(describe(Bank(program), declarations()));
  return text.find("outside what was measured") != std::string::npos ||
         text.find("outside the range assumed for its map") != std::string::npos;
}

}  // namespace wale::truth
