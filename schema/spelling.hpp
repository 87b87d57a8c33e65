#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace wale {

/// The number of slips that turn `a` into `b`, ignoring case. A slip inserts, drops or replaces a letter, or swaps two
/// neighbours; each letter takes part in one slip at most (the optimal string alignment distance).
std::size_t letters_changed(std::string_view a, std::string_view b);

/// The candidate other than `word` with the fewest slips: at most one, or a third of the word's letters. Otherwise the
/// shortest candidate that begins with `word`, if that has at least four letters. Empty for words of more than 64 bytes
/// and for more than `most_candidates`.
std::optional<std::string> nearest_spelling(std::string_view word, const std::vector<std::string>& candidates,
                                            std::size_t most_candidates = 2000);

/// A candidate near to a word.
struct NearSpelling {
  std::string text;
  /// It is at most one slip away (capitals do not count), and no other candidate is as near.
  bool certain = false;
};

/// As `nearest_spelling`, with its certainty.
std::optional<NearSpelling> near_spelling(std::string_view word, const std::vector<std::string>& candidates,
                                          std::size_t most_candidates = 2000);

/// How far a name is from the word that may have meant it, for sorting: 0 for the same one, 1 for one slip, 2 if it
/// begins with the word (of three letters at least), then one more than its slips. Empty if it is not near: more slips
/// than one and than a third of the word's letters, or more than 64 bytes.
std::optional<std::size_t> distance_from(std::string_view word, std::string_view name);

/// The candidates that are near, each once, at most `most`, the nearest first (`distance_from`).
std::vector<std::string> nearest_spellings(std::string_view word, const std::vector<std::string>& candidates,
                                           std::size_t most = 3);

/// Whether the name of a file ends with `ending`, as in ".wrec", in capital or small ASCII letters.
bool has_ending(std::string_view name, std::string_view ending);

}  // namespace wale
