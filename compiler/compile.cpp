#include "compiler/compile_to_read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/check/follow_on.hpp"
#include "compiler/emit/emit.hpp"
#include "compiler/emit/lower.hpp"
#include "compiler/evidence/confirm.hpp"
#include "compiler/evidence/percept_reading.hpp"
#include "compiler/expression/check_expression.hpp"
#include "compiler/grade/grade.hpp"
#include "compiler/grade/own_rate.hpp"
#include "compiler/grade/sought_force.hpp"
#include "compiler/measure/cut_force.hpp"
#include "compiler/measure/hands.hpp"
#include "compiler/measure/measure.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/parse/parse.hpp"
#include "compiler/prove/force_bound.hpp"
#include "compiler/prove/reachable.hpp"
#include "compiler/report_heights.hpp"
#include "compiler/solve/formula_mistakes.hpp"
#include "compiler/solve/plausible.hpp"
#include "compiler/solve/solve.hpp"
#include "compiler/text/readable.hpp"
#include "compiler/text/sampled_rate.hpp"
#include "compiler/warn_of_energy.hpp"
#include "schema/spelling.hpp"
#include "schema/without_place.hpp"

namespace wale {

namespace {

/// Warns of a material that declares more active power than the device allows, so that it feels weaker.
void warn_of_a_device_that_gives_less(const SolvedMaterial& material, Diagnostics& diagnostics) {
  const DeviceProfile& device = material.device;
  if (device.active_watt == 0 || material.active_watt <= device.active_watt) return;
  diagnostics.report({.code = Code::more_than_device_gives,
                      .span = material.force_span,
                      .message = readable("`{}` declares {:.2g} W, but `{}` gives a program at most {:.2g} W",
                                          material.name, material.active_watt, device.name, device.active_watt),
                      .help = "the runtime holds back the rest; declare less, or choose another device"});
}

/// The loaded program of a solved material; empty after errors.
std::optional<Program> program_of(const SolvedMaterial& solved, const CheckedMaterial& material,
                                  const CheckedModule& module, const SourceSet& sources, Diagnostics& diagnostics) {
  if (diagnostics.has_errors()) return std::nullopt;
  const SourceLines lines(sources, module.modules);
  const LoweredMaterial lowered = lower(solved, diagnostics);
  if (lowered.flat && !diagnostics.has_errors()) report_flat_height(solved, material, nullptr, diagnostics);
  if (diagnostics.has_errors()) return std::nullopt;
  auto program = emit(lowered, solved, diagnostics, &lines);
  if (!program) return std::nullopt;
  auto loaded = Program::load(std::move(*program));
  if (loaded) return *std::move(loaded);
  diagnostics.report(
      {.code = Code::program_too_large,
       .span = solved.span,
       .message = fmt::format("the machine refuses `{}`: {}", solved.name, in_words_without_place(loaded.error())),
       .help = "if the material is large, make it smaller; if it is not, this is an error in the compiler"});
  return std::nullopt;
}

/// A material and its program, which is empty after errors, and what is read of it, as far as its percepts need it.
struct FinishedMaterial {
  SolvedMaterial solved;
  std::optional<Program> program;
  ForceReading found;
  ReadFirst first;  ///< what that reading has measured
};

FinishedMaterial finish(const CheckedMaterial& material, const CheckedModule& module, const std::string& device,
                        const SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics,
                        KeptReadings* kept = nullptr) {
  Diagnostics first = diagnostics;  // replaced if the material is solved again
  FinishedMaterial finished;
  const auto make = [&](Diagnostics& into, const BandShares& shares) {
    finished.solved = solve(material, module, device, sources, resolver, into, shares);
    finished.program = program_of(finished.solved, material, module, sources, into);
    finished.first = {};
    finished.first.kept = kept;
  };
  make(first, {});
  BandShares shares;
  // What moving hands feel of a program that is made again need not be measured.
  if (finished.program)
    shares = band_shares(Bank(*finished.program), finished.first, finished.solved, module.declarations());
  if (shares.empty())
    diagnostics = std::move(first);
  else
    make(diagnostics, shares);
  const bool asks = std::ranges::any_of(finished.solved.percepts,
                                        [](const SolvedPercept& each) { return each.asked.has_value(); });
  if (finished.program && asks)
    finished.found = read_again(Bank(*finished.program), module.declarations(),
                                parts_for(finished.program->description()), finished.first);
  return finished;
}

/// The program with the fate of the force that its author wrote; the same program if it has none, or it is kept.
Result<Program> with_fate_of_force(const Program& program, const Bank& bank, const GradingHand& hand) {
  const auto& fates = program.description().fates;
  const auto force = std::ranges::find_if(fates, is_of_force);
  if (force == fates.end()) return program;
  FateRecord found = fate_of_force(*force, bank, static_cast<float>(hand.speed()));
  if (found == *force) return program;
  PatchProgram changed = program.description();
  changed.fates[static_cast<std::size_t>(force - fates.begin())] = std::move(found);
  return Program::load(std::move(changed));
}

/// The force of a program for all its parameters, at rest or moving, inside its patch's rim: what is proved and found.
ForceBound bound_inside(const Bank& bank) {
  const PatchSize size = bank.size();
  const auto either_way = [](float most) { return Interval::between(-most, most); };
  Domain domain = reachable_domain(bank.program());
  domain[Input::x] = either_way(size.width / 2 - size.rim);
  domain[Input::y] = either_way(size.height / 2 - size.rim);
  domain[Input::patch_half_width] = Interval::of(size.width / 2);
  domain[Input::patch_half_height] = Interval::of(size.height / 2);
  domain[Input::patch_rim] = Interval::of(size.rim);
  return force_bound(bank.program(), domain);
}

/// "0.0031 N at most", "less than 0.0001 N": a force (N) that is too small to be felt.
std::string at_most(double newton) {
  constexpr double told = 1e-4;
  return newton < told ? readable("less than {:.4f} N", told) : readable("{:.2g} N at most", newton);
}

/// Warns of a material whose force is nothing that the device can command, for every hand and all parameters, or for
/// every hand inside the patch's rim, unless it says so itself.
void warn_of_no_force(const Bank& bank, const CheckedMaterial& material, const SolvedMaterial& solved,
                      const Measured& measured, Diagnostics& diagnostics) {
  const auto is_zero = [&](TermId id) { return solved.terms[id].known(); };
  const bool says_so = is_zero(solved.force[0]) && is_zero(solved.force[1]);
  const auto& asked = material.percepts;
  const bool asks_for_none = std::ranges::any_of(asked, [](const AskedPercept& each) { return each.level == 0; });
  // A percept that was asked for, and of which cancelling forces leave nothing, has a warning of its own (W0425).
  const double least = asked.empty() ? 0.5 * solved.device.force_step() : std::numeric_limits<double>::min();
  if (measured.less_rim >= least || says_so || asks_for_none || depends_on_the_moment(bank.program().description()) ||
      !solved.states.empty() || !solved.memories.empty())
    return;
  const double sought = sought_force(bank, least);
  if (sought >= least) return;
  const ForceBound bound = bound_inside(bank);
  if (bound.found.newton >= least) return;
  const bool proved = bound.newton < least;
  const double newton = std::max({static_cast<double>(measured.less_rim), sought, bound.found.newton});
  const std::string where = fmt::format("{:.0f} mm by {:.0f} mm", 1e3 * solved.patch_width, 1e3 * solved.patch_height);
  const std::string needed =
      fmt::format("`{}` gives no less than {:.2g} N", solved.device.name, solved.device.force_step());
  const auto is_wall = [](const SolvedPercept& each) { return each.record.extractor == Extractor::wall_stiffness; };
  const bool walled = std::ranges::any_of(solved.percepts, is_wall) &&
                      std::ranges::none_of(material.carriers, [&](const Carrier& each) {
                        return constant_value(material.terms, each.size, &material.parameters) == 0.0;
                      });
  std::string message;
  std::string help =
      walled ? "its wall stands outside of the patch, or in its rim: move the face inside, as `firm(face: 5 mm)` does, "
               "or take a larger patch"
             : "look for a place outside of the patch, for a length in m instead of mm, or for a size of 0";
  if (measured.max_newton >= least) {
    message =
        fmt::format("`{}` pushes only in the rim of its patch, with up to {:.3g} N, where heights fade; inside, {}",
                    solved.name, measured.max_newton, proved ? "its force is 0" : "no force was found");
    if (!walled) help = "look for heights that add up to the same height everywhere, or for a place outside the patch";
  } else if (bound.newton == 0) {
    message = fmt::format("`{}` never pushes: its force is 0 at every place of its patch, {}, and at every velocity",
                          solved.name, where);
  } else if (proved) {
    message = fmt::format("`{}` never pushes: its force is {} on its patch, {}, and {}", solved.name,
                          at_most(bound.newton), where, needed);
    help = "look for forces that cancel, or for a size near 0";
  } else {
    message = fmt::format("`{}` seems never to push: any force found on its patch, {}, is {}, and {}", solved.name,
                          where, at_most(newton), needed);
    help = "look for forces that cancel, or for a feature far smaller than an encoder count";
  }
  diagnostics.report({.code = Code::never_pushes, .span = solved.force_span, .message = message, .help = help});
}

/// Warns of rates that the loop cannot follow, at the parameters' defaults and at the ends of their ranges.
void warn_of_fast_rates(const Bank& bank, const SolvedMaterial& solved, Diagnostics& diagnostics) {
  const PatchProgram& program = bank.program().description();
  const double loop = program.device.rate, most = fastest_as_written(loop);
  const auto report = [&](const std::string& which, double rate) {
    diagnostics.report({.code = Code::too_fast_for_loop,
                        .span = solved.force_span,
                        .message = fmt::format("{} of {:.4g} Hz comes out as {}: `{}` computes {:.4g} forces a second",
                                               which, rate, what_comes_out(rate, loop), program.device.name, loop),
                        .help = fmt::format("choose a rate of {:.4g} Hz or less", most)});
  };
  if (const double rate = fastest_own_rate(bank); rate > most) return report("a rate", rate);
  if (program.states.empty() && !depends_on_the_moment(program)) return;
  std::vector<float> values;
  for (const Parameter& parameter : program.parameters) values.push_back(parameter.value);
  for (std::size_t i = 0; i < program.parameters.size(); ++i)
    for (const float end : {program.parameters[i].low, program.parameters[i].high}) {
      std::vector<float> set = values;
      set[i] = end;
      const double rate = fastest_own_rate(Bank(bank.program(), set, bank.size()));
      if (rate > most)
        return report(fmt::format("with `{}` at the end of its range, a rate", program.parameters[i].name), rate);
    }
}

/// "roughness 0.6 is asked for, and the finished program reads 0.35": of each percept that a factor changes.
std::string asked_and_read(const FinishedMaterial& finished, const Declarations& declarations) {
  std::string text;
  if (!finished.program) return text;
  const Bank bank(*finished.program);
  for (std::size_t i = 0; i < finished.solved.percepts.size(); ++i) {
    const SolvedPercept& percept = finished.solved.percepts[i];
    const PerceptRecord& record = percept.record;
    if (!percept.asked || record.basis.summand || record.extractor != Extractor::lateral_force) continue;
    const PerceptReading told = percept_reading(bank, i, finished.found, declarations);
    if (!told.readable || told.unknown) continue;
    text += readable("{}{} {:.3g} is asked for, and the finished program reads {:.2g}", text.empty() ? ": " : "; ",
                     record.name, *percept.asked, told.level);
  }
  return text;
}

void warn_of_scaled_textures(const FinishedMaterial& finished, const CheckedMaterial& material,
                             const Declarations& declarations, Diagnostics& diagnostics) {
  if (material.scaled_textures.empty()) return;
  const std::string levels = asked_and_read(finished, declarations);
  for (const Span& each : material.scaled_textures)
    diagnostics.report({.code = Code::scaled_texture,
                        .span = each,
                        .message = "the amplitude is solved from the percept, and then changed by a factor" + levels,
                        .help = "leave the factor out and ask for more or less of the percept"});
}

/// "`a`, `b` and 3 more": at most eight names.
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 8;
  const std::size_t shown = std::min(names.size(), most);
  std::string text;
  for (std::size_t i = 0; i < shown; ++i)
    text += fmt::format("{}`{}`", i == 0 ? "" : i + 1 == names.size() ? " and " : ", ", names[i]);
  return names.size() > shown ? fmt::format("{} and {} more", text, names.size() - shown) : text;
}

/// Compiles a material. With `first`, which gets what was measured of it, without the warnings that take their own
/// measurements and change nothing of the program.
std::optional<Program> compiled(const CheckedMaterial& checked, const CheckedModule& module, const std::string& device,
                                const SourceSet& sources, SourceId source, Resolver& resolver, Diagnostics& diagnostics,
                                ReadFirst* first) {
  const CheckedMaterial* material = &checked;
  diagnostics.renew_budget();
  diagnostics.allow_text(sources[source].text.size());
  const std::size_t said = diagnostics.all().size();
  FinishedMaterial finished = finish(*material, module, device, sources, resolver, diagnostics,
                                     first ? first->kept : nullptr);
  if (first) *first = std::move(finished.first);
  const SolvedMaterial& solved = finished.solved;
  if (!finished.program || solved.device.shaker) {  // the latter has no force
    warn_of_scaled_textures(finished, *material, module.declarations(), diagnostics);
    return std::move(finished.program);
  }
  const Bank bank(*finished.program);
  warn_of_scaled_textures(finished, *material, module.declarations(), diagnostics);
  const Measured measured = measure(bank);
  if (measured.flat || find_level(*material, solved.device)) {
    report_flat_height(solved, *material, &bank, diagnostics);
    return std::nullopt;
  }
  const GradingHand hand = normal_hand(module.declarations());
  // Whether a value of this material was reported as hardly meant.
  const auto doubted = [&] {
    return !material->doubts.empty() || std::any_of(diagnostics.all().begin() + static_cast<std::ptrdiff_t>(said),
                                                    diagnostics.all().end(), [](const Diagnostic& each) {
                                                      return each.code == Code::under_resolution ||
                                                             each.code == Code::beyond_soft_range;
                                                    });
  };
  // An argument that was hardly meant, and is reported, may be why a force is strange; it is said once.
  if (material->doubts.empty()) {
    const auto is_fine = [](const Diagnostic& each) { return each.code == Code::under_resolution; };
    const bool fine = std::ranges::any_of(diagnostics.all(), is_fine);
    // A period that was given as one is compared with device and patch already.
    const bool far = !doubted() && warn_of_cycles(*material, solved.device, diagnostics);
    const bool partly = !far && warn_of_no_number(*material, solved.device, diagnostics);
    if (!far && !partly && !first) {
      if (!fine) warn_of_jumps(solved, *material, diagnostics);
      if (!doubted()) warn_of_held_feature(bank, solved, *material, diagnostics);
      warn_of_huge_forces(*material, module.declarations(), solved.device, diagnostics);
      warn_of_no_force(bank, *material, solved, measured, diagnostics);
      warn_of_driving_away(*material, solved, diagnostics);
    }
    if (!fine && !first) warn_of_fast_rates(bank, solved, diagnostics);
    if (!partly && !first) warn_of_undeclared_energy(bank, *material, solved, hand, diagnostics);
  }
  warn_of_a_device_that_gives_less(solved, diagnostics);
  if (auto fates = confirm(bank, finished.found, solved, *material, module.declarations(), doubted(), diagnostics)) {
    PatchProgram confirmed = finished.program->description();
    confirmed.fates = *std::move(fates);
    finished.program = *Program::load(std::move(confirmed));  // it differs in fates from a program that was loaded
  }
  return *with_fate_of_force(*finished.program, bank, hand);
}

}  // namespace

