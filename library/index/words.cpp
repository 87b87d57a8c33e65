#include "library/index/words.hpp"

#include <utf8proc.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <tuple>

namespace wale {
namespace {

constexpr std::size_t longest_word = 32;  // characters

bool counts(utf8proc_int32_t character) {
  switch (utf8proc_category(character)) {
    case UTF8PROC_CATEGORY_LU:
    case UTF8PROC_CATEGORY_LL:
    case UTF8PROC_CATEGORY_LT:
    case UTF8PROC_CATEGORY_LM:
    case UTF8PROC_CATEGORY_LO:
    case UTF8PROC_CATEGORY_ND:
    case UTF8PROC_CATEGORY_NL:
    case UTF8PROC_CATEGORY_NO: return true;
    default: return false;
  }
}

bool is_word_alone(utf8proc_int32_t c) {
  return (c >= 0x3040 && c <= 0x30ff) || (c >= 0x3400 && c <= 0x9fff) || (c >= 0xf900 && c <= 0xfaff) ||
         (c >= 0x20000 && c <= 0x3ffff);
}

/// Puts characters together to words.
class WordsBegun {
 public:
  void take(utf8proc_int32_t character) {
    if (!counts(character)) return end();
    const bool alone = is_word_alone(character);
    if (alone) end();
    if (characters_ < longest_word) {
      std::array<utf8proc_uint8_t, 4> bytes;
      word_.append(reinterpret_cast<const char*>(bytes.data()),
                   static_cast<std::size_t>(utf8proc_encode_char(character, bytes.data())));
    }
    ++characters_;
    if (alone) end();
  }
  void end() {
    if (characters_ > 0) words_.push_back(std::move(word_));
    word_.clear(), characters_ = 0;
  }
  std::vector<std::string> all() {
    end();
    return std::move(words_);
  }

 private:
  std::vector<std::string> words_;
  std::string word_;
  std::size_t characters_ = 0;
};

/// Calls `visit(place, weight, text)` for every text of a material.
template <typename Visit>
void each_text(const Entry& entry, const Visit& visit) {
  visit(FoundIn::name, WordWeight::name, entry.name);
  for (const std::string& text : entry.replaces) visit(FoundIn::replaces, WordWeight::replaces, text);
  visit(FoundIn::title, WordWeight::title, entry.title);
  for (const EntryName& name : entry.names) visit(FoundIn::called, WordWeight::called, name.text);
  visit(FoundIn::kind, WordWeight::kind, entry.kind);
  for (const std::string& text : entry.feels) visit(FoundIn::feels, WordWeight::feels, text);
  visit(FoundIn::documentation, WordWeight::documentation, entry.documentation);
}

}  // namespace

std::vector<std::string> words_of(std::string_view text) {
  constexpr auto options = static_cast<utf8proc_option_t>(UTF8PROC_DECOMPOSE | UTF8PROC_COMPAT | UTF8PROC_CASEFOLD |
                                                          UTF8PROC_IGNORE | UTF8PROC_STRIPMARK);
  WordsBegun words;
  std::array<utf8proc_int32_t, 32> parts;  // the longest decomposition has 18
  const auto* at = reinterpret_cast<const utf8proc_uint8_t*>(text.data());
  for (auto left = static_cast<utf8proc_ssize_t>(text.size()); left > 0;) {
    utf8proc_int32_t character = 0;
    const utf8proc_ssize_t bytes = utf8proc_iterate(at, left, &character);
    if (bytes <= 0) {
      words.end();
      ++at, --left;
      continue;
    }
    at += bytes, left -= bytes;
    int boundary = 0;
    const utf8proc_ssize_t count =
        utf8proc_decompose_char(character, parts.data(), static_cast<utf8proc_ssize_t>(parts.size()), options, &boundary);
    for (utf8proc_ssize_t i = 0; i < std::min<utf8proc_ssize_t>(count, parts.size()); ++i)
      words.take(parts[static_cast<std::size_t>(i)]);
  }
  return words.all();
}

WordCounts count_words(const Entry& entry) {
  std::map<std::string, std::uint32_t> weights;
  WordCounts counted;
  each_text(entry, [&](FoundIn, std::uint32_t weight, const std::string& text) {
    for (std::string& word : words_of(text)) weights[std::move(word)] += weight, counted.length += weight;
  });
  counted.weights.assign(weights.begin(), weights.end());
  return counted;
}

std::string_view in_words(FoundIn place) {
  switch (place) {
    case FoundIn::name: return "name";
    case FoundIn::replaces: return "replaces";
    case FoundIn::title: return "title";
    case FoundIn::called: return "called";
    case FoundIn::kind: return "kind";
    case FoundIn::feels: return "feels";
    case FoundIn::documentation: return "documentation";
  }
  return {};
}

Finding why_found(const Entry& entry, const std::vector<std::string>& sought) {
  struct Place {
    bool has_more = false;
    FoundIn place = FoundIn::name;
    std::string text;
    bool is_after(const Place& other) const {
      return std::tie(has_more, place) > std::tie(other.has_more, other.place);
    }
  };
  struct Read {
    FoundIn place;
    const std::string* text;
    std::vector<std::string> words;
  };
  std::vector<Read> read;
  if (!sought.empty())
    each_text(entry, [&](FoundIn place, std::uint32_t, const std::string& text) { read.push_back({place, &text, words_of(text)}); });
  Place shown{false, FoundIn::name, entry.name};
  for (const std::string& word : sought) {
    std::optional<Place> first;
    for (const Read& each : read) {
      if (std::ranges::none_of(each.words, [&](const std::string& has) { return has.starts_with(word); })) continue;
      Place here{each.words != sought, each.place, *each.text};
      if (!first || first->is_after(here)) first = std::move(here);
    }
    if (first && first->is_after(shown)) shown = *std::move(first);
  }
  return {shown.place, std::move(shown.text)};
}

}  // namespace wale
