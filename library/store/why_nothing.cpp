#include "library/store/why_nothing.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <sstream>

#include "compiler/modules/load_modules.hpp"
#include "compiler/text/readable.hpp"
#include "library/index/words.hpp"
#include "schema/spelling.hpp"

namespace wale {
namespace {

/// What a word says of a percept, and the materials that ask for that: "`sticky` is a word of the percept `stickiness`;
/// `amber` and `tape` ask for it". Empty if it is a word of none.
std::string as_word_of_percept(const LibraryIndex& index, const std::string& text) {
  std::string told;
  common_modules()->declarations.percepts.each([&](const std::string& name, const Percept& percept) {
    const std::vector<std::string> asked = words_of(text);
    const auto has = [&](const std::vector<std::string>& words) {
      return std::ranges::any_of(words, [&](const std::string& each) { return words_of(each) == asked; });
    };
    const bool is_name = text == name || text == percept.antonym;
    if (!told.empty() || asked.empty() || !(is_name || has(percept.words) || has(percept.antonym_words))) return;
    const std::string& meant = text == percept.antonym || has(percept.antonym_words) ? percept.antonym : name;
    told = is_name ? fmt::format("`{}` is a percept", text)
                   : fmt::format("`{}` is a word of the percept `{}`", text, meant.empty() ? name : meant);
    constexpr std::size_t most_told = 5;
    std::vector<std::string> asking;
    std::size_t all = 0;
    for (const IndexedMaterial& each : index.materials()) {
      const bool asks = std::ranges::any_of(
          each.asks, [&](const std::string& asked) { return asked == name || asked == percept.antonym; });
      if (asks && ++all <= most_told) asking.push_back(fmt::format("`{}`", each.name));
    }
    if (all == 0) return void(told += ", which no material here asks for");
    if (all > most_told) asking.push_back(fmt::format("{} more", all - most_told));
    const std::string last = asking.back();
    asking.pop_back();
    told += asking.empty() ? fmt::format(", which {} asks for", last)
                           : fmt::format(", which {} and {} ask for", fmt::join(asking, ", "), last);
  });
  return told;
}

/// The words of the sought texts that no material has.
std::vector<std::string> words_of_none(const LibraryIndex& index, const std::vector<std::string>& texts,
                                       const std::string& kind) {
  std::vector<std::string> words;
  for (const std::string& text : texts) {
    std::istringstream all(text);
    for (std::string word; all >> word;)
      if (find_materials(index, {word}, kind).empty()) words.push_back(word);
  }
  return words;
}

/// The word that a misspelt one may mean. Among thousands of words of many languages one is always near: people seldom
/// mistype the first letter, and a slip in more than a quarter of the letters is another word.
std::optional<std::string> slip_for(const std::string& word, std::vector<std::string> words) {
  const auto first = [](const std::string& text) { return std::tolower(static_cast<unsigned char>(text.empty() ? 0 : text[0])); };
  const std::size_t most = std::max<std::size_t>(1, word.size() / 4);
  std::erase_if(words, [&](const std::string& each) {
    return first(each) != first(word) || (!each.starts_with(word) && letters_changed(word, each) > most);
  });
  return nearest_spelling(word, words, words.size());
}

}  // namespace

Error why_nothing_is_found(const LibraryIndex& index, const std::vector<std::string>& texts, const std::string& kind) {
  const auto because = [](std::string sentence, std::string mend = {}) {
    return Error{Code::unknown_name, std::move(sentence), std::move(mend)};
  };
  if (index.materials().empty()) return because("there is no material here");
  if (!kind.empty() && find_materials(index, {}, kind).empty()) {
    const auto kinds = kinds_in(index);
    const auto near = nearest_spelling(kind, kinds);
    // Of a kind whose first word is known, only those below are meant; of another, only the first words.
    const std::string branch = kind.substr(0, kind.find('.'));
    const bool is_known = std::ranges::find(kinds, branch) != kinds.end();
    std::vector<std::string> meant;
    for (const std::string& each : kinds)
      if (is_known ? each.starts_with(branch + ".") : each.find('.') == std::string::npos) meant.push_back(each);
    return Error{Code::unknown_name,
                 fmt::format("no material is of kind `{}`", kind),
                 near ? fmt::format("did you mean `{}`?", *near) : fmt::format("there are: {}", fmt::join(meant, ", ")),
                 {.name = "--kind", .text = kind}};
  }
  const std::vector<std::string> unfound = words_of_none(index, texts, kind);
  if (unfound.empty()) return because("no material has all of these texts, although each alone is found");
  const std::string& word = unfound.front();
  const std::string sentence = readable("none of {} materials{} has \"{}\"", find_materials(index, {}, kind).size(),
                                        kind.empty() ? "" : fmt::format(" of kind `{}`", kind), word);
  if (const std::size_t elsewhere = kind.empty() ? 0 : find_materials(index, {word}, {}).size(); elsewhere > 0)
    return because(sentence, elsewhere == 1 ? "one of another kind has it" : readable("{} of other kinds have it", elsewhere));
  if (std::string percept = as_word_of_percept(index, word); !percept.empty()) return because(sentence, std::move(percept));
  const auto near = slip_for(word, findable_words(index));
  if (!near) return because(sentence, "`wale find` alone lists them all");
  Error error = because(sentence, fmt::format("did you mean \"{}\"?", *near));
  error.nearest = {*near};
  return error;
}

}  // namespace wale
