#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "library/index/entry.hpp"

namespace wale {

/// The words of a text, in order, as the table of words has them. The text is decomposed for compatibility (NFKD of
/// UAX #15), its case is folded, and marks and ignorable characters are left out; a word is then a longest run of
/// letters and numbers (general categories L and N), of which the first 32 characters count. Each character of a script
/// that is written without blanks (U+3040 .. U+30FF, U+3400 .. U+9FFF, U+F900 .. U+FAFF, U+20000 .. U+3FFFF) is a word
/// of its own. Bytes that are no UTF-8 end a word. "Gröber_Cord, 2.5 mm" has the words "grober", "cord", "2", "5", "mm".
std::vector<std::string> words_of(std::string_view text);

/// What a word counts by where it stands in a material; of several places, the sum.
struct WordWeight {
  static constexpr std::uint32_t name = 8, replaces = 8, title = 6, called = 6, kind = 4, feels = 3, documentation = 1;
};

/// The words of a material.
struct WordCounts {
  std::vector<std::pair<std::string, std::uint32_t>> weights;  ///< each word once, by its bytes, and its weight
  std::uint32_t length = 0;                                    ///< the sum of the weights of all words
};
WordCounts count_words(const Entry& entry);

/// Where a material has the words that were sought.
enum class FoundIn { name, replaces, title, called, kind, feels, documentation };

/// Its word: "name", "called".
std::string_view in_words(FoundIn place);

/// The place that shows best why a material was found: for each sought word the first place with a word that begins so,
/// one that has nothing else before others; of these the last. `text` is the text there. The name, if it has none.
struct Finding {
  FoundIn place = FoundIn::name;
  std::string text;
};
Finding why_found(const Entry& entry, const std::vector<std::string>& sought);

}  // namespace wale
