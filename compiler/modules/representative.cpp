#include "compiler/modules/representative.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/diagnostics/advice.hpp"

namespace wale {
namespace {

/// What a setting takes.
enum class Takes { text, texts, word, words, texts_in_a_language, material };

struct Known {
  std::string_view key;
  Takes takes;
  const char* example;
};
constexpr Known known[] = {
    {"title", Takes::text, "title \"Wide-wale corduroy\""},
    {"called", Takes::texts_in_a_language, "called \"corduroy\"`, or `called de \"Cord\""},
    {"kind", Takes::word, "kind fabric.woven"},
    {"feels", Takes::texts, "feels \"like ball bearings\""},
    {"source", Takes::texts, "source \"who published it, where and when\""},
    {"licence", Takes::text, "licence \"CC0-1.0\""},
    {"replaces", Takes::words, "replaces old_corduroy"},
    {"like", Takes::material, "like denim"},
};

const Known* setting_named(std::string_view key) {
  const auto* found = std::ranges::find(known, key, &Known::key);
  return found == std::end(known) ? nullptr : found;
}

}  // namespace

bool is_language(std::string_view word) {
  return (word.size() == 2 || word.size() == 3) &&
         std::ranges::all_of(word, [](char each) { return each >= 'a' && each <= 'z'; });
}

const std::vector<std::string>& representative_settings() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> keys;
    for (const Known& each : known) keys.emplace_back(each.key);
    return keys;
  }();
  return all;
}

bool is_representative_setting(std::string_view key) { return setting_named(key) != nullptr; }

std::string_view language_of(const Setting& setting) {
  const bool named = setting.key.text == "called" && !setting.items.empty() && setting.items.front().words.size() == 1 &&
                     setting.items.front().value;
  return named ? setting.items.front().words.front().text : std::string_view{};
}

RepresentativeEntry representative_entry(const Setting& setting, const SyntaxTree& tree, Diagnostics& diagnostics) {
  const Known& meant = *setting_named(setting.key.text);
  const std::string_view language = language_of(setting);
  RepresentativeEntry entry{std::string(meant.key), {}};
  const auto refuse = [&](Span span, std::string message, std::string help) {
    diagnostics.report(Advice(std::move(help)).about(Code::wrong_type, span, std::move(message)));
  };
  if (!language.empty()) {
    entry.key += fmt::format(" {}", language);
    if (!is_language(language))
      refuse(setting.items.front().words.front().span, fmt::format("`{}` is no language", language),
             "write its code of two or three small letters (ISO 639): `de`, `fr`, `ja`");
  }
  const bool takes_words = meant.takes == Takes::word || meant.takes == Takes::words;
  const bool takes_one = meant.takes == Takes::word || meant.takes == Takes::text;
  for (std::size_t i = 0; i < setting.items.size(); ++i) {
    const SettingItem& item = setting.items[i];
    const auto* literal = item.value ? std::get_if<TextLiteral>(&tree.expr(*item.value)) : nullptr;
    const std::size_t words = i == 0 && !language.empty() ? 1 : 0;
    if (takes_words && item.words.size() == 1 && !item.value)
      entry.values.emplace_back(item.words[0].text);
    else if (!takes_words && literal && item.words.size() == words && item.trailing.empty())
      entry.values.emplace_back(literal->text);
    else
      refuse(item.span,
             fmt::format("`{}` takes {}", setting.key.text,
                         meant.takes == Takes::word    ? "a word"
                         : meant.takes == Takes::words ? "names of materials"
                                                       : "texts in quotes"),
             literal && !item.trailing.empty() && is_representative_setting(item.trailing.front().text)
                 ? fmt::format("write `;` or a new line before `{}`", item.trailing.front().text)
             : !takes_words && !item.value && item.words.size() == 1 && item.trailing.empty()
                 ? fmt::format("write it in quotes: `\"{}\"`", item.words.front().text)
                 : fmt::format("write, for example, `{}`", meant.example));
    if (i > 0 && takes_one) {
      refuse(item.span, fmt::format("`{}` takes one {}", setting.key.text, takes_words ? "word" : "text"),
             fmt::format("write, for example, `{}`", meant.example));
      break;
    }
  }
  return entry;
}

}  // namespace wale
