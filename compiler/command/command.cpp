#include "compiler/command/command.hpp"

#include <fmt/format.h>
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

namespace wale::command {
namespace {

/// Carets in colour where a person reads them.
bool colour(FILE* stream) { return isatty(fileno(stream)) && !std::getenv("NO_COLOR"); }

}  // namespace

int refuse(const std::string& reason) {
  fmt::print(stderr, "wale: {}{}", reason, reason.ends_with('\n') ? "" : "\n");
  return refused;
}

int refuse(const Error& error) {
  return refuse(error.mend.empty() ? error.sentence : fmt::format("{}; {}", error.sentence, error.mend));
}

void print_diagnostics(std::FILE* stream, const Diagnostics& diagnostics, const SourceSet& sources) {
  for (const auto& diagnostic : diagnostics.all())
    fmt::print(stream, "{}\n", render_text(diagnostic, sources, colour(stream)));
}

std::optional<std::string> write_file(const std::string& path, std::string_view bytes) {
  if (path == "-") {
    std::cout.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush();
    return std::cout ? std::nullopt : std::optional<std::string>("cannot write to standard output");
  }
  std::ofstream file(path, std::ios::binary);
  if (file) file.write(bytes.data(), static_cast<std::streamsize>(bytes.size())).flush();
  if (!file) return fmt::format("cannot write `{}`: {}", path, std::strerror(errno));
  return std::nullopt;
}

FileRequest Choice::request() const { return {file, device, library_folders(folders, std::getenv("WALE_LIBRARY"))}; }

std::optional<OpenedFile> open(const Choice& choice) {
  OpenedFile opened = open_file(choice.request());
  if (!opened.refusal.empty()) return refuse(opened.refusal), std::nullopt;
  if (!opened.diagnostics.has_errors()) return opened;
  print_diagnostics(stderr, opened.diagnostics, opened.sources);
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
  QuantityReader reader;
  for (const auto& setting : settings) {
    const auto equals = setting.find('=');
    const std::string name = setting.substr(0, equals);
    const auto index = program.parameter(name);
    if (equals == std::string::npos || !index) {
      std::string known;
      for (const auto& parameter : program.description().parameters)
        known += (known.empty() ? "" : ", ") + parameter.name;
      refuse(equals == std::string::npos
                 ? fmt::format("--set takes NAME=VALUE, not `{}`", setting)
                 : fmt::format("`{}` has no parameter `{}`; it has: {}", program.description().material, name,
                               known.empty() ? "none" : known));
      return std::nullopt;
    }
    const auto value =
        reader.parameter("--set " + name, program.description().parameters[*index], setting.substr(equals + 1));
    if (!value) {
      print_diagnostics(stderr, reader.diagnostics(), reader.sources());
      return std::nullopt;
    }
    values[*index] = *value;
  }
  print_diagnostics(stderr, reader.diagnostics(), reader.sources());  // warnings
  return values;
}

}  // namespace wale::command
