#pragma once

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/open_file.hpp"
#include "compiler/text/output_file.hpp"
#include "wale/result.hpp"

/// The verbs of the command line: they read files, print, and return an exit status. Only `wale.cpp` calls them.
namespace wale::command {

inline constexpr int done = 0;
/// The command cannot be carried out; the reason has been printed.
inline constexpr int refused = 1;
/// The command line makes no sense.
inline constexpr int misused = 2;
/// There is an error in Wale itself.
inline constexpr int failed = 3;

/// Prints the reason on standard error and returns `refused`.
int refuse(const std::string& reason);
/// The same, but returns `misused` if the words of the command make no sense: every W0801, and an option that names
/// something unknown or another device than the program's.
int refuse(const Error& error);

/// Prints a warning on standard error.
void warn(const Error& warning);

/// "error[W0801]: --steps: expected …" with the mend on a line of its own, without a newline at the end. Texts of
/// others in it are visible, and forge no line.
std::string error_text(const Error& error);

/// Prints diagnostics with their source lines, in colour on a terminal.
void print_diagnostics(std::FILE* stream, const Diagnostics& diagnostics, const SourceSet& sources);

/// The choice of a material on the command line: a Wale file, a patch program, or a material by name.
struct Choice {
  std::string file, material, device = default_device;
  std::string device_option;          ///< "--device" if that option named the device; empty for the default device
  std::string material_option;        ///< "--material" if that option named the material
  std::string file_option;            ///< "--against" if that option named the file; empty for an argument
  std::vector<std::string> folders;   ///< folders to search for imports
  std::vector<ResolvedFile> devices;  ///< files of `--devices`, whose devices every file knows
  bool knows_owners = true;           ///< every file knows also the devices of the owner's devices.wale
  bool shares_options = false;        ///< what is said of imports and pictures is said of another file as well
  /// All files that were read for it, and for its copies.
  std::shared_ptr<InputFiles> inputs = std::make_shared<InputFiles>();
  Sandbox sandbox = Sandbox::required;  ///< of the decoder of its pictures

  /// Includes the owner's devices.wale if that is to be known, has no error, and the device is not a shipped one.
  FileRequest request() const;
  /// The same; what is read for it becomes one of the `inputs`. For one thread at a time.
  FileRequest recording_request() const;
};

/// If a name may mean two materials, prints on standard error which of them was taken.
void say_taken(const OpenedFile& opened);

/// Checks that a patch program holds `material` and is built for the device of `choice`, if these are named. Wale files
/// always pass. Errors: W0602 for another material, W0607 for another device.
Result<> is_as_named(const OpenedFile& opened, const std::string& material, const Choice& choice);

/// Checks that a Wale file has the material that an option named. Error: W0602.
Result<> has_material(const OpenedFile& opened, const Choice& choice);

/// Checks that no option about imports, pictures or declarations came with a patch program, which has none of them.
/// Error: W0801.
Result<> has_use_for_options(const OpenedFile& opened, const Choice& choice);

/// Warns of what WALE_LIBRARY names and is no folder. Called once by a verb that imports.
void warn_of_library_variable();

/// Warns of the folders that the search for materials could not read.
void say_unread(const std::vector<std::string>& roots);

/// Checks that a device which an option named is declared where a file can see it. Errors: W0601; W0215 if a file of
/// devices keeps it to itself; the first error in the owner's devices.wale, which might have declared it.
Result<> has_device(const CheckedModule& module, const Choice& choice);

/// Warns that the owner's file of devices has an error, and that nothing in it is used.
void warn_of_owners_file(const std::string& file, const Error& problem);

/// If an option named a device: warns of an error in the owner's devices.wale, and of devices in the files of `choice`
/// that have the name of an earlier one. Called once by a verb, when `has_device` has found the device.
void warn_of_device_files(const Choice& choice);

/// A value; or, after an error that has been printed, the exit status of the command, which has nothing more to do.
///
///     auto opened = open(choice);
///     if (!opened) return opened.status();
template <class Value>
class [[nodiscard]] OrStatus {
 public:
  OrStatus(Value value) : value_(std::move(value)) {}
  OrStatus(int status) : status_(status) {}

  explicit operator bool() const noexcept { return value_.has_value(); }
  /// The value. Call these only if there is one.
  Value& operator*() & { return *value_; }
  const Value& operator*() const& { return *value_; }
  Value&& operator*() && { return *std::move(value_); }
  Value* operator->() { return &*value_; }
  const Value* operator->() const { return &*value_; }

  /// `refused` or `misused`. Call it only if there is no value.
  int status() const noexcept { return status_; }

 private:
  std::optional<Value> value_;
  int status_ = done;
};

/// Opens a file. A file that has errors or lacks the device is not opened.
OrStatus<OpenedFile> open(const Choice& choice);

/// The declarations that every file knows, for verbs without a file. Errors in them, which mean a broken build, are
/// printed.
std::shared_ptr<const CommonModules> declared_everywhere();

/// What an opened file knows: the percepts, maps and devices that it and its imports declare, besides those that every
/// file knows and the devices of `--devices`. A patch program has none of its own. `opened` must outlive it.
std::shared_ptr<const Declarations> declarations_of(const OpenedFile& opened, const Choice& choice);

/// What a file in the current folder knows without an import: what every file knows, and the devices of the request.
/// Errors in these are printed.
CheckedModule known_here(const FileRequest& request);

/// The programs of an opened file, at least one: that of one material, or of all.
OrStatus<std::vector<Program>> programs_of(OpenedFile& opened, const Choice& choice, bool all);
OrStatus<std::vector<Program>> load_programs(const Choice& choice, bool all);

/// The name in `--set NAME=VALUE`, without the spaces round it.
std::string setting_name(const std::string& setting);

/// The program's parameters with `--set NAME=VALUE` applied. Errors: W0801 for a malformed setting and for a parameter
/// that is set twice, W0206 for an unknown parameter, and those of `read_parameter`.
Result<std::vector<float>> chosen_parameters(const Program& program, const std::vector<std::string>& settings);

}  // namespace wale::command
