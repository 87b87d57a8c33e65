#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "wale/result.hpp"

namespace wale {

/// A material that has a word.
struct WordHit {
  std::uint32_t material = 0;  ///< its number in the table
  std::uint32_t weight = 0;    ///< of the word there
  std::uint32_t length = 0;    ///< of all its words (`WordCounts`)
};

/// A table of words, wherever it is stored. It decides nothing: all arithmetic is in `search`.
class WordTable {
 public:
  virtual ~WordTable() = default;

  /// How many materials there are, and the sum of their lengths.
  struct Size {
    std::uint64_t materials = 0, length = 0;
  };
  virtual Size size() const = 0;

  /// Visits each word that begins so, and each material that has it, in any order. Errors: those of the storage.
  using Visit = std::function<void(std::string_view word, const WordHit& hit)>;
  virtual Result<> each_hit(const std::string& beginning, const Visit& visit) const = 0;
};

/// A found material and its score.
struct ScoredMaterial {
  std::uint32_t material = 0;
  double score = 0;
};

/// The materials that have all words, or if there is none, those that have some; in the order of their numbers. A word
/// is had by a material of which a word begins so; a word that is exactly it counts twice. `words` are those of
/// `words_of`; later ones of the same count no more. Only materials for which `may` holds are found; an empty `may`
/// holds for all. Without words nothing is found.
///
/// Scores are those of Okapi's BM25 (Robertson et al., TREC-3, 1994) with k1 = 1.2 and b = 0.75, in doubles, in this
/// order and without fused operations, so that every program that follows it gets the same bits:
///
///     N, L      materials of the table and the sum of their lengths
///     n         materials that have the word, w the sum of the weights of the words that begin so in one of them, where
///               the exact word's weight counts twice, l the length of that material
///     idf     = log2((2 N + 2) / (2 n + 1))            by `log2_in_steps`
///     norm    = 0.25 + 0.75 * (l / (L / N))
///     score   = sum over the words in their order of   idf * (w * 2.2) / (w + 1.2 * norm)
Result<std::vector<ScoredMaterial>> search(const WordTable& table, const std::vector<std::string>& words,
                                           const std::function<bool(std::uint32_t)>& may = {});

/// The binary logarithm of x >= 1, rounded down to a multiple of 2^-16, by operations that IEEE 754 rounds alike
/// everywhere: x is halved until it is below 2; then it is squared sixteen times, and each time it reaches 2 it is
/// halved and gives a binary digit.
double log2_in_steps(double x);

}  // namespace wale
