#pragma once

#include <cstddef>
#include <future>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wale/compiled_workspace.hpp"
#include "wale/declared_device.hpp"
#include "wale/devices.hpp"
#include "wale/program.hpp"
#include "wale/result.hpp"
#include "wale/search.hpp"
#include "wale/simulated.hpp"

namespace wale {

/// A simulated person: a hand, and the motions by which it explores by default.
struct SimulatedPerson {
  HandModel hand;
  Lateral lateral;
  Circular circular;
  std::string source;  ///< the source of the figures
};

struct LibraryOptions {
  /// Folders that are searched for materials and imports besides the shipped library, as by `--library`; those of the
  /// environment variable WALE_LIBRARY come after them. Paths count from the folder in which the process is when the
  /// library is made. If one of them is no folder, `folders_exist` and each call that makes or checks a program or a
  /// workspace give `unreadable_file`.
  std::vector<std::string> folders = {};
  /// Whether a stranger's picture may be decoded where the system offers no sandbox for its decoder. Otherwise a
  /// material that needs it is an error there (W0807).
  bool unsandboxed_pictures = false;
  /// The index in which `search`, `nearest` and `between` look, as it stands: a file, or postgresql://USER@HOST/DATABASE,
  /// that `wale library index` makes. Empty: one in the user's cache, which is that of the command line for the same
  /// folders, and which each search by feel brings up to date.
  std::string index = {};
  /// A Wale text that declares the application's own devices, each as `export device NAME { … }`: `CompileOptions::device`
  /// may then name one, for shipped materials and levels too. They come before the owner's of the same names. They scale
  /// no real device (`trusted_devices`): the application's class derived from `Device` serves one. Imports are looked for
  /// in `folders`. An error in it (with `place.name` "devices"), a text that exports no device (`unknown_device`) and a
  /// name that a shipped device has (`declared_twice`) come from `is_usable` and from each call that makes or checks a
  /// program or a workspace, or opens a device. Figures that no program runs with are `value_out_of_range`; a device that
  /// is called as another spelling of `open_device` ("auto") is `declared_twice`.
  std::string devices = {};
};

/// How a text becomes a program.
struct CompileOptions {
  /// The device that the program is for, by the name of its profile; empty: `default_device`, and of a patch program
  /// the one that it is built for.
  std::string device = {};
  /// One of the materials of a text that has several; empty: the one that was named, or else the first.
  std::string material = {};
  /// Of a text in memory: the name that errors and warnings show. Its imports and pictures are looked for beside a file
  /// of that name, which need not exist. One line of UTF-8, or empty.
  std::string name = "text";
};

/// A program, and what is worth knowing about its text.
struct Compiled {
  Program program;
  std::vector<Error> warnings = {};  ///< in the order of their places; `severity_of` their codes is `warning`
  /// If the name could have meant another material too, a sentence that says which one was taken; mostly empty.
  std::string taken = {};
};

/// Materials and levels by name, compiled for a device. The answers are those of the command line.
///
/// The shipped materials and calibrations are in the binary: no file is needed for them. The owner's devices
/// (~/.config/wale/devices.wale) are read once, by the constructor.
///
/// All calls but constructor and destructor are safe from any thread, also at the same time; none is for a real-time
/// thread. They take from a millisecond to a second, and the calling thread needs a stack of 8 MB. Each call whose name
/// ends in `_later` returns at once; a thread of the library's own, begun with the first such call, then does the work,
/// one after the other in the order of the calls. What is returned is independent of the library.
///
/// Errors in a text have its place: `place.name` is the file, `place.number` the line, `place.column` the column,
/// `place.text` the line's text; `expected`, `found` and `mend` are the diagnostic's. It is the first error; `others`
/// has the further errors and warnings. Errors about an argument have the argument's name as `place.name` ("name",
/// "percept", "level", "device", "material") and its value as `place.text`. For an unknown name `nearest` has up to
/// three that may have been meant. All calls: `unknown_device` for a device that nothing declares (if the owner's file has
/// an error, it is among the `others`); `invalid_encoding`
/// for a name that is not UTF-8 or holds a zero byte; `malformed_value` for one that is empty, blank or of several
/// lines.
///
/// In a child of `fork` the library may be used, and its destructor does not wait for work of the parent. The child's
/// own work is done by a thread of its own; a future that the parent began is the parent's, and in the child never ready.
class Library {
 public:
  explicit Library(const LibraryOptions& options = {});
  /// Waits for the work that is under way, at most. What was not begun then ends with `wrong_moment`.
  ~Library();
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  /// Error: `unreadable_file` about the first of `LibraryOptions::folders`, then of WALE_LIBRARY, that is no folder.
  /// `place.name` is "folders" or "WALE_LIBRARY".
  Result<> folders_exist() const;
  /// Whether the options can be used. Errors: those of `folders_exist`, and the first one of `LibraryOptions::devices`.
  /// An index is looked at by the first search.
  Result<> is_usable() const;

  /// A material by its name ("corduroy"), title, other name, kind or module ("fabric.denim"), or MODULE:MATERIAL, by
  /// the rule of the command line: of the project in the process's current folder, of `LibraryOptions::folders`, or of
  /// the shipped library. Never a file of that name. Errors: `unknown_name`; `ambiguous_material` if several materials
  /// have that name; `malformed_value` for a text that is no name; `unknown_material` for an `options.material`, and for
  /// a MATERIAL that the module does not have.
  Result<Compiled> find(const std::string& name, const CompileOptions& options = {}) const;

