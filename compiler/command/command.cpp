#include "compiler/command/command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>

#include "compiler/diagnostics/render.hpp"
#include "compiler/modules/library_folders.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/quantity.hpp"
#include "compiler/typed_number.hpp"

namespace wale::command {
namespace {

/// Carets in colour where a person reads them.
bool colour(FILE* stream) { return isatty(fileno(stream)) && !std::getenv("NO_COLOR"); }

Error not_a_setting(const std::string& text) {
  return {.code = Code::malformed_value,
          .sentence = fmt::format("expected NAME=VALUE, {}", found_typed(text)),
          .mend = "for example, `--set wale=5mm`",
          .place = {.name = "--set", .text = text}};
}

Error no_parameter(const PatchProgram& program, const std::string& name) {
  std::vector<std::string> known;
  for (const auto& parameter : program.parameters) known.push_back(parameter.name);
  return {.code = Code::unknown_setting,
          .sentence = fmt::format("`{}` has no parameter `{}`", program.material, name),
          .mend = known.empty() ? "it has no parameters" : fmt::format("its parameters: {}", fmt::join(known, ", ")),
          .place = {.name = "--set", .text = name}};
}

}  // namespace

int refuse(const std::string& reason) {
  fmt::print(stderr, "wale: {}{}", reason, reason.ends_with('\n') ? "" : "\n");
  return refused;
}

int refuse(const Error& error) { return refuse(error_text(error)); }

void warn(const Error& warning) { fmt::print(stderr, "wale: {}\n", error_text(warning)); }

std::string error_text(const Error& error) {
  const Place& place = error.place;
  std::string text = severity_of(error.code) == Severity::error ? "error" : "warning";
  text += fmt::format("[{}]: {}{}", code_name(error.code), place.name,
                      place.number ? fmt::format("{}{}", place.name.empty() ? "" : ":", *place.number) : "");
  if (!place.name.empty() || place.number) text += ": ";
  text += error.sentence;
  if (!place.source.empty()) text += fmt::format(" (from {})", place.source);
  for (const Place& before : error.led_to)
    text += fmt::format("\n  after {} {} {}", before.name, before.number ? std::to_string(*before.number) : "",
                        before.text);
  if (!error.mend.empty()) text += "\n  = help: " + error.mend;
  return text;
}

void print_diagnostics(std::FILE* stream, const Diagnostics& diagnostics, const SourceSet& sources) {
  for (const auto& diagnostic : diagnostics.all())
    fmt::print(stream, "{}\n", render_text(diagnostic, sources, colour(stream)));
}

Result<> write_file(const std::string& path, std::string_view bytes) {
  if (path == "-") {
    std::cout.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush();
    if (std::cout) return {};
    return Error{.code = Code::unwritable_file, .sentence = "cannot write to standard output"};
  }
  std::ofstream file(path, std::ios::binary);
  if (file) file.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush();
  if (file) return {};
  return Error{.code = Code::unwritable_file,
               .sentence = fmt::format("cannot write this file: {}", std::strerror(errno)),
               .place = {.name = path}};
}

FileRequest Choice::request() const { return {file, device, library_folders(folders, std::getenv("WALE_LIBRARY"))}; }

void say_also(const OpenedFile& opened) {
  if (!opened.also.empty())
    fmt::print(stderr, "wale: `{}` is a file here; the material of that name is `{}`\n", opened.name, opened.also);
}

std::optional<OpenedFile> open(const Choice& choice) {
  auto opened = open_file(choice.request());
  if (!opened) return refuse(opened.error()), std::nullopt;
  say_also(*opened);
  if (!opened->diagnostics.has_errors()) return *std::move(opened);
  print_diagnostics(stderr, opened->diagnostics, opened->sources);
  return std::nullopt;
}

std::shared_ptr<const CommonModules> declared_everywhere() {
  std::shared_ptr<const CommonModules> common = common_modules();
  print_diagnostics(stderr, common->problems, SourceSet());
  return common;
}

std::vector<Program> programs_of(OpenedFile& opened, const Choice& choice, bool all) {
  if (opened.program) return {*opened.program};
  std::vector<std::string> names{choice.material};
  if (all && choice.material.empty() && opened.module->materials.size() > 1) names = materials_of(opened);
  std::vector<Program> programs;
  for (const auto& name : names) {
    if (opened.diagnostics.has_errors()) break;
    if (auto program = compile_opened(opened, choice.request(), name, opened.diagnostics)) programs.push_back(*program);
  }
  print_diagnostics(stderr, opened.diagnostics, opened.sources);
  if (opened.diagnostics.has_errors()) programs.clear();
  return programs;
}

std::vector<Program> load_programs(const Choice& choice, bool all) {
  auto opened = open(choice);
  return opened ? programs_of(*opened, choice, all) : std::vector<Program>{};
}

std::optional<std::vector<float>> chosen_parameters(const Program& program, const std::vector<std::string>& settings) {
  auto values = program.default_parameters();
  const std::shared_ptr<const CommonModules> common = common_modules();
  for (const auto& setting : settings) {
    const auto equals = setting.find('=');
    const std::string name = setting.substr(0, equals);
    const auto index = program.parameter(name);
    if (equals == std::string::npos || !index) {
      refuse(equals == std::string::npos ? not_a_setting(setting) : no_parameter(program.description(), name));
      return std::nullopt;
    }
    const auto read = read_parameter(common->declarations, "--set", program.description().parameters[*index],
                                     setting.substr(equals + 1));
    if (!read) return refuse(read.error()), std::nullopt;
    if (read->unusual) warn(*read->unusual);
    values[*index] = read->value;
  }
  return values;
}

}  // namespace wale::command
