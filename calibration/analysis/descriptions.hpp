#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wale::analysis {

/// What a description is counted as: a word or words that stand one after the other, and the code that they mean.
struct WordCode {
  std::vector<std::string> words;  ///< as `words_in` gives them
  std::string code;
};

/// The words of a text in small letters: runs of letters, digits, apostrophes and hyphens between them. Letters beyond
/// ASCII stay as they are.
std::vector<std::string> words_in(std::string_view text);

/// In how many descriptions of one stimulus each word is; a word that is there twice counts once.
struct DescribedStimulus {
  std::size_t descriptions = 0;
  std::map<std::string, std::size_t> words;    ///< without those that a code was taken for
  std::map<std::string, std::size_t> codes;
};

/// Counts texts, each with the number of its stimulus. Of codes that overlap, the one of most words is taken, from left
/// to right.
std::vector<DescribedStimulus> count_words(const std::vector<std::string>& texts,
                                           const std::vector<std::uint32_t>& stimulus, std::size_t stimuli,
                                           const std::vector<WordCode>& codes);

/// Words and their counts, the most frequent first; of equally frequent ones in alphabetical order.
std::vector<std::pair<std::string, std::size_t>> by_frequency(const std::map<std::string, std::size_t>& counts);

}  // namespace wale::analysis
