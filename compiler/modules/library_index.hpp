#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/parse/syntax_tree.hpp"
#include "compiler/text/resolver.hpp"

namespace wale {

/// A material of a library, as people look for it.
struct IndexedMaterial {
  std::string name;
  std::string module;  ///< the file that declares it, as an import names it: "fabric.denim"
  std::string file;    ///< ... and as people see it: "library/fabric/denim.wale"
  std::string title, kind;
  std::vector<std::string> called, feels;
  std::string documentation;  ///< of its `///` comment
  bool shipped = false;       ///< part of the binary, and no file of the person's own
};

/// A name that a file of a library exports, other than a material.
struct ExportedName {
  std::string name;
  std::string module;     ///< the file that declares it, as an import names it
  std::string_view what;  ///< "function", "constant", "unit", "dimension", or the word that declares it: "map"
};

/// The materials of a library by all their names, file by file in the order of their modules.
class LibraryIndex {
 public:
  /// Enters the materials and the exports of a file. Errors in the file do not matter here.
  void add(const std::string& module, const std::string& file, const SyntaxTree& tree, bool shipped = false);

  const std::vector<IndexedMaterial>& materials() const { return materials_; }

  /// The first export of that name, or null.
  const ExportedName* exported(std::string_view name) const;

  /// The materials that a text may mean: those of that name; where there are none, those with that title or `called`
  /// so, capitals or not; then those of that kind; then those of that module, "fabric.denim", or the one named with its
  /// module, "sandpaper.chapter4.Viscous".
  std::vector<const IndexedMaterial*> meant_by(std::string_view text) const;

  /// Everything by which a material may be meant.
  std::vector<std::string> spellings() const;

 private:
  std::vector<IndexedMaterial> materials_;
  std::vector<ExportedName> exports_;
};

/// Of all modules that a file called `from` could import: those that the resolver lists, then the embedded ones. Made
/// once in a process for each library, from all of its files; a file that is written later is not in it.
std::shared_ptr<const LibraryIndex> library_index(Resolver& resolver, const std::string& from);

}  // namespace wale
