#include "compiler/command/command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "compiler/command/print.hpp"
#include "compiler/device_file.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/modules/library_folders.hpp"
#include "compiler/modules/load_modules.hpp"
#include "schema/owners_devices_file.hpp"
#include "compiler/quantity.hpp"
#include "compiler/typed_number.hpp"
#include "schema/spelling.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

/// Whether to print in colour: the stream is a terminal and NO_COLOR is not set.
bool colour(FILE* stream) { return isatty(fileno(stream)) && !std::getenv("NO_COLOR"); }

Error not_a_setting(const std::string& text) {
  return {.code = Code::malformed_value,
          .sentence = fmt::format("expected NAME=VALUE, {}", found_typed(text)),
          .mend = "for example, `--set wale=5mm`",
          .place = {.name = "--set", .text = text}};
}

/// Whether an error means that the words of the command make no sense: a word cannot be read or does not apply here,
/// or an option names something unknown.
bool is_misuse(const Error& error) {
  if (error.code == Code::malformed_value) return true;
  if (!error.place.name.starts_with('-')) return false;
  switch (error.code) {
    case Code::value_out_of_range:
    case Code::missing_argument:
    case Code::wrong_dimension:
    case Code::mismatched_dimensions:
    case Code::unknown_unit:
    case Code::number_out_of_range:
    case Code::unknown_device:
    case Code::private_name:
    case Code::unknown_material:
    case Code::unknown_workspace:
    case Code::unknown_name:
    case Code::other_device:
    case Code::unknown_setting: return true;
    default: return false;
  }
}

/// The owner's devices.wale; nothing if it cannot be read.
std::optional<ResolvedFile> owners_file_of_devices() {
  auto owners = read_file(owners_devices_file(std::getenv("XDG_CONFIG_HOME"), std::getenv("HOME")));
  if (!owners) return std::nullopt;
  return *std::move(owners);
}

/// The files of devices that a choice knows, as checked.
struct KnownDeviceFiles {
  std::vector<DeviceFile> sound;
  std::string owners;                   ///< the name of the owner's file
  std::optional<Error> owners_problem;  ///< the first error in it
};

KnownDeviceFiles device_files_of(const Choice& choice) {
  KnownDeviceFiles known;
  const std::vector<std::string> roots = library_folders(choice.folders, std::getenv("WALE_LIBRARY"));
  for (const ResolvedFile& file : choice.devices)
    if (auto checked = check_device_file(file, roots)) known.sound.push_back(*std::move(checked));
  const auto owners = choice.knows_owners ? owners_file_of_devices() : std::nullopt;
  if (!owners) return known;
  known.owners = owners->name;
  auto checked = check_device_file(*owners, roots);
  if (checked)
    known.sound.push_back(*std::move(checked));
  else
    known.owners_problem = std::move(checked.error());
  return known;
}

Error no_parameter(const PatchProgram& program, const std::string& name) {
  std::vector<std::string> known;
  for (const auto& parameter : program.parameters) known.push_back(parameter.name);
  const auto near = nearest_spelling(name, known);
  return {.code = Code::unknown_setting,
          .sentence = fmt::format("the material `{}` has no parameter `{}`", program.material, name),
          .mend = (near            ? fmt::format("did you mean `{}`?", *near)
                   : known.empty() ? std::string("it has no parameters")
                                   : fmt::format("its parameters: {}", fmt::join(known, ", "))) +
                  "; of a file with several materials, `--material` chooses one",
          .place = {.name = "--set", .text = name}};
}

}  // namespace

int refuse(const std::string& reason) {
  print_error("wale: {}{}", reason, reason.ends_with('\n') ? "" : "\n");
  return refused;
}

int refuse(const Error& error) {
  refuse(error_text(error));
  return is_misuse(error) ? misused : refused;
}

void warn(const Error& warning) { print_error("wale: {}\n", error_text(warning)); }

std::string error_text(const Error& error) {
  const Place& place = error.place;
  std::string text = severity_of(error.code) == Severity::error ? "error" : "warning";
  text += fmt::format("[{}]: {}{}", code_name(error.code), visible_text(place.name),
                      place.number ? fmt::format("{}{}", place.name.empty() ? "" : ":", *place.number) : "");
  if (!place.name.empty() || place.number) text += ": ";
  text += visible_text(error.sentence);
  if (!place.source.empty()) text += fmt::format(" (from {})", visible_text(place.source));
  for (const Place& before : error.led_to)
    text += "\n  after " + visible_text(fmt::format("{} {} {}", before.name,
                                                    before.number ? std::to_string(*before.number) : "", before.text));
  if (!error.mend.empty()) text += "\n  = help: " + visible_lines(error.mend);  // some have lines to copy
  return text;
}

void print_diagnostics(std::FILE* stream, const Diagnostics& diagnostics, const SourceSet& sources) {
  for (const auto& diagnostic : diagnostics.all())
    print_as_is(stream, render_text(diagnostic, sources, colour(stream)) + "\n");  // which is visible, with colours
}

