#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/parse/syntax_tree.hpp"
#include "compiler/text/resolver.hpp"

namespace wale {

/// Where an entry of the index comes from.
enum class Origin {
  own,      ///< a file of the user
  hidden,   ///< a file of the user that imports do not find: a folder searched earlier has a module of that name
  shipped,  ///< part of the binary
};

/// A material of a library, with all texts by which people look for it.
struct IndexedMaterial {
  std::string name;
  std::string module;  ///< the file that declares it, as an import names it: "fabric.denim"
  std::string file;    ///< the same file as messages show it: "library/fabric/denim.wale"
  std::string title, kind;
  std::vector<std::string> called, feels;
  /// Names in other languages: ("de", {"Cord", "Kord"}).
  std::vector<std::pair<std::string, std::vector<std::string>>> called_in;
  std::vector<std::string> replaces;  ///< names of materials that this one supersedes
  std::vector<std::string> sources;   ///< where its figures come from
  std::string licence;                ///< as SPDX names it: "CC0-1.0"; empty: that of its library
  std::vector<std::string> asks;  ///< the percepts that it asks for, by the names that it uses
  std::string documentation;  ///< text of its `///` comment
  Origin origin = Origin::own;

  bool shipped() const { return origin == Origin::shipped; }
};

/// The texts that an index of a library reads have at most so many bytes together, 300 times those of the whole shipped
/// library. What it keeps of them is less.
inline constexpr std::size_t most_indexed = std::size_t{64} << 20;

/// A name that a file of a library exports, other than a material.
struct ExportedName {
  std::string name;
  std::string module;     ///< the file that declares it, as an import names it
  std::string_view what;  ///< "function", "constant", "unit", "dimension", or the word that declares it: "map"
};

/// The materials of a library with all their names, file by file in the order of their modules.
class LibraryIndex {
 public:
  /// Enters the materials and the exports of a file. Errors in the file are ignored.
  void add(const std::string& module, const std::string& file, const SyntaxTree& tree, Origin origin = Origin::own);

  const std::vector<IndexedMaterial>& materials() const { return materials_; }

  /// Notes a file that is not in the index, since the files before it have `most_indexed` bytes.
  void leave_out(const std::string& file) { left_out_.push_back(file); }
  const std::vector<std::string>& left_out() const { return left_out_; }

  /// The first export with that name, or null.
  const ExportedName* exported(std::string_view name) const;

  /// The materials that a text may mean: those with that name. If there are none, those that replace a material of that
  /// name; if there are none, those with that title or `called` text in any language (capitals do not matter); if there are none, those of that kind; if there are none, those of that module,
  /// "fabric.denim", or the one named with its module, "sandpaper.chapter4.Viscous". The empty text means none.
  std::vector<const IndexedMaterial*> meant_by(std::string_view text) const;

  /// All texts that may mean a material.
  std::vector<std::string> spellings() const;

  /// All exported names but those of materials, in the order written.
  const std::vector<ExportedName>& exports() const { return exports_; }

 private:
  std::vector<IndexedMaterial> materials_;
  std::vector<ExportedName> exports_;
  std::vector<std::string> left_out_;
};

/// The index of all modules that a file called `from` could import: those that the resolver lists, then the embedded
/// ones. It is made once per process for each library; files that are written later are not in it.
std::shared_ptr<const LibraryIndex> library_index(Resolver& resolver, const std::string& from);

}  // namespace wale