SolvedMaterial solve_as_read(const CheckedMaterial& material, const CheckedModule& module, const std::string& device,
                             const SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics) {
  return finish(material, module, device, sources, resolver, diagnostics).solved;
}

CheckedModule check_source(SourceSet& sources, SourceId source, Resolver& resolver, Diagnostics& diagnostics) {
  diagnostics.renew_budget();
  SyntaxTree tree = parse(sources, source, diagnostics);
  diagnostics.allow_text(sources[source].text.size());
  ModuleSet modules = load_modules(std::move(tree), sources, resolver, diagnostics);
  CheckedModule checked = check(std::move(modules), sources, resolver, diagnostics);
  if (diagnostics.all().empty()) return checked;
  std::vector<const SyntaxTree*> trees;
  for (const auto& tree : checked.modules.common->trees) trees.push_back(tree.get());
  for (const auto& module : checked.modules.modules) trees.push_back(&module->tree);
  diagnostics = without_follow_ons(diagnostics, trees, sources, source);
  diagnostics.sort();
  return checked;
}

Result<const CheckedMaterial*> find_material(const CheckedModule& module, const std::string& name,
                                             const std::string& file) {
  if (const CheckedMaterial* material = module.material(name)) return material;
  std::vector<std::string> candidates;
  for (const auto& other : module.materials) candidates.push_back(other.name);
  const auto near = nearest_spelling(name, candidates);
  return Error{.code = Code::unknown_material,
               .sentence = fmt::format("`{}` has no material{}", file, name.empty() ? "" : fmt::format(" `{}`", name)),
               .mend = near                 ? fmt::format("did you mean `{}`?", *near)
                       : candidates.empty() ? "add one, as in `material corduroy { … }`"
                                            : "it has " + listed(candidates),
               .place = {.text = name}};
}

