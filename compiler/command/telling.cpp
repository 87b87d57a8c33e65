#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "compiler/command/verbs.hpp"
#include "compiler/compare/compare.hpp"
#include "compiler/compare/compare_files.hpp"
#include "compiler/compare/propose_levels.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/describe/describe_module.hpp"
#include "compiler/describe/fates.hpp"
#include "compiler/image/image_library.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/preview/preview.hpp"

// What materials are like.

namespace wale::command {
namespace {

/// Warns of publications that nobody has looked up, in their order. They have no place in the person's own files.
void print_recalled(const std::set<const Threshold*>& thresholds) {
  std::set<std::string> lines;
  for (const Threshold* each : thresholds)
    lines.insert(fmt::format("wale: warning[{}]: how little of {} is noticed was recalled and not looked up ({})\n",
                             code_name(Code::unverified_basis), each->cue, each->source));
  for (const std::string& line : lines) fmt::print(stderr, "{}", line);
}

/// What every device makes of a file's materials.
int describe_fates(const Choice& choice, const std::vector<std::string>& settings, bool json) {
  const auto opened = open(choice);
  if (!opened) return refused;
  if (opened->program) return refuse(fmt::format("`{}` is built for one device already", choice.file));
  const auto names = choice.material.empty() ? materials_of(*opened) : std::vector<std::string>{choice.material};
  const std::shared_ptr<const CommonModules> common = declared_everywhere();
  std::vector<DeviceFates> all;
  std::set<std::string> used;  // of the settings, those that some program has a parameter for
  for (const std::string& material : names)
    for (const std::string& device : common->declarations.devices.spellings()) {
      FileRequest request = choice.request();
      request.device = device;
      DeviceFates fates{.material = material, .device = device, .fates = {}, .refusal = {}};
      Diagnostics diagnostics;
      if (const auto program = compile_opened(*opened, request, material, diagnostics)) {
        // A percept that is lost on a device has no parameter there.
        std::vector<std::string> known;
        std::ranges::copy_if(settings, std::back_inserter(known), [&](const std::string& setting) {
          return program->parameter(setting.substr(0, setting.find('='))).has_value();
        });
        used.insert(known.begin(), known.end());
        const auto parameters = chosen_parameters(*program, known);
        if (!parameters) return refused;
        fates.fates = fates_at(Bank(*program, *parameters, program->default_size()), &common->declarations);
      } else {
        for (const Diagnostic& each : diagnostics.all())
          if (fates.refusal.empty() && severity_of(each.code) == Severity::error) fates.refusal = each.message;
      }
      all.push_back(std::move(fates));
    }
  if (all.empty()) return refuse("there is no material to describe");
  for (const std::string& setting : settings)
    if (!used.contains(setting))
      return refuse(fmt::format("on no device is there a parameter for `--set {}`", setting));
  fmt::print("{}", json ? fates_json(all) : fates_text(all));
  return done;
}

}  // namespace

int describe(const Choice& choice, const std::vector<std::string>& settings, bool exports, bool json) {
  if (choice.device == "all") return describe_fates(choice, settings, json);
  auto opened = open(choice);
  if (!opened) return refused;
  if (opened->module && choice.material.empty() && (exports || opened->module->materials.empty())) {
    const ModuleDescription module = describe_module(*opened->module, opened->sources);
    if (exports || !module.empty()) {
      print_diagnostics(stderr, opened->diagnostics, opened->sources);
      fmt::print("{}", json ? module_json(module) : module_text(module));
      return 0;
    }
  }
  const auto programs = programs_of(*opened, choice, true);
  if (programs.empty()) return refused;
  const std::shared_ptr<const CommonModules> common = declared_everywhere();
  std::vector<Description> descriptions;
  for (const auto& program : programs) {
    const auto parameters = chosen_parameters(program, settings);
    if (!parameters) return refused;
    descriptions.push_back(describe(Bank(program, *parameters, program.default_size()), &common->declarations));
  }
  if (json) {
    fmt::print("{}", descriptions_json(descriptions));
    return 0;
  }
  for (std::size_t i = 0; i < descriptions.size(); ++i)
    fmt::print("{}{}", i == 0 ? "" : "\n", description_text(descriptions[i]));
  return 0;
}

int compare(const Choice& choice, const std::vector<std::string>& names, bool with_table, bool json) {
  const std::shared_ptr<const CommonModules> common = declared_everywhere();
  std::vector<ComparedFile> files = read_cues(names, choice.request(), common->declarations);
  bool all_read = true;
  for (const ComparedFile& file : files) {
    const OpenedFile& opened = file.opened;
    print_diagnostics(stderr, opened.diagnostics, opened.sources);
    if (!opened.refusal.empty()) refuse(opened.refusal);
    all_read = all_read && opened.refusal.empty() && !opened.diagnostics.has_errors();
    // Among many files are some that only lend functions to others.
    if (file.without_material()) refuse(fmt::format("`{}` has no material and is left out", file.name.file));
  }
  if (!all_read) return refused;
  if (const auto fit = comparable(files); !fit) return refuse(fit.error());
  std::vector<Cues> materials;
  for (ComparedFile& file : files) materials.insert(materials.end(), file.cues.begin(), file.cues.end());
  const ComparisonMatrix matrix(std::move(materials), common->declarations);
  print_recalled(matrix.recalled());
  fmt::print("{}", json ? comparison_json(matrix) : comparison_text(matrix, with_table));
  return done;
}

int levels(const std::string& percept, const std::string& device, std::optional<std::size_t> steps, double apart,
           bool json) {
  const std::shared_ptr<const CommonModules> common = declared_everywhere();
  const auto proposed = propose_levels(percept, device, steps, apart, common->declarations);
  if (!proposed) return refuse(proposed.error());
  const LevelProposal& proposal = *proposed;
  std::set<const Threshold*> recalled;
  for (const ProposedLevel& each : proposal.levels)
    if (each.threshold && each.threshold->recalled()) recalled.insert(each.threshold);
  print_recalled(recalled);
  fmt::print("{}", json ? proposal_json(proposal) : proposal_text(proposal));
  return done;
}

int preview(const Choice& choice, const std::vector<std::string>& settings, const std::string& out) {
  const auto programs = load_programs(choice, false);
  if (programs.empty()) return refused;
  const auto parameters = chosen_parameters(programs.front(), settings);
  if (!parameters) return refused;
  const Bank bank(programs.front(), *parameters, programs.front().default_size());
  const auto drawing = draw_preview(bank, preview_text(bank));
  if (!drawing) return refuse(drawing.error());
  if (!drawing->has_text)
    fmt::print(stderr, "wale: no font is installed, so the picture has no words (Debian: fonts-dejavu-core)\n");
  if (const auto saved = save_drawing(*drawing, out); !saved) return refuse(saved.error());
  return 0;
}

}  // namespace wale::command
