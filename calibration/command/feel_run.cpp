#include "calibration/command/feel_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <span>
#include <utility>

#include "calibration/command/devices_here.hpp"
#include "calibration/command/trusted_here.hpp"
#include "compiler/command/print.hpp"
#include "compiler/command/workspace_choice.hpp"
#include "compiler/declarations/declared_devices.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/solve/level_scale.hpp"
#include "schema/regular_file.hpp"
#include "schema/spelling.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

/// Checks that `name`, if it is not empty, is a device to build for. Error: W0601.
Result<> can_be_built_for(const std::string& name, const std::vector<DeclaredDevice>& known) {
  std::vector<std::string> names;
  for (const DeclaredDevice& each : known) names.push_back(each.profile.name);
  if (name.empty() || std::ranges::find(names, name) != names.end()) return {};
  const auto near = nearest_spelling(name, names);
  return Error{Code::unknown_device,
               fmt::format("no device is called `{}`", name),
               near ? fmt::format("did you mean `{}`?", *near) : "`wale devices` lists them",
               {.name = "--built-for", .text = name}};
}

/// Checks that no file of `files` keeps a device to itself that an option names. Error: W0215.
Result<> are_exported(const FeelOptions& options, const std::vector<DeclaredDevice>& known,
                      const std::vector<DeviceFile>& files) {
  constexpr std::string_view prefix = "simulated:";
  const std::string asked = options.device.starts_with(prefix) ? options.device.substr(prefix.size()) : options.device;
  for (const auto& [option, name] : {std::pair{"--device", asked}, {"--built-for", options.built_for}}) {
    const auto is_named = [&name = name](const DeclaredDevice& each) { return each.profile.name == name; };
    if (std::ranges::any_of(known, is_named)) continue;
    if (auto hidden = private_device(name, files, option)) return *std::move(hidden);
  }
  return {};
}

/// An option that cannot apply to a run.
struct Inapplicable {
  const char* option;
  bool is_so;
  std::string why;  ///< it cannot apply
  const char* mend;
};

/// Checks that none of them is so. Error: W0801, which means wrong usage.
Result<> all_apply(std::initializer_list<Inapplicable> options) {
  for (const auto& [option, is_so, why, mend] : options)
    if (is_so) return Error{Code::malformed_value, why, mend, {.name = option}};
  return {};
}

/// Checks that options about the file apply to it.
Result<> apply_to_file(const FeelOptions& options, const OpenedFile& opened) {
  return all_apply({{"--watch", options.watch && !opened.is_on_disk,
                     fmt::format("expected a file on disk, found `{}`, which is only inside wale", opened.name),
                     "leave out --watch, or save the material in a file of your own"}});
}

/// Checks that options about the device apply to the chosen one.
Result<> apply_to_device(const FeelOptions& options, const ChosenDevice& chosen) {
  return all_apply(
      {{"--transport", !options.transport.empty() && !chosen.plugged, "expected a real device, found a simulated one",
        "leave out --transport, or name a real device with --device"}});
}

/// Checks that options about forces and hands apply to the program.
Result<> apply_to_program(const FeelOptions& options, const PatchProgram& program) {
  return all_apply(
      {{"--max-force", options.max_force && program.vibrates(),
        fmt::format("`{}` only vibrates: it has no force to limit", program.device.name), "leave out --max-force"},
       {"--hand", options.hand && !program.device.has_position(),
        fmt::format("`{}` does not measure the hand's position, so no hand moves on it", program.device.name),
        "leave out --hand"}});
}

/// Whether a person asks for a device that may be a real one, and names it.
bool may_name_a_real_device(const FeelOptions& options) {
  if (options.virtual_time || options.hand || options.device.empty() || options.device == "auto") return false;
  if (options.device.starts_with("simulated")) return false;
  const DeviceDeclaration* shipped = common_modules()->declarations.devices.find(options.device);
  return shipped == nullptr || !shipped->wiring.usb.empty() || shipped->wiring.is_generic;
}

/// What this person trusts. An error in the owner's own file is only warned of where the run may do without it.
Result<TrustedDeclarations> trusted_for(const FeelOptions& options) {
  auto trusted = trusted_here(options.trusted);
  if (!trusted) return trusted;
  if (trusted->owners_problem && may_name_a_real_device(options)) return *std::move(trusted->owners_problem);
  warn_of_unused(*trusted);
  return trusted;
}

