#include "compiler/describe/describe.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <memory>
#include <set>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/command/workspace_choice.hpp"
#include "compiler/compile_experiment.hpp"
#include "compiler/describe_experiment.hpp"
#include "compiler/describe/describe_module.hpp"
#include "compiler/describe/describe_workspace.hpp"
#include "compiler/describe/fates.hpp"
#include "compiler/measure/coarseness.hpp"

namespace wale::command {
namespace {

struct DescribeOptions {
  Choice choice;  ///< the device may be `all`
  std::vector<std::string> settings;
  std::string workspace;  ///< only this one; empty for all of the file
  std::string experiment;  ///< only this one; empty for all of a file without a material
  bool exports = false, json = false;
};

/// The workspaces of a file that were asked for. Errors: W0609; W0801 for a patch program.
Result<std::vector<const CheckedWorkspace*>> chosen_workspaces(const OpenedFile& opened, const std::string& name) {
  if (!opened.module || !name.empty()) {
    auto found = workspace_in(opened, name);
    if (!found) return found.error();
    return std::vector{*found};
  }
  std::vector<const CheckedWorkspace*> all;
  for (const CheckedWorkspace& each : opened.module->workspaces) all.push_back(&each);
  return all;
}

/// Describes workspaces of a file. Empty after errors, which are printed.
std::optional<std::vector<WorkspaceDescription>> described_workspaces(
    const OpenedFile& opened, const std::vector<const CheckedWorkspace*>& chosen, const DescribeOptions& options) {
  const auto declarations = declarations_of(opened, options.choice);
  std::vector<WorkspaceDescription> descriptions;
  Diagnostics found;
  for (const CheckedWorkspace* workspace : chosen) {
    const auto laid = laid_in(opened, *workspace, options.choice, found);
    if (!laid) break;
    descriptions.push_back(describe_workspace(*workspace, *laid, options.choice.device, *declarations));
  }
  print_diagnostics(stderr, found, opened.sources);
  return descriptions.size() == chosen.size() ? std::optional(std::move(descriptions)) : std::nullopt;
}

/// Prints the workspaces of a file. With an option that names one, or without a material, they are all that is printed.
/// Nothing if there are none.
std::optional<int> describe_workspaces(OpenedFile& opened, const DescribeOptions& options) {
  const bool is_asked = !options.workspace.empty();
  const bool alone = is_asked || (opened.module && opened.module->materials.empty());
  if (options.exports || (!is_asked && (!opened.module || opened.module->workspaces.empty() ||
                                        !options.choice.material.empty() || !opened.material.empty())))
    return std::nullopt;
  if (!alone && options.json) return std::nullopt;  // one JSON value: that of the materials
  const auto chosen = chosen_workspaces(opened, options.workspace);
  if (!chosen) return refuse(chosen.error());
  if (!options.settings.empty() && alone)
    return refuse(Error{.code = Code::malformed_value,
                        .sentence = "a workspace has no parameters of its own",
                        .mend = "leave out --set, or give the value in the file: `patch board = oak(line: 4 mm)`",
                        .place = {.name = "--set"}});
  if (alone) print_diagnostics(stderr, opened.diagnostics, opened.sources);  // otherwise they are printed already
  const auto described = described_workspaces(opened, *chosen, options);
  if (!described) return refused;
  if (options.json) {
    print_out(workspaces_json(*described));
    return done;
  }
  for (std::size_t i = 0; i < described->size(); ++i)
    print_out((i == 0 && alone ? "" : "\n") + workspace_text((*described)[i]));
  return done;
}

/// Prints the experiments of a file, if one is named or the file has nothing else to describe. Where it has, they are
/// only listed, since all of their stimuli are built.
std::optional<int> describe_experiments(OpenedFile& opened, const DescribeOptions& options) {
  const bool is_asked = !options.experiment.empty();
  if (!is_asked && (!opened.module || opened.module->experiments.empty() || options.exports || options.json ||
                    !options.workspace.empty() || !options.choice.material.empty()))
    return std::nullopt;
  if (is_asked && !opened.module)
    return refuse(Error{.code = Code::malformed_value,
                        .sentence = fmt::format("expected a Wale file, found `{}`, a patch program", opened.name),
                        .place = {.name = "--experiment"}});
  std::vector<const CheckedExperiment*> chosen;
  if (is_asked) {
    const auto found = find_experiment(*opened.module, options.experiment, opened.name);
    if (!found) return refuse(found.error());
    chosen.push_back(*found);
  } else {
    for (const CheckedExperiment& each : opened.module->experiments) chosen.push_back(&each);
  }
  if (!is_asked && (!opened.module->materials.empty() || !opened.module->workspaces.empty())) {
    for (const CheckedExperiment* each : chosen)
      print_out("\nexperiment {}: {} stimuli; `--experiment {}` describes it\n", each->name, each->stimuli.size(), each->name);
    return done;
  }
  print_diagnostics(stderr, opened.diagnostics, opened.sources);
  if (opened.diagnostics.has_errors()) return refused;
  const FileRequest request = options.choice.recording_request();
  const auto resolver = file_resolver(request.roots, request.looked_for, request.sandbox, request.devices);
  const auto declarations = declarations_of(opened, options.choice);
  std::vector<ExperimentDescription> all;
  for (const CheckedExperiment* each : chosen)
    all.push_back(describe_experiment(
        *each, compile_experiment(*each, *opened.module, request.device, opened.sources, opened.source, *resolver),
        request.device, *declarations));
  if (options.json) print_out(experiments_json(all));
  else
    for (std::size_t i = 0; i < all.size(); ++i) print_out((i == 0 ? "" : "\n") + experiment_text(all[i]));
  return done;
}

/// The fates of a material on one device. Settings of parameters that its program has are added to `used`, since a
/// percept that is lost on a device has no parameter there. Errors: those of a wrong setting.
Result<DeviceFates> fates_on(const OpenedFile& opened, const FileRequest& request, const std::string& material,
                             const std::vector<std::string>& settings, const Declarations& declarations,
                             std::set<std::string>& used) {
  Diagnostics diagnostics;
  const auto program = compile_opened(opened, request, material, diagnostics);
  if (!program) {
    // Where there is no program there is an error.
    const Diagnostic& first = *std::ranges::find(diagnostics.all(), Severity::error,
                                                 [](const Diagnostic& each) { return severity_of(each.code); });
    return DeviceFates{.material = material,
                       .device = request.device,
                       .fates = Error{.code = first.code, .sentence = first.message, .mend = first.help}};
  }
  std::vector<std::string> known;
  std::ranges::copy_if(settings, std::back_inserter(known), [&](const std::string& setting) {
    return program->parameter(setting_name(setting)).has_value();
  });
  used.insert(known.begin(), known.end());
  const auto parameters = chosen_parameters(*program, known);
  if (!parameters) return parameters.error();
  return DeviceFates{.material = material,
                     .device = request.device,
                     .fates = fates_at(Bank(*program, *parameters, program->default_size()), declarations)};
}

/// Prints the fates of a file's materials on all devices.
int describe_fates(const DescribeOptions& options) {
  Choice choice = options.choice;
  choice.device = default_device, choice.device_option.clear();  // `all` is no device
  auto opened = open(choice);
  if (!opened) return opened.status();
  warn_of_device_files(options.choice);
  if (opened->program)
    return refuse(Error{.code = Code::malformed_value,
                        .sentence = fmt::format("expected a Wale file, found `{}`, which is built for `{}` already",
                                                opened->name, opened->program->description().device.name),
                        .mend = "leave out --device, or name the Wale file that it was built from",
                        .place = {.name = "--device"}});
  const auto names = choice.material.empty() ? materials_of(*opened) : std::vector<std::string>{choice.material};
  for (const std::string& name : names)
    if (!chosen_material(*opened->module, name, opened->sources, opened->source, opened->diagnostics)) {
      print_diagnostics(stderr, opened->diagnostics, opened->sources);
      return refused;
    }
  const auto declarations = declarations_of(*opened, choice);
  std::vector<DeviceFates> all;
  std::set<std::string> used;
  for (const std::string& material : names)
    for (const std::string& device : declarations->devices.spellings()) {
      FileRequest request = choice.request();
      request.device = device;
      auto fates = fates_on(*opened, request, material, options.settings, *declarations, used);
      if (!fates) return refuse(fates.error());
      all.push_back(*std::move(fates));
    }
  if (all.empty())
    return refuse(Error{.code = Code::unknown_material,
                        .sentence = fmt::format("`{}` has no material to describe", opened->name)});
  for (const std::string& setting : options.settings)
    if (!used.contains(setting))
      return refuse(Error{.code = Code::unknown_setting,
                          .sentence = fmt::format("`{}` sets a parameter that no material has on any device", setting),
                          .place = {.name = "--set", .text = setting}});
  print_out(options.json ? fates_json(all) : fates_text(all));
  return done;
}

/// Prints the exports of a file, if it has any or they were asked for.
std::optional<int> describe_exports(const OpenedFile& opened, const DescribeOptions& options) {
  const bool is_asked = options.exports || (opened.module && opened.module->materials.empty());
  if (!opened.module || !options.choice.material.empty() || !is_asked) return std::nullopt;
  const ModuleDescription module = describe_module(*opened.module, opened.sources);
  if (!options.exports && module.empty()) return std::nullopt;
  const char* of_a_material = !options.choice.device_option.empty() ? "--device"
                              : !options.settings.empty()           ? "--set"
                                                                    : nullptr;
  if (of_a_material != nullptr)
    return refuse(Error{.code = Code::malformed_value,
                        .sentence = fmt::format("`{}` has no material", opened.name),
                        .mend = fmt::format("leave out {} to list what the file exports", of_a_material),
                        .place = {.name = of_a_material}});
  print_diagnostics(stderr, opened.diagnostics, opened.sources);
  print_out(options.json ? module_json(module) : module_text(module));
  return done;
}

int describe(const DescribeOptions& options) {
  if (options.choice.device == "all") return describe_fates(options);
  auto opened = open(options.choice);
  if (!opened) return opened.status();
  if (options.exports && opened->program)
    return refuse(Error{.code = Code::malformed_value,
                        .sentence = fmt::format(
                            "expected a Wale file, found `{}`, a patch program, which exports nothing", opened->name),
                        .mend = "leave out --exports, or name the Wale file that it was built from",
                        .place = {.name = "--exports"}});
  const bool only_experiments =
      !options.experiment.empty() || (opened->module && opened->module->materials.empty() &&
                                      opened->module->workspaces.empty() && !opened->module->experiments.empty());
  if (only_experiments)
    if (const auto status = describe_experiments(*opened, options)) return *status;
  const bool only_workspaces = !options.workspace.empty() || (opened->module && opened->module->materials.empty() &&
                                                              !opened->module->workspaces.empty());
  if (only_workspaces)
    if (const auto status = describe_workspaces(*opened, options)) return *status;
  if (const auto status = describe_exports(*opened, options)) return *status;
  const auto programs = programs_of(*opened, options.choice, true);
  if (!programs) return programs.status();
  const auto declarations = declarations_of(*opened, options.choice);
  std::vector<Description> descriptions;
  for (const auto& program : *programs) {
    const auto parameters = chosen_parameters(program, options.settings);
    if (!parameters) return refuse(parameters.error());
    descriptions.push_back(wale::describe(Bank(program, *parameters, program.default_size()), *declarations));
    if (const Description& last = descriptions.back(); last.coarseness > 1)
      print_error("wale: {}\n", coarseness_note(last.material, last.coarseness));
  }
  if (options.json) {
    print_out(descriptions_json(descriptions));
    return done;
  }
  for (std::size_t i = 0; i < descriptions.size(); ++i)
    print_out((i == 0 ? "" : "\n") + description_text(descriptions[i]));
  const int status = describe_workspaces(*opened, options).value_or(done);
  return status == done ? describe_experiments(*opened, options).value_or(done) : status;
}

Run declare_describe(CLI::App& verb) {
  const auto options = std::make_shared<DescribeOptions>();
  offer_material(verb, options->choice,
                 {.about_material = "which material of the file (default: all of them)",
                  .about_device = "the device to build for, or `all` (default: sandpaper; see `wale devices`)"});
  offer_settings(verb, options->settings);
  verb.add_flag("--exports", options->exports,
                "lists what the file exports (the default for a file without a material)")
      ->excludes("--material")
      ->excludes("--device")
      ->excludes("--set");
  must_say(verb.add_option("--workspace", options->workspace, "only this workspace of the file")->type_name("NAME"),
           "the name of a workspace")
      ->excludes("--material")
      ->excludes("--exports");
  must_say(verb.add_option("--experiment", options->experiment,
                           "an experiment of the file: how long it takes, which pairs people hardly tell apart, and what "
                           "the device does not render")
               ->type_name("NAME"),
           "the name of an experiment")
      ->excludes("--workspace")
      ->excludes("--material")
      ->excludes("--set")
      ->excludes("--exports");
  offer_json(verb, options->json, "an object for one material, workspace or experiment, an array for several");
  verb.footer("for example: wale describe corduroy --set wale=4mm;  wale describe my.wale --device all");
  return [options] { return describe(*options); };
}

}  // namespace

extern const Verb describe_verb{"describe", "says what materials feel like, on what evidence, and how hard they push",
                                declare_describe};

}  // namespace wale::command
