#include "library/review/facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "compiler/describe/describe.hpp"
#include "compiler/diagnostics/advice.hpp"
#include "compiler/grade/grade.hpp"
#include "compiler/grade/required_damping.hpp"
#include "compiler/preview/preview.hpp"
#include "compiler/text/readable.hpp"
#include "library/index/entry.hpp"
#include "library/licence/passing_on.hpp"
#include "library/review/report.hpp"

namespace wale {
namespace {

const Diagnostic* first_error(const Diagnostics& diagnostics) {
  const auto found = std::ranges::find(diagnostics.all(), Severity::error,
                                       [](const Diagnostic& each) { return severity_of(each.code); });
  return found == diagnostics.all().end() ? nullptr : &*found;
}

/// What the compiler only warns of, and what a library does not take in.
void tell_of_reading(const CheckedMaterial& checked, const Diagnostics& of_material, Diagnostics& diagnostics) {
  for (const Diagnostic& each : of_material.all()) {
    if (each.code == Code::delivered_otherwise || each.code == Code::saturates)
      report(diagnostics, Code::reads_otherwise, each.span,
             fmt::format("`{}` does not feel as it asks: {}", checked.name, each.message),
             each.help.empty() ? "change the level, or what stands in its way" : each.help);
    if (each.code == Code::never_pushes)
      report(diagnostics, Code::blank_material, checked.span, fmt::format("`{}` never pushes", checked.name),
             "give it a force, or leave it out");
  }
}

/// Compiles a material for the other classes. A percept that its author calls essential keeps it from devices that lack
/// it, as was meant.
void build_for_others(const OpenedFile& opened, const FactsRequest& request, const CheckedMaterial& checked,
                      Diagnostics& diagnostics) {
  if (std::ranges::any_of(checked.percepts, &AskedPercept::essential)) return;
  for (const std::string& device : request.others) {
    FileRequest other = request.file;
    other.device = device;
    Diagnostics there;
    if (compile_opened(opened, other, checked.name, there)) continue;
    const Diagnostic* why = first_error(there);
    report(diagnostics, Code::not_for_class, checked.span,
           fmt::format("`{}` cannot be built for `{}`{}", checked.name, device,
                       why ? fmt::format(": {} {}", code_name(why->code), why->message) : ""),
           why && !why->help.empty() ? why->help
                                     : fmt::format("`wale describe FILE --device {}` shows the whole message", device));
  }
}

std::string millimetres(const WorstPlace& worst) {
  return readable("({:.1f}, {:.1f}) mm", 1e3 * worst.position.x, 1e3 * worst.position.y);
}

/// A force that shakes the handle: a force that is held needs no more damping than device and hand have, whatever else
/// it does. That a program gives energy by itself too is another matter, and takes nothing of this away.
void tell_of_shaking(const Grade& graded, const PatchProgram& program, const CheckedMaterial& checked, Diagnostics& diagnostics) {
  const double held = graded.device_damping + graded.hand_damping;
  if (graded.standing == Standing::not_analysed || graded.device_damping <= 0 || graded.required_damping <= held) return;
  // Across a jump the sampled loop sees the slope between two counts.
  const LoopTiming timing(program.device);
  const double across = graded.step_newton / program.device.position_step() * (timing.period / 2 + timing.latest());
  constexpr double nearly_all = 0.99;
  const bool by_jump = graded.jumps && across >= nearly_all * graded.required_damping;
  report(diagnostics, Code::unstable_material, checked.span,
         readable("device and hand do not hold the force of `{}`: it needs a damping of {:.3g} N s/m at {}, and they have "
                  "{:.3g}{}",
                  checked.name, graded.required_damping, millimetres(graded.worst), held,
                  by_jump ? readable("; the force jumps by {:.2g} N from one encoder count to the next",
                                     graded.step_newton)
                          : ""),
         by_jump ? "let it rise over a distance, as `smoothstep(x / 1 mm)` does, or make it weaker"
                      : "make it less stiff, or its finest detail coarser; `wale describe FILE` says more");
}

/// Energy that the author did not declare. The compiler warns of it too, but not where it doubts a value: there the
/// doubt comes first for an author, and a library must know both.
void tell_of_energy(const Grade& graded, const PatchProgram& program, const CheckedMaterial& checked,
                    const Diagnostics& of_material, Diagnostics& diagnostics) {
  if (!graded.energy.active() || graded.energy.watt() <= program.active_watt) return;
  const auto told = [](const Diagnostic& each) { return each.code == Code::undeclared_energy; };
  if (std::ranges::any_of(of_material.all(), told)) return;
  report(diagnostics, Code::undeclared_energy, checked.span,
         readable("`{}` gives energy to the hand, up to {:.2g} W at an ordinary pace: {}", checked.name,
                  graded.energy.watt(), graded.energy.reasons.front()),
         "mend what the other warnings say of it; if it is meant, declare it with `active` in its physical block");
}

/// Grades it and draws it. Error: `missing_library`.
Result<> grade_and_draw(MaterialFacts& facts, const Bank& bank, const CheckedMaterial& checked,
                        const Declarations& declarations, const Diagnostics& of_material,
                        Diagnostics& diagnostics) {
  if (!bank.program().description().vibrates()) {
    const Grade graded = grade(bank, normal_hand(declarations));
    const Standing standing = graded.assumed_standing().value_or(graded.standing);
    facts.standing = standing_word(standing);
    if (standing != graded.standing) facts.standing += " by an assumed damping";
    facts.damping = graded.required_damping, facts.newton = graded.largest_newton;
    if (graded.energy.active()) facts.given = graded.energy.watt();
    tell_of_shaking(graded, bank.program().description(), checked, diagnostics);
    tell_of_energy(graded, bank.program().description(), checked, of_material, diagnostics);
  }
  PreviewChoice choice;
  choice.small = true;
  const auto drawn = draw_preview(bank, preview_text(bank, declarations), declarations, choice);
  return drawn ? Result<>() : Result<>(drawn.error());
}

void add_levels(MaterialFacts& facts, const CheckedMaterial& checked) {
  for (const AskedPercept& asked : checked.percepts)
    facts.levels.push_back({asked.name, asked.level, asked.evidence ? evidence_word(*asked.evidence) : "", {}});
}

/// Reads one material.
Result<> read_material(MaterialFacts& facts, FactsReading& reading, const FactsRequest& request,
                       const FileRequest& watched, const CheckedMaterial& checked) {
  Diagnostics of_material, found;
  const auto program = compile_opened(reading.opened, watched, checked.name, of_material);
  Diagnostics& all = reading.opened.diagnostics;
  Result<> drawn;
  facts.compiled = program.has_value();
  if (program) {
    const Declarations& declarations = reading.opened.module->declarations();
    const Bank bank(*program);
    if (request.cues_alone) {
      if (!program->description().vibrates()) facts.cues = cues_of(bank, declarations);
    } else {
      EntryFeel felt = felt_of(*program, declarations);
      facts.cues = std::move(felt.cues);
      for (ReviewedLevel& level : facts.levels)
        if (const EntryPercept* percept = felt.percept(level.percept)) level.reads = percept->reads;
      drawn = grade_and_draw(facts, bank, checked, declarations, of_material, found);
      build_for_others(reading.opened, request, checked, found);
      tell_of_reading(checked, of_material, found);
    }
  }
  for (const Diagnostics* each : {&of_material, &found})
    for (const Diagnostic& one : each->all()) all.report(one);
  return drawn;
}

}  // namespace

Result<FactsReading> read_facts(const FactsRequest& request) {
  FactsReading reading;
  FileRequest watched = request.file;
  watched.looked_for = &reading.facts.looked_for;
  auto opened = open_file(watched);
  if (!opened) return opened.error();
  reading.opened = *std::move(opened);
  if (!reading.opened.module)
    return Error{.code = Code::damaged_file,
                 .sentence = "a patch program is no text of a library",
                 .mend = "name the Wale file that it was built from",
                 .place = {.name = request.file.file}};
  for (const auto& each : reading.opened.module->modules.modules)
    reading.facts.uses_names |= !each->declarations.library_materials.empty();
  const bool broken = reading.opened.diagnostics.has_errors();  // the file itself
  for (const CheckedMaterial& checked : reading.opened.module->materials) {
    if (!request.material.empty() && checked.name != request.material) continue;
    MaterialFacts& facts = reading.facts.materials.emplace_back();
    facts.name = checked.name;
    add_levels(facts, checked);
    if (broken) continue;
    if (const auto read = read_material(facts, reading, request, watched, checked); !read) return read.error();
  }
  auto& paths = reading.facts.looked_for;
  // The licences of what it rests on may change.
  for (std::string& path : projects_under(reading.opened)) paths.push_back(std::move(path));
  std::ranges::sort(paths);
  paths.erase(std::unique(paths.begin(), paths.end()), paths.end());
  return reading;
}

std::vector<std::string> devices_of_other_classes(const Declarations& declarations, const std::string& device) {
  const DeviceDeclaration* own = declarations.devices.find(device);
  std::set<std::string> classes;
  if (own) classes.insert(own->of_class);
  std::vector<std::string> devices;
  declarations.devices.each([&](const std::string& name, const DeviceDeclaration& each) {
    if (!each.of_class.empty() && classes.insert(each.of_class).second) devices.push_back(name);
  });
  return devices;
}

}  // namespace wale