FileRequest Choice::request() const {
  FileRequest request{.file = file,
                      .device = device,
                      .roots = library_folders(folders, std::getenv("WALE_LIBRARY")),
                      .devices = devices,
                      .sandbox = sandbox};
  const bool is_shipped = device.empty() || common_modules()->declarations.devices.contains(device);
  if (is_shipped || !knows_owners) return request;
  if (auto owners = owners_file_of_devices(); owners && check_device_file(*owners, request.roots))
    request.devices.push_back(*std::move(owners));
  return request;
}

FileRequest Choice::recording_request() const {
  FileRequest recording = request();
  recording.looked_for = inputs.get();
  for (const ResolvedFile& each : recording.devices) inputs->push_back(each.name);
  return recording;
}

void say_taken(const OpenedFile& opened) {
  if (!opened.taken.empty()) print_error("wale: {}\n", visible_text(opened.taken));
}

Result<> is_as_named(const OpenedFile& opened, const std::string& material, const Choice& choice) {
  if (!opened.program) return {};
  const PatchProgram& program = opened.program->description();
  if (!material.empty() && material != program.material)
    return Error{.code = Code::unknown_material,
                 .sentence = fmt::format("the patch program `{}` holds only `{}`, not `{}`", opened.name,
                                         program.material, material),
                 .mend = "leave out the material, or name the Wale file that it was built from",
                 .place = {.name = choice.material_option.empty() ? opened.name : choice.material_option}};
  if (!choice.device_option.empty() && choice.device != program.device.name)
    return Error{
        .code = Code::other_device,
        .sentence = fmt::format("expected `{}`, the device that `{}` is built for, found `{}`", program.device.name,
                                opened.name, choice.device),
        .mend = fmt::format("leave out {}, or name the Wale file that it was built from", choice.device_option),
        .place = {.name = choice.device_option, .text = choice.device}};
  return {};
}

Result<> has_material(const OpenedFile& opened, const Choice& choice) {
  if (!opened.module || choice.material_option.empty() || choice.material.empty()) return {};
  auto found = find_material(*opened.module, choice.material, opened.name);
  if (found) return {};
  found.error().place.name = choice.material_option;
  return std::move(found.error());
}

Result<> has_use_for_options(const OpenedFile& opened, const Choice& choice) {
  if (!opened.program || choice.shares_options) return {};
  const char* useless = !choice.folders.empty()                          ? "--library"
                        : choice.sandbox == Sandbox::if_possible         ? "--unsandboxed-pictures"
                        : !choice.devices.empty() && choice.knows_owners ? "--devices"
                                                                         : nullptr;
  if (useless == nullptr) return {};
  return Error{.code = Code::malformed_value,
               .sentence = fmt::format("expected a Wale file, found the patch program `{}`, which needs no other file",
                                       opened.name),
               .mend = fmt::format("leave out {}, or name the Wale file that it was built from", useless),
               .place = {.name = useless}};
}

void warn_of_library_variable() {
  for (const std::string& folder : library_folders({}, std::getenv("WALE_LIBRARY")))
    if (std::error_code ignored; !std::filesystem::is_directory(folder, ignored))
      print_error("wale: warning: WALE_LIBRARY names `{}`, which is no folder\n", visible_text(folder));
}

void say_unread(const std::vector<std::string>& roots) {
  for (const std::string& folder : file_resolver(roots)->unreadable_folders("here"))
    print_error("wale: warning: the folder `{}` cannot be read, so its materials are not known\n",
                visible_text(folder));
}

Result<> has_device(const CheckedModule& module, const Choice& choice) {
  if (choice.device_option.empty() || choice.device.empty()) return {};
  const auto known = module.declarations().devices.spellings();
  if (std::ranges::find(known, choice.device) != known.end()) return {};
  const KnownDeviceFiles files = device_files_of(choice);
  if (auto hidden = private_device(choice.device, files.sound, choice.device_option)) return *std::move(hidden);
  if (files.owners_problem) return *files.owners_problem;
  const auto near = nearest_spelling(choice.device, known);
  return Error{
      .code = Code::unknown_device,
      .sentence = fmt::format("nothing declares a device `{}`", choice.device),
      .mend = near ? fmt::format("did you mean `{}`?", *near) : fmt::format("there are: {}", fmt::join(known, ", ")),
      .place = {.name = choice.device_option, .text = choice.device}};
}

void warn_of_owners_file(const std::string& file, const Error& problem) {
  print_error("wale: warning: nothing in {} is used: {}\n", visible_text(file), error_text(problem));
}

void warn_of_device_files(const Choice& choice) {
  if (choice.device_option.empty()) return;
  const KnownDeviceFiles files = device_files_of(choice);
  if (files.owners_problem) warn_of_owners_file(files.owners, *files.owners_problem);
  for (const Error& hidden : hidden_devices(files.sound)) warn(hidden);
}

