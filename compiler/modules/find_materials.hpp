#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/modules/library_index.hpp"

namespace wale {

/// The kind of text by which a material was found, the best first.
enum class FoundBy { name, replaces, title, called, kind, feels, documentation };

/// Its word: "name", "called".
std::string_view in_words(FoundBy by);

/// A material that contains all the texts that were sought.
struct FoundMaterial {
  const IndexedMaterial* material = nullptr;  ///< points into the index that was searched
  FoundBy by = FoundBy::name;                 ///< for several sought texts, the worst of their kinds
  std::string text;                           ///< the material's text of that kind: "like ball bearings"
};

/// The materials that contain every text at the beginning of a word. Capitals do not matter, and `_`, `.` and `-` count
/// as blanks: "cord" finds "corduroy" and "old cord" but not "accord". `kind` keeps only materials of that kind and its
/// subkinds, as "fabric" does with "fabric.woven"; if it is empty, all are kept. Exact matches come first; then the
/// order is by `FoundBy`, module and name.
std::vector<FoundMaterial> find_materials(const LibraryIndex& index, const std::vector<std::string>& texts,
                                          std::string_view kind);

/// Suggestions for a search without results: every word of every material, and every kind with its parent kinds.
std::vector<std::string> findable_words(const LibraryIndex& index);
std::vector<std::string> kinds_in(const LibraryIndex& index);

}  // namespace wale
