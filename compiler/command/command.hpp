#pragma once

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/open_file.hpp"
#include "compiler/text/output_file.hpp"
#include "schema/result.hpp"

/// What a person's command does: the verbs of the command line, which read files, print, and give an exit status. They
/// are called by `wale.cpp`, which knows the words; nothing else calls them.
namespace wale::command {

inline constexpr int done = 0;
/// What was asked cannot be done: already said why.
inline constexpr int refused = 1;
/// The words of the command make no sense.
inline constexpr int misused = 2;

/// Says why on standard error; `refused`.
int refuse(const std::string& reason);
/// The same; `misused` where the value of an option cannot be read.
int refuse(const Error& error);

/// Says a warning on standard error.
void warn(const Error& warning);

/// "error[W0801]: --steps: expected …" and the mend in a line of its own, without a newline at the end.
std::string error_text(const Error& error);

/// With carets in colour where a person reads them.
void print_diagnostics(std::FILE* stream, const Diagnostics& diagnostics, const SourceSet& sources);

/// What was named on the command line: a Wale file to compile, a patch program to load, or a material by name.
struct Choice {
  std::string file, material, device = default_device;
  std::string device_option;  ///< "--device" where that option named the device; empty: it is the default
  std::vector<std::string> folders;  ///< in which imports are looked for
  /// All files that were read for it, and for its copies.
  std::shared_ptr<InputFiles> inputs = std::make_shared<InputFiles>();

  FileRequest request() const;
};

/// Says on standard error how to name the material that has the same name as a file; mostly there is none.
void say_also(const OpenedFile& opened);

/// Whether a patch program is the material `material` and built for the device of `choice`, where they are named; any
/// Wale file passes. Errors: W0202 for another material, W0607 for another device.
Result<> is_as_named(const OpenedFile& opened, const std::string& material, const Choice& choice);

/// Opens a file; nothing when it cannot be read or its text is wrong, which has been said.
std::optional<OpenedFile> open(const Choice& choice);

/// What every file knows, for those that need it without a file. What is wrong with it is said: this build is broken.
std::shared_ptr<const CommonModules> declared_everywhere();

/// The programs of an opened file: one, or all of its materials; what is wrong has been printed when there is none.
std::vector<Program> programs_of(OpenedFile& opened, const Choice& choice, bool all);
std::vector<Program> load_programs(const Choice& choice, bool all);

/// The program's parameters with `--set NAME=VALUE` applied. Errors: W0801 for a text that is no setting and for a
/// parameter that is set twice, W0206 for an unknown parameter, those of `read_parameter`.
Result<std::vector<float>> chosen_parameters(const Program& program, const std::vector<std::string>& settings);

}  // namespace wale::command