OrStatus<OpenedFile> open(const Choice& choice) {
  const std::string named = named_material(choice.file).material;
  if (!named.empty() && !choice.material.empty() && named != choice.material)
    return refuse(Error{
        .code = Code::malformed_value,
        .sentence = fmt::format("`{}` names `{}`, but --material names `{}`", choice.file, named, choice.material),
        .mend = "name only one of the two",
        .place = {.text = choice.material}});
  const FileRequest request = choice.recording_request();
  if (choice.file_option.empty()) warn_of_library_variable();  // the first file of a command
  auto opened = open_file(request);
  if (is_searched_for(choice.file)) say_unread(request.roots);
  if (!opened) {
    if (opened.error().code == Code::unknown_name) opened.error().place.name = choice.file_option;
    return refuse(opened.error());
  }
  choice.inputs->push_back(opened->name);
  for (const ResolvedFile& trusted : choice.devices) choice.inputs->push_back(trusted.name);
  if (const auto same = is_as_named(*opened, named.empty() ? choice.material : named, choice); !same)
    return refuse(same.error());
  if (const auto useful = has_use_for_options(*opened, choice); !useful) return refuse(useful.error());
  say_taken(*opened);
  if (!opened->diagnostics.has_errors())
    if (const auto has = has_material(*opened, choice); !has) return refuse(has.error());
  if (opened->module)
    if (const auto has = has_device(*opened->module, choice); !has) return refuse(has.error());
  if (!opened->diagnostics.has_errors()) {
    warn_of_device_files(choice);
    return *std::move(opened);
  }
  print_diagnostics(stderr, opened->diagnostics, opened->sources);
  return refused;
}

std::shared_ptr<const CommonModules> declared_everywhere() {
  std::shared_ptr<const CommonModules> common = common_modules();
  print_diagnostics(stderr, common->problems, SourceSet());
  return common;
}

CheckedModule known_here(const FileRequest& request) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver(request.roots, nullptr, request.sandbox, request.devices);
  CheckedModule module = check_source(sources, sources.add("here", "wale 1\n"), *resolver, diagnostics);
  print_diagnostics(stderr, diagnostics, sources);
  return module;
}

std::shared_ptr<const Declarations> declarations_of(const OpenedFile& opened, const Choice& choice) {
  if (opened.module) return {std::shared_ptr<const Declarations>(), &opened.module->declarations()};
  const auto here = std::make_shared<const CheckedModule>(known_here(choice.request()));
  return {here, &here->declarations()};
}

OrStatus<std::vector<Program>> programs_of(OpenedFile& opened, const Choice& choice, bool all) {
  if (opened.program) return std::vector{*opened.program};
  std::vector<std::string> names{choice.material};
  if (all && choice.material.empty() && opened.module->materials.size() > 1) names = materials_of(opened);
  std::vector<Program> programs;
  for (const auto& name : names) {
    if (opened.diagnostics.has_errors()) break;
    if (auto program = compile_opened(opened, choice.recording_request(), name, opened.diagnostics))
      programs.push_back(*program);
  }
  print_diagnostics(stderr, opened.diagnostics, opened.sources);
  if (opened.diagnostics.has_errors()) return refused;
  return programs;
}

OrStatus<std::vector<Program>> load_programs(const Choice& choice, bool all) {
  auto opened = open(choice);
  if (!opened) return opened.status();
  return programs_of(*opened, choice, all);
}

std::string setting_name(const std::string& setting) {
  const std::string name = setting.substr(0, setting.find('='));
  const auto begin = name.find_first_not_of(" \t");
  return begin == std::string::npos ? "" : name.substr(begin, name.find_last_not_of(" \t") + 1 - begin);
}

Result<std::vector<float>> chosen_parameters(const Program& program, const std::vector<std::string>& settings) {
  auto values = program.default_parameters();
  const std::shared_ptr<const CommonModules> common = common_modules();
  std::vector<std::string> set;
  for (const auto& setting : settings) {
    const auto equals = setting.find('=');
    const std::string name = setting_name(setting);
    if (equals == std::string::npos || name.empty()) return not_a_setting(setting);
    const auto index = program.parameter(name);
    if (!index) return no_parameter(program.description(), name);
    if (std::ranges::find(set, name) != set.end())
      return Error{.code = Code::malformed_value,
                   .sentence = fmt::format("`{}` is set twice", name),
                   .mend = "set it once",
                   .place = {.name = "--set", .text = setting}};
    set.push_back(name);
    const auto read = read_parameter(common->declarations, "--set", program.description().parameters[*index],
                                     setting.substr(equals + 1));
    if (!read) return read.error();
    if (read->unusual) warn(*read->unusual);
    values[*index] = read->value;
  }
  return values;
}

}  // namespace wale::command
