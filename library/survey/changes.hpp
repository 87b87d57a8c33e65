#pragma once

#include <string>
#include <vector>

#include "compiler/compare/compare.hpp"
#include "library/index/entry.hpp"

namespace wale {

/// A material that both versions of a library have.
struct ChangedMaterial {
  std::string name;
  Comparison comparison;  ///< of the old with the new one; without cues if one of them has none
  std::vector<std::string> words;  ///< what else differs: "title", "kind", "names", "licence", "levels asked for"
  std::string trouble;    ///< why they cannot be compared; mostly empty
  double noticeable = 0;  ///< just noticeable differences of the cue that differs most, as far as known
};

/// A material whose name has gone, and the one that stands for it.
struct SupersededMaterial {
  std::string old_name, new_name;
  ChangedMaterial change;
};

/// What changed between two versions of a library.
struct LibraryChanges {
  std::vector<std::string> added, removed;  ///< by name; `removed` without a successor
  std::vector<SupersededMaterial> superseded;
  std::vector<ChangedMaterial> changed;  ///< to the hand or in words, the plainest first
  /// Names that have gone and that several of the new version replace, so that nobody can ask by them any more.
  struct Ambiguous {
    std::string old_name;
    std::vector<std::string> heirs;
  };
  std::vector<Ambiguous> ambiguous;
  struct Unbuilt {
    std::string name, why;
  };
  std::vector<Unbuilt> unbuilt;  ///< materials of the new version that cannot be built
  std::size_t same = 0;                  ///< materials in which nothing has changed
  std::string device;

  /// Whether all who ask for a material by its old name get one that feels the same: nothing was removed without a
  /// successor or with several, nothing under the same name is plainly another, and all can be built.
  bool keeps_promises() const;
};

/// Finds each old name in the new version: by its name, or by `replaces`. Errors in materials are in `trouble`.
LibraryChanges changes_between(const std::vector<Entry>& before, const std::vector<Entry>& after,
                               const Comparer& comparer);

/// For people: what a curator tells those who use the library.
std::string changes_text(const LibraryChanges& changes);
std::string changes_json(const LibraryChanges& changes);

}  // namespace wale
