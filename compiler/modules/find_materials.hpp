#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/modules/library_index.hpp"

namespace wale {

/// By what a material was found, the nearest to it first.
enum class FoundBy { name, title, called, kind, feels, documentation };

/// The word for one: "name", "called".
std::string_view in_words(FoundBy by);

/// A material with all that was looked for in it.
struct FoundMaterial {
  const IndexedMaterial* material = nullptr;  ///< of the index that was searched
  FoundBy by = FoundBy::name;                 ///< of several texts, the one that was farthest
  std::string text;                           ///< which of its texts that was: "like ball bearings"
};

/// The materials in which every text occurs where a word begins, capitals apart and `_`, `.` and `-` as good as a
/// blank: "cord" finds "corduroy" and "old cord" and not "accord". `kind` leaves those of that kind and of the kinds in
/// it, "fabric" those of "fabric.woven"; empty leaves all. First what is called exactly so, then by what they were
/// found, then by their modules and names.
std::vector<FoundMaterial> find_materials(const LibraryIndex& index, const std::vector<std::string>& texts,
                                          std::string_view kind);

/// For somebody who found nothing: every word of every material, and every kind with the kinds that hold it.
std::vector<std::string> findable_words(const LibraryIndex& index);
std::vector<std::string> kinds_in(const LibraryIndex& index);

}  // namespace wale