/// The devices that a file knows.
struct KnownDevices {
  std::vector<DeclaredDevice> devices;
  std::string only_in_program;  ///< the one among them that only the patch program brings; may be empty
};

KnownDevices known_to(const OpenedFile& opened, const Choice& choice) {
  if (opened.module) return {declared_devices(opened.module->declarations()), {}};
  KnownDevices known{devices_here(choice.folders, choice.devices), {}};
  const DeviceProfile& own = opened.program->description().device;
  const auto is_own = [&](const DeclaredDevice& each) { return each.profile.name == own.name; };
  if (std::ranges::any_of(known.devices, is_own)) return known;
  known.devices.push_back({.profile = own});
  known.only_in_program = own.name;
  return known;
}

/// Bytes; 4096 programs of 4 MB would be more than any stage needs.
constexpr std::size_t largest_workspace_file = std::size_t{1} << 30;

/// Compiles the workspace that was named. Errors: W0609; W0801 for a patch program, and for a workspace without
/// patches.
OrStatus<Workspace> workspace_to_feel(const OpenedFile& opened, const FeelOptions& options, const Choice& built) {
  const auto chosen = compiled_workspace(opened, options.workspace, built);
  if (!chosen) return chosen.status();
  if (chosen->laid.empty())
    return refuse(Error{Code::malformed_value,
                        fmt::format("`{}` has no patch to feel", options.workspace),
                        "put one into it, as in `patch board = oak`",
                        {.name = "--workspace"}});
  return chosen->made();
}

/// The recording to make of the run, if the person asked for one.
std::optional<RecordTo> recording_of(const FeelOptions& options, const RunManner& manner) {
  if (!has_ending(options.record, ".wrec")) return std::nullopt;
  return RecordTo{options.record, visible_text(fmt::format("{}, {}", manner.device, manner.hand))};
}

/// A workspace file, and its first program in place of the material of other files.
struct OpenedWorkspace {
  OpenedFile file;
  Workspace workspace;
};

/// Reads a workspace file. Errors: `unreadable_file`, those of `Workspace::load`, and of options that are for the text
/// of a material.
Result<OpenedWorkspace> opened_workspace(const FeelOptions& options) {
  const std::string& name = options.choice.file;
  constexpr std::string_view why = "a workspace file holds finished programs";
  if (auto fit = all_apply({{"--workspace", !options.workspace.empty(), std::string(why), "leave out --workspace"},
                            {"--material", !options.choice.material.empty(), std::string(why), "leave out --material"},
                            {"--set", !options.settings.empty(), std::string(why), "leave out --set"},
                            {"--watch", options.watch, std::string(why), "leave out --watch"},
                            {"--blind", options.blind, std::string(why), "leave out --blind"},
                            {"--against", !options.against.empty(), std::string(why), "leave out --against"}});
      !fit)
    return std::move(fit).error();
  const auto bytes = read_regular_file(name, largest_workspace_file);
  auto workspace = bytes ? Workspace::load(std::as_bytes(std::span(*bytes))) : bytes.error();
  if (workspace && workspace->patches.empty())
    return Error{Code::malformed_value, "it has no patch to feel", "", {.name = name}};
  if (!workspace) {
    Error error = std::move(workspace).error();
    error.place.name = name;
    return error;
  }
  OpenedWorkspace opened{{.name = name, .program = workspace->patches.front().program}, {}};
  opened.workspace = *std::move(workspace);
  return opened;
}

}  // namespace

bool is_workspace_file(const FeelOptions& options) { return has_ending(options.choice.file, ".wws"); }

void say(const std::string& what) { print_error("wale: {}\n", what); }

Result<BlindMaterial> material_to_feel(const Program& program, const std::vector<std::string>& settings) {
  auto parameters = chosen_parameters(program, settings);
  if (!parameters) return parameters.error();
  return BlindMaterial{program, *std::move(parameters)};
}

