#include "compiler/modules/find_materials.hpp"

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

namespace wale {
namespace {

/// The text in lower case with blanks between words; characters beyond ASCII are unchanged.
std::string folded(std::string_view text) {
  std::string words;
  for (const unsigned char c : text) {
    const bool between = std::isspace(c) || c == '_' || c == '.' || c == '-';
    if (!between)
      words += static_cast<char>(std::tolower(c));
    else if (!words.empty() && words.back() != ' ')
      words += ' ';
  }
  if (words.ends_with(' ')) words.pop_back();
  return words;
}

bool begins_a_word_in(const std::string& words, const std::string& sought) {
  if (sought.empty()) return false;
  for (std::size_t at = words.find(sought); at != std::string::npos; at = words.find(sought, at + 1)) {
    // A word begins after a character that is not a letter, as in "like ball-bearings" and in "(satin)".
    const auto before = at == 0 ? ' ' : static_cast<unsigned char>(words[at - 1]);
    if (!std::isalnum(before) && before < 0x80) return true;
  }
  return false;
}

bool is_of_kind(std::string_view kind, std::string_view sought) {
  return kind.starts_with(sought) && (kind.size() == sought.size() || kind[sought.size()] == '.');
}

struct Occurrence {
  bool inexact;
  FoundBy by;
  std::string text;
};

/// Finds a folded text in a material; of several places, the first in the order of `FoundBy`.
std::optional<Occurrence> occurrence_of(const std::string& sought, const IndexedMaterial& material) {
  std::optional<Occurrence> nearest;
  const auto look = [&](FoundBy by, const std::string& text) {
    const std::string words = folded(text);
    if (!begins_a_word_in(words, sought)) return;
    Occurrence it{words != sought, by, text};
    if (!nearest || std::tie(it.inexact, it.by) < std::tie(nearest->inexact, nearest->by)) nearest = std::move(it);
  };
  look(FoundBy::name, material.name);
  for (const std::string& text : material.replaces) look(FoundBy::replaces, text);
  look(FoundBy::title, material.title);
  for (const std::string& text : material.called) look(FoundBy::called, text);
  for (const auto& [language, names] : material.called_in)
    for (const std::string& text : names) look(FoundBy::called, text);
  look(FoundBy::kind, material.kind);
  for (const std::string& text : material.feels) look(FoundBy::feels, text);
  look(FoundBy::documentation, material.documentation);
  return nearest;
}

}  // namespace

std::string_view in_words(FoundBy by) {
  switch (by) {
    case FoundBy::name: return "name";
    case FoundBy::replaces: return "replaces";
    case FoundBy::title: return "title";
    case FoundBy::called: return "called";
    case FoundBy::kind: return "kind";
    case FoundBy::feels: return "feels";
    case FoundBy::documentation: return "documentation";
  }
  return {};
}

std::vector<FoundMaterial> find_materials(const LibraryIndex& index, const std::vector<std::string>& texts,
                                          std::string_view kind) {
  std::vector<std::string> sought;
  for (const std::string& text : texts) sought.push_back(folded(text));
  std::vector<std::pair<bool, FoundMaterial>> found;  // whether it is inexact, as the key to sort by
  for (const IndexedMaterial& material : index.materials()) {
    if (!kind.empty() && !is_of_kind(material.kind, kind)) continue;
    Occurrence farthest{false, FoundBy::name, material.name};
    const bool has_all = std::ranges::all_of(sought, [&](const std::string& text) {
      std::optional<Occurrence> it = occurrence_of(text, material);
      if (it && std::tie(it->inexact, it->by) >= std::tie(farthest.inexact, farthest.by)) farthest = *std::move(it);
      return it.has_value();
    });
    if (has_all) found.push_back({farthest.inexact, {&material, farthest.by, std::move(farthest.text)}});
  }
  std::ranges::stable_sort(found, {}, [](const auto& each) {
    const auto& [inexact, it] = each;
    return std::tie(inexact, it.by, it.material->module, it.material->name);
  });
  std::vector<FoundMaterial> ordered;
  for (auto& [inexact, each] : found) ordered.push_back(std::move(each));
  return ordered;
}

std::vector<std::string> findable_words(const LibraryIndex& index) {
  std::set<std::string> words;
  const auto enter = [&](const std::string& text) {
    const std::string all = folded(text);
    for (std::size_t begin = 0; begin < all.size();) {
      const std::size_t end = std::min(all.find(' ', begin), all.size());
      words.insert(all.substr(begin, end - begin));
      begin = end + 1;
    }
  };
  for (const IndexedMaterial& material : index.materials()) {
    for (const std::string* text : {&material.name, &material.title, &material.kind}) enter(*text);
    for (const std::string& text : material.called) enter(text);
    for (const std::string& text : material.replaces) enter(text);
    for (const auto& [language, names] : material.called_in)
      for (const std::string& text : names) enter(text);
    for (const std::string& text : material.feels) enter(text);
  }
  return {words.begin(), words.end()};
}

std::vector<std::string> kinds_in(const LibraryIndex& index) {
  std::set<std::string> kinds;
  for (const IndexedMaterial& material : index.materials())
    for (std::string kind = material.kind; !kind.empty();) {
      kinds.insert(kind);
      const std::size_t dot = kind.rfind('.');
      kind.resize(dot == std::string::npos ? 0 : dot);
    }
  return {kinds.begin(), kinds.end()};
}

}  // namespace wale