const CheckedMaterial* chosen_material(const CheckedModule& module, const std::string& name, const SourceSet& sources,
                                       SourceId source, Diagnostics& diagnostics) {
  const auto found = find_material(module, name, sources[source].name);
  if (found) return *found;
  diagnostics.report({.code = found.error().code,
                      .span = {source, 0, 0},
                      .message = found.error().sentence,
                      .help = found.error().mend});
  return nullptr;
}

std::optional<Program> compile_material(const CheckedModule& module, const std::string& name, const std::string& device,
                                        const SourceSet& sources, SourceId source, Resolver& resolver,
                                        Diagnostics& diagnostics) {
  const CheckedMaterial* material = chosen_material(module, name, sources, source, diagnostics);
  return material ? compile_material(*material, module, device, sources, source, resolver, diagnostics) : std::nullopt;
}

std::optional<Program> compile_material(const CheckedMaterial& checked, const CheckedModule& module,
                                        const std::string& device, const SourceSet& sources, SourceId source,
                                        Resolver& resolver, Diagnostics& diagnostics) {
  return compiled(checked, module, device, sources, source, resolver, diagnostics, nullptr);
}

std::optional<Program> compile_to_read(const CheckedModule& module, const std::string& name, const std::string& device,
                                       const SourceSet& sources, SourceId source, Resolver& resolver,
                                       Diagnostics& diagnostics, ReadFirst& first) {
  const CheckedMaterial* material = chosen_material(module, name, sources, source, diagnostics);
  return material ? compiled(*material, module, device, sources, source, resolver, diagnostics, &first) : std::nullopt;
}

std::optional<Program> compile(SourceSet& sources, SourceId source, const std::string& material,
                               const std::string& device, Resolver& resolver, Diagnostics& diagnostics) {
  const CheckedModule module = check_source(sources, source, resolver, diagnostics);
  if (diagnostics.has_errors()) return std::nullopt;
  return compile_material(module, material, device, sources, source, resolver, diagnostics);
}

}  // namespace wale
