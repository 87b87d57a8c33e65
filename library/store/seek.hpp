#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compiler/modules/find_materials.hpp"
#include "library/index/find.hpp"

// What `wale find` and `wale between` answer, and programs that ask `Library::search`, `nearest` and `between`.
namespace wale {

/// So many materials are given, unless more or fewer are asked for.
inline constexpr std::uint64_t usually_near = 20, usually_between = 10;

struct Seeking {
  std::vector<std::string> texts;  ///< each is a word or several; a material must have all of them
  std::string kind;                ///< "fabric", which has "fabric.woven" too; empty: any
  std::string near;                ///< a material whose feel is sought; empty: any
  std::vector<SoughtLevel> levels;
  std::optional<std::uint64_t> most;  ///< nothing: 20 by feel, all by words

  bool by_feel() const { return !near.empty() || !levels.empty(); }
};

/// What is felt of a material of the index, or of one of a Wale file of one's own: "my.wale", "my.wale:name".
struct FeltMaterial {
  std::string name, kind, module;
  Cues cues;
  std::vector<std::uint32_t> is;  ///< its number, if the index has it, also if its file was named
};

/// `request` says how a file of one's own is read. Errors: those of `meant_entry`, of `read_entries`, the first one
/// of its text, and W0602 for a material whose cues are not known, as of one that only vibrates.
Result<FeltMaterial> felt_material(const MaterialIndex& index, const FileRequest& request, const std::string& text);

/// What `felt_material` would refuse, as far as it is known before the library is read: a text that means no material of
/// the catalogue, and a file that does not compile. Takes about as long as compiling that file.
Result<> can_be_felt(const LibraryIndex& catalogue, const FileRequest& request, const std::string& text);

/// By feel, by words, or both, in an index. Errors: those of `felt_material`, `LevelProbe::make` and `find_entries`.
Result<FoundEntries> seek_by_feel(const MaterialIndex& index, const FileRequest& request, const Seeking& sought);

/// The kinds of the stimuli of the shipped library and of the project here (`LibraryProject`), of which many feel alike.
std::vector<std::string> stimuli_here();

/// Whether a kind or a module is one of these, or below one.
bool is_of_these(const std::vector<std::string>& kinds, std::string_view kind, std::string_view module);

/// The kinds that are left out among what feels most like a material: stimuli, unless the material is one.
std::vector<std::string> kinds_left_out(std::string_view kind, std::string_view module);

/// By words alone. Of several words that no material has as they stand, in one text or in several: those that have at
/// least half of them, or if there is none, those that have the most; the most words first, then the greatest score.
struct FoundByWords {
  std::vector<FoundMaterial> as_they_stand;  ///< points into the catalogue
  std::vector<FoundEntry> most_words;
  bool have_all = false;  ///< those of `most_words` have all words, each somewhere
};
FoundByWords seek_by_words(const LibraryIndex& catalogue, const Seeking& sought);

/// Materials that lie between two, to the hand.
struct FoundBetween {
  struct Each {
    FoundEntry found;
    Probe::Told from_one, from_other;
  };
  std::string one, other;  ///< their names
  std::vector<Each> found;
};
/// Errors: those of `felt_material` and `find_entries`.
Result<FoundBetween> seek_between(const MaterialIndex& index, const FileRequest& request, const std::string& one,
                                  const std::string& other, const std::string& kind, std::uint64_t most);

/// The kinds of an index with their parents, in alphabetic order.
std::vector<std::string> kinds_in(const MaterialIndex& index);

}  // namespace wale
