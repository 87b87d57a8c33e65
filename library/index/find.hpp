#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "library/index/material_index.hpp"
#include "library/index/probe.hpp"
#include "library/index/words.hpp"

namespace wale {

/// What is sought among materials. All conditions must hold.
struct MaterialQuery {
  /// Each a word or several; a material must be found by each text alone (`search`). Without texts, all are found.
  std::vector<std::string> texts;
  std::string kind;              ///< "fabric", which has "fabric.woven" too; empty: any
  const Probe* feel = nullptr;   ///< by what they feel like; null: any
  std::vector<std::string> without_kinds = {};  ///< left out with their modules: "sandpaper", not if `kind` is given
  std::vector<std::uint32_t> without = {};  ///< materials that are left out, such as the one that others are compared with
  std::size_t most = 20;         ///< so many are given
};

/// A material that was found.
struct FoundEntry {
  Entry entry;
  std::size_t row = 0;               ///< of the index's columns
  double score = 0;                  ///< of its words (`search`), the sum over the texts; 0 without texts
  Finding why;                       ///< where its words are
  std::optional<Probe::Told> apart;  ///< if it was sought by feel
};

/// What was found, the best first.
struct FoundEntries {
  std::vector<FoundEntry> entries;  ///< at most `MaterialQuery::most`
  /// How many there are. Of those that are sought by feel, only the given ones are counted.
  std::size_t all = 0;
};

/// Finds materials. By feel, in the order of `nearest`; else by words, the greatest score first, and in the order of names
/// and modules where scores are equal; else all, by modules and names. The same index gives the same answer, wherever it
/// is stored. Errors: those of the storage.
Result<FoundEntries> find_entries(const MaterialIndex& index, const MaterialQuery& sought);

/// The one material that a text means: by its name, by one that it replaces, by title or other names, by kind or by
/// module. Errors: W0201 if there is none, W0217 if there are several.
Result<std::uint32_t> meant_entry(const MaterialIndex& index, std::string_view text);

/// Whether a kind is of the sought one: "fabric.woven" is of "fabric", and every kind is of "".
bool is_of_sought_kind(std::string_view kind, std::string_view sought);

}  // namespace wale