OrStatus<PreparedRun> prepared(const FeelOptions& options, const std::atomic<bool>& stop) {
  const auto trusted = trusted_for(options);
  if (!trusted) return refuse(trusted.error());
  Choice built = options.choice;
  built.device.clear(), built.device_option.clear();           // it is not known yet
  built.devices = trusted->files, built.knows_owners = false;  // they are among these
  built.shares_options = !options.against.empty();
  Workspace workspace;
  OrStatus<OpenedFile> opened = done;
  if (is_workspace_file(options)) {
    auto ready = opened_workspace(options);
    if (!ready) return refuse(ready.error());
    opened = std::move(ready->file);
    workspace = std::move(ready->workspace);
  } else {
    opened = open(built);
  }
  if (!opened) return opened.status();
  if (const auto fit = apply_to_file(options, *opened); !fit) return refuse(fit.error());
  if (const auto same = is_as_named(*opened, {}, options.choice); !same) return refuse(same.error());
  if (options.hand) options.choice.inputs->push_back(*options.hand);
  const auto [known, only_in_program] = known_to(*opened, built);
  if (const auto exported = are_exported(options, known, trusted->checked); !exported) return refuse(exported.error());
  if (const auto is_known = can_be_built_for(options.built_for, known); !is_known) return refuse(is_known.error());
  const bool asks = !options.device.empty();
  auto device =
      device_to_feel({.spelling = asks ? options.device : "auto",
                      .built_for = opened->program ? opened->program->description().device.name : options.built_for,
                      .transport = options.transport,
                      .only_simulated = options.virtual_time || options.hand,
                      .only_in_program = only_in_program},
                     known, trusted->devices, options.seconds, say, stop);
  if (!device) return refuse(device.error());
  const ChosenDevice& chosen = device->chosen;
  if (trusted->owners_problem && chosen.plugged) return refuse(*trusted->owners_problem);
  if (const auto fit = apply_to_device(options, chosen); !fit) return refuse(fit.error());
  if (!chosen.said.empty() && (asks || chosen.is_worth_saying)) say(chosen.said);

  built.device = chosen.declared ? chosen.declared->profile.name : options.choice.device;
  if (opened->module) check_levels(opened->module->declarations(), opened->source, built.device, opened->diagnostics);
  std::optional<BlindMaterial> material;
  if (options.workspace.empty() && workspace.patches.empty()) {
    const auto programs = programs_of(*opened, built, false);
    if (!programs) return programs.status();
    if (const auto fit = apply_to_program(options, programs->front().description()); !fit) return refuse(fit.error());
    auto chosen = material_to_feel(programs->front(), options.settings);
    if (!chosen) return refuse(chosen.error());
    material = *std::move(chosen);
  } else {
    if (workspace.patches.empty()) {
      auto found = workspace_to_feel(*opened, options, built);
      if (!found) return found.status();
      workspace = *std::move(found);
    }
    const Program& first = workspace.patches.front().program;
    if (const auto fit = apply_to_program(options, first.description()); !fit) return refuse(fit.error());
    material = BlindMaterial{first, first.default_parameters()};
  }
  return PreparedRun{*std::move(device), std::move(built), *std::move(material), std::move(workspace)};
}

OrStatus<FeltDevice> open_prepared(const FeelOptions& options, const PreparedRun& run, const std::atomic<bool>& stop) {
  const HandDeclaration* person = declared_everywhere()->declarations.hands.find("normal");
  FeltOptions how{.virtual_time = options.virtual_time,
                  .transport = options.transport,
                  .most_newton = options.max_force.value_or(HUGE_VAL)};
  if (options.hand) how.hand = *options.hand;
  auto device = open_to_feel(run.device, run.material.program.description(), *person, how, say, stop);
  if (!device) return refuse(device.error());
  return *std::move(device);
}

StageOptions stage_options(const FeelOptions& options, const RunManner& manner) {
  StageOptions how = felt_stage_options(options.max_force.value_or(HUGE_VAL));
  how.record = recording_of(options, manner);
  return how;
}

RunOptions run_options(const FeelOptions& options, const std::atomic<bool>& stop) {
  const bool is_recording = has_ending(options.record, ".wrec"), is_table = !options.record.empty() && !is_recording;
  return {.seconds = options.seconds.value_or(usual_seconds),
          .virtual_time = options.virtual_time,
          .stop = &stop,
          .kept_seconds = !is_table && (is_recording || options.watch) ? measured_seconds : HUGE_VAL};
}

Result<std::optional<OutputFile>> table_of(const FeelOptions& options) {
  std::optional<OutputFile> table;
  if (options.record.empty() || has_ending(options.record, ".wrec")) return table;
  auto opened = OutputFile::open(options.record, *options.choice.inputs);
  if (!opened) return opened.error();
  table = *std::move(opened);
  return table;
}

}  // namespace wale::command
