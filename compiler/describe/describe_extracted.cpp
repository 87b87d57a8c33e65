#include "compiler/describe/describe_figure.hpp"
#include "compiler/describe/describe_extracted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>

#include "compiler/describe/describe_percept.hpp"
#include "compiler/read/cues.hpp"
#include "compiler/read/encoder_pattern.hpp"
#include "compiler/read/tolerances.hpp"
#include "compiler/solve/basis.hpp"
#include "compiler/solve/choose_map.hpp"
#include "compiler/solve/law.hpp"

namespace wale {
namespace {

DescribedPercept told_by(const Percept& percept, const Map& map, double size, const DeviceDeclaration& device,
                         const Bank& bank, const ForceReading& found, const Declarations& declarations) {
  const Law law(map, percept);
  DescribedPercept told{.amplitude = size,
                        .level = law.level_of(size),
                        .magnitude = law.magnitude_of(size),
                        .extracted = true,
                        .alone = false};
  const PerceptRecord record = record_by(map, percept, device, declarations);
  tell_evidence(told, record, bank, found, declarations);
  return told;
}

/// A size to two significant digits, so that a stimulus at the bound of a class falls into the class that its author
/// meant.
double as_well_as_read(double size) {
  const double digit = std::pow(10, std::floor(std::log10(size)) - 1);
  return std::round(size / digit) * digit;
}

/// The case of a rule for surfaces of this kind that holds; null if no rule classifies them, or no case holds.
struct ClassFound {
  const Rule* rule = nullptr;
  const Rule::Case* holds = nullptr;
};
ClassFound class_of(Classified classified, const Sizes& sizes, const std::string& kind,
                    const Declarations& declarations) {
  for (const Rule* rule : declarations.rules())
    if (rule->classified == classified)
      if (const Rule::Case* holds = rule->first(sizes, kind)) return {rule, holds};
  return {};
}

/// The kind of a relief in the words of the rules, which name the stimuli of experiments.
std::string kind_of_relief(const Relief& relief, const PatchSize& size, const Declarations& declarations) {
  if (!relief.regular() && !(relief.period > 0)) return {};
  Sizes sizes{{"period", relief.period},
              {"anisotropy", relief.anisotropy},
              // of the whole patch, and over one grain, in amplitudes
              {"ridges", (std::min(size.width, size.height) - 2 * size.rim) / relief.period},
              {"change", relief.steepness * relief.period}};
  const std::string kind = relief.regular() ? "regular" : relief.waves.empty() ? "irregular" : "mixed";
  const Rule::Case* holds = class_of(Classified::surface, sizes, kind, declarations).holds;
  return holds ? holds->label : kind;
}

/// The kind of surface in the words of the rules; each stimulus was one thing alone.
std::string kind_of(const Cues& cues, const ForceReading& found, double largest_newton, const PatchSize& size,
                    const Declarations& declarations) {
  if (cues[CueKind::amplitude]) return kind_of_relief(found.relief(), size, declarations);
  const auto things = std::ranges::count_if(cues.values, [](const auto& value) { return value.has_value(); });
  if (things == 0 && largest_newton < least_force) return "nothing";
  if (things != 1) return {};
  if (const auto& stiffness = cues[CueKind::stiffness]) return *stiffness > 0 ? "spring" : "bump";
  if (const auto& viscosity = cues[CueKind::viscosity]) return *viscosity > 0 ? "viscous" : "slick";
  return {};
}

/// What a relief counts as: the percept whose band holds most of it.
std::string counting_as(const Relief& relief, const Declarations& declarations) {
  if (!(relief.amplitude > 0)) return {};
  double most = 0;
  std::string found;
  declarations.percepts.each([&](const std::string& name, const Percept& percept) {
    if (percept.extractor != Extractor::lateral_force) return;
    const double size = relief.within({percept.period.low, percept.period.high});
    if (size > most) most = size, found = name;
  });
  return found;
}

/// The period of a relief; that of its strongest part if no part has it, as of 4 mm and 5 mm together.
double strongest_period(const Relief& relief) {
  constexpr double alike = 0.02, plainly = 1.1;
  const Relief::Part* strongest = nullptr;
  for (const Relief::Part& each : relief.parts) {
    if (std::abs(each.period - relief.period) <= alike * relief.period) return relief.period;
    // Of two that are as strong, the finer is what makes it a texture.
    const bool finer = strongest && each.period < strongest->period;
    if (!strongest || each.share > (finer ? 1 / plainly : plainly) * strongest->share) strongest = &each;
  }
  return strongest && relief.regular() ? strongest->period : relief.period;
}

/// `count` (m) is the step of the device's encoder.
DescribedTexture texture_of(const Cues& cues, const ForceReading& found, double largest_newton, const PatchSize& size,
                            double count, const Declarations& declarations) {
  DescribedTexture texture{.force = found.relief(), .kind = kind_of(cues, found, largest_newton, size, declarations)};
  if (!cues[CueKind::amplitude]) texture.force = {};
  texture.force.maximum = std::min(texture.force.maximum, largest_newton);
  texture.counts_as = counting_as(found.relief(), declarations);
  if (texture.force.regular() && !texture.force.waves.empty())
    texture.encoder_pattern = encoder_pattern(texture.force.waves.front(), count);
  // The rules name textures, and what they name has a period. People sorted ridges into classes, and were asked for
  // their confidence for the kinds that the rule names; of other surfaces the rules say nothing.
  const bool has_texture = texture.force.amplitude > 0 && texture.force.period > 0;
  Sizes sizes;
  texture.named_by = strongest_period(texture.force);
  if (has_texture) sizes = {{"amplitude", texture.force.amplitude}, {"period", as_well_as_read(texture.named_by)}};
  const auto found_class = [&](Classified classified) {
    return class_of(classified, sizes, texture.kind, declarations);
  };
  if (has_texture && texture.force.regular()) {
    if (const auto* named = found_class(Classified::texture).holds) texture.texture_class = named->label;
    if (const auto* sized = found_class(Classified::size).holds)
      texture.size_class = sized->label, texture.felt_as = sized->says;
  }
  if (const auto [rule, holds] = found_class(Classified::confidence); holds && !holds->kind.empty()) {
    texture.confidence = holds->label;
    texture.confidence_mean = holds->confidence, texture.confidence_spread = holds->spread;
    texture.source = rule->source;
  }
  return texture;
}

/// Where a spring pulls to, from what it pushes with in the middle; nothing if that is outside of the patch, or if the
/// push has another cause, as beside a spring along one axis only.
std::optional<glm::dvec2> rest_of(const ForceReading& found, const PatchSize& patch) {
  const glm::dvec2 axis = found.stiffness_axis == glm::dvec2(0) ? glm::dvec2(1, 0) : found.stiffness_axis;
  const glm::dvec2 across(-axis.y, axis.x);
  const auto along_one = [](double push, double stiffness) -> std::optional<double> {
    if (stiffness >= least_stiffness) return push / stiffness;
    return std::abs(push) < least_force ? std::optional(0.0) : std::nullopt;
  };
  // Where its force is cut in the middle, the law says where it pulls to, and not what is felt there.
  const auto one = along_one(glm::dot(found.asked_in_middle, axis), found.stiffness);
  const auto other = along_one(glm::dot(found.asked_in_middle, across), found.stiffness_across);
  if (!(found.stiffness >= least_stiffness) || !one || !other) return std::nullopt;
  const glm::dvec2 rest = axis * *one + across * *other;
  const bool inside = std::abs(rest.x) <= patch.width / 2 && std::abs(rest.y) <= patch.height / 2;
  return inside ? std::optional(without_rounding(rest)) : std::nullopt;
}

/// What of a reading no percept tells.
void tell_forces(Description& description, const ForceReading& found, const Cues& cues) {
  const Description::Directed all[] = {{"stiffness", "N/m", found.stiffnesses()},
                                       {"viscosity", "N s/m", found.opposing.dampings()},
                                       {"friction", "N", found.opposing.frictions()},
                                       {"mass", "kg", found.inertia}};
  constexpr double leasts[] = {least_stiffness, least_damping, least_force, least_mass};
  for (std::size_t i = 0; i < std::size(all); ++i) {
    // A percept tells what resists alike in all directions, but nothing that pushes on.
    if ((all[i].size.directed() || all[i].size.greatest < 0) && std::abs(all[i].size.greatest) >= leasts[i]) {
      description.directed.push_back(all[i]);
      double& across = description.directed.back().size.across;
      if (std::abs(across) < leasts[i]) across = 0;
    }
  }
  if (found.sway.amplitude >= least_force) description.sway = found.sway;
  if (found.vibration.noise && found.vibration.amplitude >= least_force) description.noise = found.vibration;
  if (found.vibration.amplitude >= least_force) description.vibration_course = found.vibration.course;
  if (found.vibration.amplitude >= least_force) description.vibration_parts = found.vibration.parts;
  description.mass = found.inertia;
  description.motion = found.opposing;
  description.held = held_figures(found);
  description.uneven = found.sway.least ? found.sway : found.vibration;
  description.spring_force = cues[CueKind::spring_force].value_or(0);
  if (description.spring_force > 0 && found.still.beyond_cut >= least_stiffness)
    description.spring_beyond = found.still.beyond_cut;
  description.small_feature = cues[CueKind::small_feature].value_or(0);
  if (glm::length(found.constant) >= least_force) {
    description.constant_push = without_rounding(found.constant);
    description.rest = rest_of(found, description.patch);
  }
  const auto counting = [](double force) { return force >= least_force ? force : 0; };
  description.other = {.button = counting(found.other.button),
                       .slowly = counting(found.other.slowly),
                       .remembered = counting(found.other.remembered),
                       .moving = counting(found.other.moving),
                       .later = counting(found.other.later)};
  description.coming = found.coming;
  description.swirl = cues[CueKind::swirl].value_or(0);
  description.travel = found.directions.travel;
  description.aside = counting(found.opposing.aside);
  const double unread = std::abs(cues[CueKind::other_force].value_or(0));
  // What is told already is not told again as a little more than it is.
  constexpr double plainly_more = 1.05;
  if (unread > plainly_more * std::max(description.other.largest(), description.aside)) description.unread = unread;
}

}  // namespace

void describe_extracted(Description& description, const Bank& bank, const ForceReading& found,
                        const Declarations& declarations) {
  const Cues cues = cues_of(bank, found);
  description.texture = texture_of(cues, found, description.force.max_newton, description.patch,
                                   description.device.position_step(), declarations);
  tell_forces(description, found, cues);
  if (found.wall) description.wall = {*found.wall, deepest(bank, *found.wall)};
  for (const WallFace& each : found.more_walls) description.more_walls.push_back({each, deepest(bank, each)});
  description.steps = found.steps;
  // A patch program may be built for a device that nothing here declares.
  DeviceDeclaration undeclared;
  undeclared.profile = description.device;
  const DeviceDeclaration* declared = declarations.devices.find(description.device.name);
  const DeviceDeclaration* const device = declared ? declared : &undeclared;
  declarations.percepts.each([&](const std::string& name, const Percept& percept) {
    if (std::ranges::find(description.percepts, name, &DescribedPercept::name) != description.percepts.end()) return;
    const auto size = carrier_of(found, percept, declarations);
    if (!size || !(*size > 0) || !percept.has_reference) return;
    if (const Map* map = choose_map(percept, *device, declarations).map)
      description.percepts.push_back(told_by(percept, *map, *size, *device, bank, found, declarations));
  });
  if (description.texture->force.amplitude > 0) description.no_texture.clear();
}

}  // namespace wale
