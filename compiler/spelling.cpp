#include "compiler/spelling.hpp"

#include <algorithm>
#include <numeric>

namespace wale {

namespace {

/// Levenshtein's distance: letters inserted, dropped or exchanged.
std::size_t letters_changed(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row[b.size()];
}

}  // namespace

std::optional<std::string> nearest_spelling(std::string_view word, const std::vector<std::string>& candidates) {
  constexpr std::size_t longest_compared = 64;
  if (word.size() > longest_compared) return std::nullopt;
  std::optional<std::string> nearest;
  std::size_t fewest = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const auto& candidate : candidates) {
    if (candidate.size() > longest_compared || candidate == word) continue;
    const std::size_t changed = letters_changed(word, candidate);
    // A name of one letter is not mistaken for another of one letter.
    if (changed < fewest && changed < std::max(word.size(), candidate.size())) fewest = changed, nearest = candidate;
  }
  return nearest;
}

}  // namespace wale
