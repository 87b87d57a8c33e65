#include "library/index/search.hpp"

#include <algorithm>
#include <array>
#include <unordered_map>

namespace wale {
namespace {

/// Up to how many words a search counts; a material must have none of the others.
constexpr std::size_t most_words = 32;

/// The materials that have one word. Kept by their numbers, so that the order in which a storage gives them does not
/// matter.
class HitsOfWord {
 public:
  void take(const WordHit& hit, bool exact) {
    if (hit.material >= place_.size()) place_.resize(std::max<std::size_t>(hit.material + 1, 2 * place_.size()), 0);
    std::uint32_t& place = place_[hit.material];
    if (place == 0) {
      hits_.push_back({hit.material, 0, hit.length});
      place = static_cast<std::uint32_t>(hits_.size());
    }
    hits_[place - 1].weight += exact ? 2 * hit.weight : hit.weight;
  }
  /// By number. Ends the word; another may follow.
  std::vector<WordHit> all() {
    for (const WordHit& each : hits_) place_[each.material] = 0;
    std::ranges::sort(hits_, {}, &WordHit::material);
    return std::exchange(hits_, {});
  }

 private:
  std::vector<WordHit> hits_;
  std::vector<std::uint32_t> place_;  ///< by material, its place in `hits_` and 1; 0 if it has none
};

struct Sum {
  std::uint32_t material = 0, words = 0;
  double score = 0;
};

/// Adds the scores of one word to those of the words before, both by number.
std::vector<Sum> with_word(const std::vector<Sum>& before, const std::vector<WordHit>& hits,
                           const WordTable::Size& size) {
  const double idf =
      log2_in_steps((2 * static_cast<double>(size.materials) + 2) / (2 * static_cast<double>(hits.size()) + 1));
  const double mean = static_cast<double>(size.length) / static_cast<double>(size.materials);
  std::vector<Sum> sums;
  sums.reserve(before.size() + hits.size());
  auto old = before.begin();
  for (const WordHit& hit : hits) {
    while (old != before.end() && old->material < hit.material) sums.push_back(*old++);
    Sum sum{hit.material, 0, 0};
    if (old != before.end() && old->material == hit.material) sum = *old++;
    const auto weight = static_cast<double>(hit.weight);
    const double norm = 0.25 + 0.75 * (static_cast<double>(hit.length) / mean);
    sum.score += idf * (weight * 2.2) / (weight + 1.2 * norm);
    ++sum.words;
    sums.push_back(sum);
  }
  sums.insert(sums.end(), old, before.end());
  return sums;
}

}  // namespace

double log2_in_steps(double x) {
  double whole = 0;
  while (x >= 2) x /= 2, whole += 1;
  double part = 0, digit = 1;
  for (int i = 0; i < 16; ++i) {
    digit /= 2;
    x *= x;
    if (x >= 2) x /= 2, part += digit;
  }
  return whole + part;
}

Result<std::vector<ScoredMaterial>> search(const WordTable& table, const std::vector<std::string>& words,
                                           const std::function<bool(std::uint32_t)>& may) {
  std::vector<std::string> sought;
  for (const std::string& word : words)
    if (sought.size() < most_words && std::ranges::find(sought, word) == sought.end()) sought.push_back(word);
  const WordTable::Size size = table.size();
  if (sought.empty() || size.materials == 0) return std::vector<ScoredMaterial>{};
  HitsOfWord gathered;
  std::vector<Sum> sums;
  for (const std::string& word : sought) {
    const auto visited = table.each_hit(
        word, [&](std::string_view found, const WordHit& hit) { gathered.take(hit, found.size() == word.size()); });
    if (!visited) return visited.error();
    sums = with_word(sums, gathered.all(), size);
  }
  // What may not be found counts for how rare a word is, and is left out then.
  if (may) std::erase_if(sums, [&](const Sum& sum) { return !may(sum.material); });
  const auto has_all = [&](const Sum& sum) { return sum.words == sought.size(); };
  if (std::ranges::any_of(sums, has_all)) std::erase_if(sums, [&](const Sum& sum) { return !has_all(sum); });
  std::vector<ScoredMaterial> found;
  found.reserve(sums.size());
  for (const Sum& sum : sums) found.push_back({sum.material, sum.score});
  return found;
}

}  // namespace wale
