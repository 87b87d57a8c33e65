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

/// The verbs of the command line: they read files, print, and return an exit status. Only `wale.cpp` calls them.
namespace wale::command {

inline constexpr int done = 0;
/// The command cannot be carried out; the reason has been printed.
inline constexpr int refused = 1;
/// The command line makes no sense.
inline constexpr int misused = 2;

/// Prints the reason on standard error and returns `refused`.
int refuse(const std::string& reason);
/// The same, but returns `misused` if the value of an option cannot be read or names something unknown.
int refuse(const Error& error);

/// Prints a warning on standard error.
void warn(const Error& warning);

/// "error[W0801]: --steps: expected …" with the mend on a line of its own, without a newline at the end.
std::string error_text(const Error& error);

/// Prints diagnostics with their source lines, in colour on a terminal.
void print_diagnostics(std::FILE* stream, const Diagnostics& diagnostics, const SourceSet& sources);

/// The choice of a material on the command line: a Wale file, a patch program, or a material by name.
struct Choice {
  std::string file, material, device = default_device;
  std::string device_option;          ///< "--device" if that option named the device; empty for the default device
  std::vector<std::string> folders;   ///< folders to search for imports
  std::vector<ResolvedFile> devices;  ///< files with trusted devices, which every file knows
  /// All files that were read for it, and for its copies.
  std::shared_ptr<InputFiles> inputs = std::make_shared<InputFiles>();
  Sandbox sandbox = Sandbox::required;  ///< of the decoder of its pictures

  /// Includes the owner's devices.wale if the device is not a shipped one.
  FileRequest request() const;
  /// The same; what is read for it becomes one of the `inputs`. For one thread at a time.
  FileRequest recording_request() const;
};

/// If a name may mean two materials, prints on standard error which of them was taken.
void say_taken(const OpenedFile& opened);

/// Checks that a patch program holds `material` and is built for the device of `choice`, if these are named. Wale files
/// always pass. Errors: W0602 for another material, W0607 for another device.
Result<> is_as_named(const OpenedFile& opened, const std::string& material, const Choice& choice);

/// Ends the command with `misused` if the device that an option named is not declared where the file can see it.
void need_device(const OpenedFile& opened, const Choice& choice);

/// Opens a file; nothing if it cannot be read or has errors, which are printed.
std::optional<OpenedFile> open(const Choice& choice);

/// The declarations that every file knows, for verbs without a file. Errors in them, which mean a broken build, are
/// printed.
std::shared_ptr<const CommonModules> declared_everywhere();

/// The programs of an opened file: that of one material, or of all. Empty after errors, which are printed.
std::vector<Program> programs_of(OpenedFile& opened, const Choice& choice, bool all);
std::vector<Program> load_programs(const Choice& choice, bool all);

/// The program's parameters with `--set NAME=VALUE` applied. Errors: W0801 for a malformed setting and for a parameter
/// that is set twice, W0206 for an unknown parameter, and those of `read_parameter`.
Result<std::vector<float>> chosen_parameters(const Program& program, const std::vector<std::string>& settings);

}  // namespace wale::command
