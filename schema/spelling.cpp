#include "schema/spelling.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace wale {

namespace {

constexpr std::size_t longest_compared = 64;

char lower(char letter) { return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter; }

bool same(char a, char b) { return lower(a) == lower(b); }

/// The shortest candidate that begins with a word of at least four letters, as `roughness` does with `rough`.
std::optional<NearSpelling> begun_by(std::string_view word, const std::vector<std::string>& candidates) {
  constexpr std::size_t least_letters = 4;
  std::optional<NearSpelling> shortest;
  for (const std::string& candidate : candidates) {
    const bool begins = candidate.size() > word.size() &&
                        std::ranges::equal(word, std::string_view(candidate).substr(0, word.size()), same);
    if (word.size() >= least_letters && begins && (!shortest || candidate.size() < shortest->text.size()))
      shortest = NearSpelling{candidate, false};
  }
  return shortest;
}

}  // namespace

std::size_t letters_changed(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + !same(a[i - 1], b[j - 1])});
      if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

std::optional<NearSpelling> near_spelling(std::string_view word, const std::vector<std::string>& candidates,
                                          std::size_t most_candidates) {
  // Among thousands of names one is always near, and searching them for each of a thousand errors takes minutes.
  if (word.size() > longest_compared || candidates.size() > most_candidates) return std::nullopt;
  std::optional<NearSpelling> nearest;
  std::size_t fewest = std::max<std::size_t>(1, word.size() / 3) + 1, as_near = 0;
  for (const auto& candidate : candidates) {
    if (candidate.size() > longest_compared || candidate == word) continue;
    if (candidate.size() > word.size() + fewest || word.size() > candidate.size() + fewest) continue;  // never near
    const std::size_t changed = letters_changed(word, candidate);
    // Every name of one or two letters is near to every other: only their order and their capitals count as slips.
    const bool short_word = std::max(word.size(), candidate.size()) <= 2;
    const bool turned = word.size() == 2 && candidate.size() == 2 && word[0] == candidate[1] && word[1] == candidate[0];
    if (short_word && changed != 0 && !turned) continue;
    if (changed < fewest) {
      fewest = changed, as_near = 0;
      nearest = NearSpelling{candidate, false};
    }
    // A name that is declared in two places counts once.
    if (nearest && changed == fewest && candidate != nearest->text) ++as_near;
  }
  if (!nearest) return begun_by(word, candidates);
  nearest->certain = fewest <= 1 && as_near == 0;
  return nearest;
}

std::optional<std::string> nearest_spelling(std::string_view word, const std::vector<std::string>& candidates,
                                            std::size_t most_candidates) {
  auto near = near_spelling(word, candidates, most_candidates);
  if (!near) return std::nullopt;
  return std::move(near->text);
}

std::optional<std::size_t> distance_from(std::string_view word, std::string_view name) {
  constexpr std::size_t least_letters = 3;
  if (word.empty() || word.size() > longest_compared || name.size() > longest_compared) return std::nullopt;
  const std::size_t changed = letters_changed(word, name);
  if (changed <= 1) return changed;
  const bool begins = word.size() >= least_letters && name.size() > word.size() &&
                      std::ranges::equal(word, name.substr(0, word.size()), same);
  if (begins) return 2;
  if (changed > word.size() / 3) return std::nullopt;
  return changed + 1;
}

std::vector<std::string> nearest_spellings(std::string_view word, const std::vector<std::string>& candidates,
                                           std::size_t most) {
  std::vector<std::string> nearest;
  for (const std::string& candidate : candidates)
    if (distance_from(word, candidate)) nearest.push_back(candidate);
  std::sort(nearest.begin(), nearest.end(), [&](const std::string& a, const std::string& b) {
    const auto of_a = distance_from(word, a), of_b = distance_from(word, b);
    return of_a != of_b ? of_a < of_b : a < b;
  });
  nearest.erase(std::unique(nearest.begin(), nearest.end()), nearest.end());
  if (nearest.size() > most) nearest.resize(most);
  return nearest;
}

bool has_ending(std::string_view name, std::string_view ending) {
  return name.size() >= ending.size() && std::ranges::equal(name.substr(name.size() - ending.size()), ending, same);
}

}  // namespace wale
