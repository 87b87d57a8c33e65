#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compiler/describe/level_intervals.hpp"
#include "compiler/modules/library_index.hpp"
#include "compiler/open_file.hpp"
#include "compiler/read/cues.hpp"
#include "wale/patch_program.hpp"
#include "wale/program.hpp"
#include "wale/result.hpp"

namespace wale {

/// A name by which people look for a material.
struct EntryName {
  std::string language;  ///< as `called de "Cord"` has it: "de"; "en" for names without a language
  std::string text;      ///< as written

  friend bool operator==(const EntryName&, const EntryName&) = default;
};

/// One percept of a material: what its author asks for, what the finished program reads, and on what evidence. Levels
/// are 0 .. 1.
struct EntryPercept {
  std::string name;                 ///< "roughness"
  std::optional<double> asked;      ///< nothing if the author did not ask for it
  std::optional<Evidence> claimed;  ///< how well the author knows that level; nothing if not stated
  std::optional<double> reads;      ///< nothing if no map tells it: `outside` says why, or it is lost on the device
  bool lost = false;                ///< the device gives nothing of it
  bool saturated = false;           ///< the device gives less than it needs

  std::string carrier;  ///< "lateral amplitude"
  double size = 0;      ///< of the carrier, in `unit`
  std::string unit;     ///< SI: "N", "N s/m"

  LevelBounds means{};                ///< where 95 % of the means of other groups lie, if `reads`
  bool means_differ_more = false;     ///< they differ more than that, by an amount that is not known
  std::optional<LevelBounds> people;  ///< where 95 % of single judgements lie; nothing if that is not known

  Evidence slope = Evidence::estimated, anchor = Evidence::estimated, handle = Evidence::estimated;
  std::optional<Evidence> domain;    ///< nothing if the map does not state its stimuli
  std::vector<std::string> outside;  ///< what was not measured: "period 14 mm, measured to 10"
  std::string map, device, source;   ///< the map, the device it was measured on, the citation; empty if it is lost

  /// The worst of slope, anchor, handle and domain.
  Evidence evidence() const;

  friend bool operator==(const EntryPercept&, const EntryPercept&) = default;
};

/// What a hand feels of a program, read from its forces.
struct EntryFeel {
  std::vector<EntryPercept> percepts;  ///< those asked for, in the order written, then the others that it has
  std::optional<Cues> cues;            ///< nothing of a program for a device that only vibrates

  /// The percept of that name; null if it has none.
  const EntryPercept* percept(const std::string& name) const;
};

/// Everything that the index and the site know of one material, on one device.
struct Entry {
  std::string name;           ///< "corduroy"
  std::string module;         ///< the file that declares it, as an import names it: "fabric.corduroy"
  std::string file;           ///< its path, as it was given to the reader
  std::string folder;         ///< the first part of its kind, or else of its module: "fabric"; may be empty
  std::string kind;           ///< "fabric.woven"; may be empty
  std::string title;          ///< may be empty
  std::string documentation;  ///< the text of the `///` comment above it; may be empty
  std::vector<EntryName> names;       ///< its other names, in all languages, in the order written; without `name`
  std::vector<std::string> feels;     ///< comparisons: "like ball bearings"
  std::vector<std::string> asks;      ///< the percepts that it asks for, by the names that its author uses
  std::vector<std::string> replaces;  ///< names of materials that this one supersedes
  std::vector<std::string> sources;   ///< where its figures come from
  std::string licence;                ///< as SPDX names it, its own or its library's; empty without one

  std::string device;                 ///< for which the program was built
  EntryFeel felt;                          ///< empty without a program
  std::vector<Parameter> parameters;  ///< of the program, its defaults among them; values in SI units
  std::vector<std::byte> program;     ///< the bytes of the `.wpp` file; empty if the material has an error
  std::string trouble;                ///< its first error, in a line; empty if there is a program

  /// SHA-256, in 64 hexadecimal digits, of all that the material rests on: its name, its file, the files that it imports
  /// and the pictures that it reads, its device, and this build of the compiler with all maps and devices in it. Equal
  /// contents mean equal entries but for `file` and `module`.
  std::string content;
};

/// Reads a program; `felt_of`, or one that remembers what equal programs read.
using Feel = std::function<EntryFeel(const Program& program, const Declarations& declarations)>;

/// Reads a program at its defaults. Takes tens of milliseconds. Thread-safe.
EntryFeel felt_of(const Program& program, const Declarations& declarations);

/// What the text of a material says; nothing is compiled, so device, percepts, program and content are empty.
Entry entry_of(const IndexedMaterial& material);

class KeptReadings;

/// The entries of one file.
struct FileEntries {
  std::vector<Entry> entries;   ///< of each material that its text declares, in the order written
  OpenedFile opened;            ///< with the diagnostics of the file and of all its materials
  /// The first error of a text in which no material can be read at all, so that no entry tells of it.
  std::optional<Error> unparsed;
  /// All paths that were looked for, found or not, each once, in order: another content of one of them may be another
  /// entry.
  std::vector<std::string> looked_for;
  /// It names materials that it does not import, so other materials of the library may change what it means.
  bool uses_names = false;
};

/// Compiles and reads all materials of the Wale file `request.file`, for `request.device`. `module` is the name by which
/// imports find it, "fabric.denim". A material with an error has an entry too, which says so. Errors: those of
/// `open_file`, and W0506 for a patch program. What was measured of equal programs is taken from `kept`, if it is not null.
/// Thread-safe.
Result<FileEntries> read_entries(const FileRequest& request, const std::string& module, const Feel& feel = felt_of,
                                 KeptReadings* kept = nullptr);

}  // namespace wale
