#include "calibration/analysis/descriptions.hpp"

#include <algorithm>
#include <set>

namespace wale::analysis {

std::vector<std::string> words_in(std::string_view text) {
  std::vector<std::string> words;
  std::string word;
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || static_cast<unsigned char>(c) >= 0x80;
  };
  for (std::size_t i = 0; i <= text.size(); ++i) {
    const char c = i < text.size() ? text[i] : ' ';
    if (is_letter(c)) {
      word += c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
    } else if ((c == '\'' || c == '-') && !word.empty() && i + 1 < text.size() && is_letter(text[i + 1])) {
      word += c;
    } else if (!word.empty()) {
      words.push_back(std::move(word));
      word.clear();
    }
  }
  return words;
}

std::vector<DescribedStimulus> count_words(const std::vector<std::string>& texts,
                                           const std::vector<std::uint32_t>& stimulus, std::size_t stimuli,
                                           const std::vector<WordCode>& codes) {
  std::map<std::string, std::vector<const WordCode*>> by_first;
  for (const WordCode& each : codes)
    if (!each.words.empty()) by_first[each.words.front()].push_back(&each);
  for (auto& [first, some] : by_first)
    std::ranges::stable_sort(some, std::greater<>(), [](const WordCode* each) { return each->words.size(); });
  std::vector<DescribedStimulus> described(stimuli);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const std::vector<std::string> words = words_in(texts[i]);
    std::set<std::string> plain, coded;
    for (std::size_t at = 0; at < words.size();) {
      const WordCode* found = nullptr;
      if (const auto some = by_first.find(words[at]); some != by_first.end())
        for (const WordCode* each : some->second)
          if (each->words.size() <= words.size() - at &&
              std::equal(each->words.begin(), each->words.end(), words.begin() + static_cast<std::ptrdiff_t>(at))) {
            found = each;
            break;
          }
      if (found != nullptr) coded.insert(found->code), at += found->words.size();
      else plain.insert(words[at++]);
    }
    DescribedStimulus& of = described[stimulus[i]];
    ++of.descriptions;
    for (const std::string& each : plain) ++of.words[each];
    for (const std::string& each : coded) ++of.codes[each];
  }
  return described;
}

std::vector<std::pair<std::string, std::size_t>> by_frequency(const std::map<std::string, std::size_t>& counts) {
  std::vector<std::pair<std::string, std::size_t>> sorted(counts.begin(), counts.end());
  std::ranges::stable_sort(sorted, std::greater<>(), &std::pair<std::string, std::size_t>::second);
  return sorted;
}

}  // namespace wale::analysis
