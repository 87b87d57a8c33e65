#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/declarations/dimension.hpp"
#include "compiler/declarations/percepts.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/graph/term.hpp"
#include "compiler/parse/syntax_tree.hpp"
#include "wale/declared_device.hpp"
#include "wale/device_wiring.hpp"
#include "wale/patch_program.hpp"

namespace wale {

struct Declarations;

/// A declaration's syntax: its expressions are in `tree` and use the names of `home`.
template <typename Node>
struct Declared {
  const SyntaxTree* tree = nullptr;
  const Node* node = nullptr;
  const Declarations* home = nullptr;
};

/// The names of one kind that a file may use: its own and imported ones, and below them those that every file knows.
template <typename T>
class Names {
 public:
  struct Entry {
    T what;
    Span declared;          ///< the name in its declaration
    bool exported = false;  ///< importing files may use it
    bool imported = false;  ///< it comes from an import
  };

  Names() = default;
  Names(const Names&) = delete;
  Names& operator=(const Names&) = delete;

  /// Sets the names that are looked up next if a name is not found here.
  void stand_on(const Names& common) { common_ = &common; }

  const Entry* entry(std::string_view name) const {
    for (const Names* names = this; names; names = names->common_)
      if (const auto found = names->index_.find(name); found != names->index_.end()) return found->second;
    return nullptr;
  }
  const T* find(std::string_view name) const {
    const Entry* found = entry(name);
    return found ? &found->what : nullptr;
  }
  bool contains(std::string_view name) const { return entry(name) != nullptr; }

  /// Adds a name, which must be new.
  void add(std::string_view name, Entry entry) {
    const auto [added, is_new] = own_.emplace(name, std::move(entry));
    if (is_new) index_.emplace(added->first, &added->second);
  }

  /// The names that the file itself declares or imports.
  const std::map<std::string, Entry>& own() const { return own_; }

  /// Visits all names, those that every file knows first.
  template <typename Visit>
  void each(const Visit& visit) const {
    if (common_) common_->each(visit);
    for (const auto& [name, entry] : own_) visit(name, entry.what);
  }
  std::vector<std::string> spellings() const {
    std::vector<std::string> all;
    each([&](const std::string& name, const T&) { all.push_back(name); });
    return all;
  }

 private:
  std::map<std::string, Entry> own_;
  std::unordered_map<std::string_view, const Entry*>
      index_;  ///< into `own_`; a hash table, since every word of a file is looked up
  const Names* common_ = nullptr;
};

/// The default bounds of states of a dimension, from its declaration.
struct DimensionBounds {
  const SyntaxTree* tree = nullptr;
  std::optional<Range> range;
};

struct Unit {
  double factor = 1;  ///< size in SI
  Dimension dimension;
};

/// A device, with the parts of its declaration that only the compiler needs.
struct DeviceDeclaration : DeclaredDevice {
  std::string documentation;
  std::map<std::string, Realisation> realise;  ///< by percept: the device's own, and those of its class for the others
  Span span;
};

/// Named levels of one percept, in the order written.
struct Levels {
  struct Level {
    std::string name;
    double value;
    Span span;
  };
  std::string percept;
  std::vector<Level> levels;
  Span span;
  bool exported = false;
};

/// A simulated hand and how it explores; SI units.
struct HandDeclaration {
  std::string name;
  double mass = 0, damping = 0, stiffness = 0;
  double lateral_amplitude = 0, lateral_frequency = 0;
  double circular_radius = 0, circular_frequency = 0;
  double press_depth = 0, press_frequency = 0;
  double fewest_counts = 0, faithful_counts = 0;  ///< encoder counts per period
  double fewest_levels = 0;                       ///< command steps in the largest force
  std::string source;
  Span span;
};

/// The names of dimensions and units in one compilation: those that every file knows. They are copied when a file
/// declares its own.
class SharedNames {
 public:
  SharedNames() = default;
  /// `beneath` must outlive it.
  explicit SharedNames(const DimensionNames& beneath) : known_(&beneath) {}
  SharedNames(const SharedNames&) = delete;
  SharedNames& operator=(const SharedNames&) = delete;

  const DimensionNames& known() const { return *known_; }
  /// The names to add to.
  DimensionNames& own() {
    if (known_ != &own_) own_ = *known_;
    known_ = &own_;
    return own_;
  }