  /// A surface with a level of a percept: a named level ("coarse") or a number from 0 to 1 ("0.6"). Errors:
  /// `unknown_name` for an unknown percept or level; `level_out_of_range` for a number outside 0 .. 1;
  /// `malformed_value` for a level that is neither a name nor a number as Wale writes them (0.5, 5e-1);
  /// `percept_unrealised` for a percept that the device cannot render; `unknown_material` for any `options.material`.
  Result<Compiled> level(const std::string& percept, const std::string& level,
                         const CompileOptions& options = {}) const;

  /// Compiles a Wale text. Errors: those in it, as `invalid_encoding` and `too_long` (4 MiB); `unknown_material`.
  Result<Compiled> compile(std::string_view text, const CompileOptions& options = {}) const;

  /// A Wale file (.wale) or a patch program (.wpp). Errors: `unreadable_file` for a file that is missing, a folder or
  /// no regular file; `damaged_file` for other binary data; those of `compile` (of any text) and `Program::load`;
  /// `other_device` for a patch program that is built for another device than `options.device`.
  Result<Compiled> open(const std::string& path, const CompileOptions& options = {}) const;
  /// The same for the bytes of such a file; which of the two they are is seen by how they begin.
  Result<Compiled> open(std::span<const std::byte> bytes, const CompileOptions& options = {}) const;

  /// A workspace of a Wale text with the programs, places and shapes of its patches. A patch whose material has an error
  /// is the error. Errors: those in the text; `unknown_workspace`. It takes the time of each different material.
  Result<CompiledWorkspace> workspace(std::string_view text, const WorkspaceOptions& options = {}) const;
  /// The same of a Wale file (.wale), or a workspace file (.wws). Errors also: `unreadable_file`, `damaged_file`,
  /// `newer_file`, and `other_device` for a workspace file that is built for another device.
  Result<CompiledWorkspace> open_workspace(const std::string& path, const WorkspaceOptions& options = {}) const;
  /// The workspaces of a Wale text by name, and its movies, keys and groups, checked. `name` is as in `CompileOptions`.
  /// Error: the first one in the text.
  Result<Presentation> presentation(std::string_view text, const std::string& name = "text") const;

  /// As the calls without `_later`, on the library's own thread. Arguments are copied. Error besides: `short_of_resources` if the system
  /// gives no thread.
  std::future<Result<Compiled>> find_later(std::string name, CompileOptions options = {}) const;
  std::future<Result<Compiled>> level_later(std::string percept, std::string level, CompileOptions options = {}) const;
  std::future<Result<Compiled>> compile_later(std::string text, CompileOptions options = {}) const;
  std::future<Result<Compiled>> open_later(std::string path, CompileOptions options = {}) const;
  std::future<Result<Compiled>> open_later(std::vector<std::byte> bytes, CompileOptions options = {}) const;

  /// Materials by words, by how they feel, or both, as `wale find`; a blank text means any. By feel, the first search of
  /// a library reads all of it and keeps that in an index, which takes from seconds to minutes (`SearchOptions::progress`);
  /// later ones read what has changed. A destructor ends such reading. Searches by feel wait for each other. Errors:
  /// `unknown_name` for an unknown kind, percept, or material in `near`, `ambiguous_material` for one that may be several;
  /// those in its text; `unknown_material` for one that pushes nothing; `level_out_of_range`; `malformed_value`; `stopped` if `progress` ended
  /// it; `other_device` if the named index is for another device than `options.device`; for an index that was named,
  /// `unreadable_file`, `damaged_file`, `newer_file`, and `missing_library` in a Wale that was built without its database.
  Result<SearchResult> search(const std::string& text, const SearchOptions& options = {}) const;
  /// Those that feel most like a material, as `wale find --near`; it is not among them. Errors: those of `search`.
  Result<SearchResult> nearest(const std::string& material, const SearchOptions& options = {}) const;
  /// Those that are nearer to each of two materials than these are to each other, as `wale between`. Errors: those of
  /// `search`.
  Result<SearchResult> between(const std::string& one, const std::string& other, const SearchOptions& options = {}) const;
  /// As the calls without `_later`, on the library's own thread.
  std::future<Result<SearchResult>> search_later(std::string text, SearchOptions options = {}) const;
  std::future<Result<SearchResult>> nearest_later(std::string material, SearchOptions options = {}) const;
  std::future<Result<SearchResult>> between_later(std::string one, std::string other, SearchOptions options = {}) const;

  /// The devices that Wale ships, those of `LibraryOptions::devices`, and those of the owner.
  std::vector<DeclaredDevice> devices() const;
  /// Errors: `unknown_name`; those of a text that is no name.
  Result<SimulatedPerson> person(const std::string& name = "normal") const;

  /// The declarations that scale a real device on this computer: those of its owner's file and the shipped ones. Error:
  /// the first one in that file.
  Result<TrustedDevices> trusted_devices() const;
  /// As `wale::open_device`, with these declarations; the devices of `LibraryOptions::devices` are simulated by name. A
  /// simulated device is in the hand of a simulated person who rubs to and fro, unless the options have another hand
  /// (which then rests) or another motion. Errors also: those of `trusted_devices` and of `is_usable`.
  Result<std::unique_ptr<Device>> open_device(std::string_view spelling = "auto", OpenOptions options = {}) const;

  /// The Sandpaper joystick, simulated, in the hand of a simulated person who rubs to and fro.
  std::unique_ptr<SimulatedJoystick> simulated_joystick() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace wale