 private:
  DimensionNames own_;
  const DimensionNames* known_ = &own_;
};

/// Everything that one file may refer to by name. The embedded declarations, which every file knows, are in `common`.
struct Declarations {
  /// Shared by the whole compilation, so that a base dimension has the same index in every file.
  std::shared_ptr<SharedNames> shared_names = std::make_shared<SharedNames>();
  const Declarations* common = nullptr;
  Names<Dimension> dimensions;
  Names<DimensionBounds> dimension_bounds;
  Names<Unit> units;
  Names<Declared<Constant>> constants;
  Names<Declared<FunctionDecl>> functions;
  Names<Percept> percepts;
  Names<DeviceClass> classes;
  Names<DeviceDeclaration> devices;
  Names<HandDeclaration> hands;
  Names<Declared<MaterialDecl>> materials;
  Names<Declared<WorkspaceDecl>> workspaces;  ///< of the file itself: no other file can name them
  /// Materials of the library that this file names without declaring or importing them, by the byte at which the name
  /// begins. Null if none was found, which has been reported.
  std::map<std::uint32_t, const Declared<MaterialDecl>*> library_materials;
  /// Names that imported files declare without `export`, with their places, to tell them from unknown ones.
  std::map<std::string, Span, std::less<>> private_names;
  std::vector<Map> own_maps;
  std::vector<Threshold> own_thresholds;
  std::vector<Rule> own_rules;
  std::vector<Levels> own_levels;

  Declarations() = default;
  /// The declarations of one file on top of those that every file knows.
  explicit Declarations(const Declarations& beneath)
      : Declarations(beneath, std::make_shared<SharedNames>(beneath.names())) {}
  Declarations(const Declarations& beneath, std::shared_ptr<SharedNames> names);
  Declarations& operator=(const Declarations&) = delete;

  const DimensionNames& names() const { return shared_names->known(); }

  /// All maps, thresholds, rules and levels; of each, those that every file knows come first.
  std::vector<const Map*> maps() const;
  template <typename Visit>
  void each_map(const Visit& visit) const {
    if (common) common->each_map(visit);
    for (const Map& map : own_maps) visit(map);
  }
  std::vector<const Threshold*> thresholds() const;
  std::vector<const Rule*> rules() const;
  std::vector<const Levels*> levels() const;

  /// The percept with that name or antonym; a null percept if there is none.
  PerceptName percept_named(std::string_view name) const;
  /// The names of those that levels can be asked of; the others are only compared.
  std::vector<std::string> percepts_with_levels() const;
  /// All names of percepts, antonyms included.
  std::vector<std::string> percept_spellings() const;

  /// The dimension with that name; `number` is that of plain numbers, if no dimension is called so.
  std::optional<Dimension> dimension_named(std::string_view name) const {
    if (const auto* found = dimensions.find(name)) return *found;
    return name == "number" ? std::optional(Dimension{}) : std::nullopt;
  }

  /// The dimension with that name; a plain number if a broken schema/units.wale lacks it.
  Dimension dimension(std::string_view name) const {
    const auto* found = dimensions.find(name);
    return found ? *found : Dimension{};
  }
};

/// A file with everything that it declares and imports.
struct Module {
  SyntaxTree tree;
  Declarations declarations;
  std::string name;  ///< the file's name as diagnostics show it

  Module(SyntaxTree syntax, const Declarations& common, std::shared_ptr<SharedNames> names)
      : tree(std::move(syntax)), declarations(common, std::move(names)) {}
};

/// The embedded files that every file knows, with one list of names for all of them.
struct CommonModules {
  std::vector<std::unique_ptr<SyntaxTree>> trees;
  Declarations declarations;
  Diagnostics problems;  ///< errors in these files, which are errors of this build
};

/// A parsed file with all files that it imports and the embedded files, everything declared.
///
/// Declarations point into it, so it keeps the addresses of its parts and is not copied.
struct ModuleSet {
  SourceId source = 0;  ///< source of the file itself
  std::shared_ptr<const CommonModules> common;
  std::vector<std::shared_ptr<const Module>> modules;  ///< each after those it imports; the file itself is the last,
                                                       ///< unless it is one of the common ones
  std::map<const Import*, std::shared_ptr<const Module>> imports;  ///< the module of each import, for all modules
  /// The declarations that the file itself may use.
  const Declarations& declarations() const {
    return modules.empty() ? common->declarations : modules.back()->declarations;
  }
};

}  // namespace wale
