#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/modules/find_materials.hpp"
#include "compiler/modules/library_folders.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/text/json_text.hpp"
#include "compiler/text/readable.hpp"
#include "schema/spelling.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct FindOptions {
  std::vector<std::string> texts;  ///< sought texts; a material must have all of them; empty for all materials
  std::string kind;                ///< empty for any kind
  std::vector<std::string> folders;
  bool json = false;
};

/// What a word says of a percept, and the materials that ask for that: "`sticky` is a word of the percept `stickiness`;
/// `amber` and `tape` ask for it". Empty if it is a word of none.
std::string as_word_of_percept(const LibraryIndex& index, const std::string& text) {
  std::string told;
  common_modules()->declarations.percepts.each([&](const std::string& name, const Percept& percept) {
    const auto has = [&](const std::vector<std::string>& words) {
      return std::ranges::find(words, text) != words.end();
    };
    const bool is_name = text == name || text == percept.antonym;
    if (!told.empty() || !(is_name || has(percept.words) || has(percept.antonym_words))) return;
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

/// The reason why nothing was found, with a proposal.
Error why_nothing_is_found(const LibraryIndex& index, const std::vector<std::string>& texts, const std::string& kind) {
  const auto because = [](std::string sentence, std::string mend = {}) {
    return Error{Code::unknown_name, std::move(sentence), std::move(mend)};
  };
  if (index.materials().empty()) return because("there is no material here");
  if (!kind.empty() && find_materials(index, {}, kind).empty()) {
    const auto kinds = kinds_in(index);
    const auto near = nearest_spelling(kind, kinds);
    return Error{Code::unknown_name,
                 fmt::format("no material is of kind `{}`", kind),
                 near ? fmt::format("did you mean `{}`?", *near) : fmt::format("there are: {}", fmt::join(kinds, ", ")),
                 {.name = "--kind", .text = kind}};
  }
  for (const std::string& text : texts) {
    if (!find_materials(index, {text}, kind).empty()) continue;
    const std::string among = kind.empty() ? "" : fmt::format(" of kind `{}`", kind);
    if (std::string percept = as_word_of_percept(index, text); !percept.empty())
      return because(readable("none of {} materials{} has \"{}\"", find_materials(index, {}, kind).size(), among, text),
                     std::move(percept));
    const std::vector<std::string> words = findable_words(index);
    const auto near = nearest_spelling(text, words, words.size());
    return because(readable("none of {} materials{} has \"{}\"", find_materials(index, {}, kind).size(), among, text),
                   near ? fmt::format("did you mean \"{}\"?", *near) : "`wale find` alone lists them all");
  }
  return because("no material has all of these texts, although each alone is found");
}

/// The text by which a material was found, if its line does not show it already.
std::string found_in(const FoundMaterial& found) {
  if (found.by == FoundBy::called || found.by == FoundBy::feels || found.by == FoundBy::replaces)
    return fmt::format("{} \"{}\"", in_words(found.by), visible_text(found.text));
  return found.by == FoundBy::documentation ? "in its documentation" : "";
}

std::string found_text(const std::vector<FoundMaterial>& found) {
  std::size_t name = 0, title = 0, kind = 0, file = 0;
  for (const FoundMaterial& each : found) {
    name = std::max(name, each.material->name.size());
    title = std::max(title, visible_text(each.material->title).size());
    kind = std::max(kind, each.material->kind.size());
    file = std::max(file, visible_text(each.material->file).size());
  }
  std::string text;
  for (const FoundMaterial& each : found) {
    std::string line =
        fmt::format("{:{}}  {:{}}  {:{}}  {:{}}  {}", each.material->name, name, visible_text(each.material->title),
                    title, each.material->kind, kind, visible_text(each.material->file), file, found_in(each));
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

nlohmann::ordered_json names_by_language(const IndexedMaterial& material) {
  auto all = nlohmann::ordered_json::object();
  for (const auto& [language, names] : material.called_in) all[language] = names;
  return all;
}

std::string found_json(const std::vector<FoundMaterial>& found) {
  auto all = nlohmann::ordered_json::array();
  for (const FoundMaterial& each : found)
    all.push_back({{"name", each.material->name},
                   {"title", each.material->title},
                   {"called", each.material->called},
                   {"called_in", names_by_language(*each.material)},
                   {"replaces", each.material->replaces},
                   {"sources", each.material->sources},
                   {"licence", each.material->licence},
                   {"kind", each.material->kind},
                   {"feels", each.material->feels},
                   {"documentation", each.material->documentation},
                   {"module", each.material->module},
                   {"file", each.material->file},
                   {"found_by", in_words(each.by)},
                   {"found_in", each.text}});
  return json_lines(all);
}

int find(const FindOptions& options) {
  const std::vector<std::string> roots = library_folders(options.folders, std::getenv("WALE_LIBRARY"));
  const auto resolver = file_resolver(roots);
  // The index of what a file in the current folder could import; there need not be such a file.
  const std::shared_ptr<const LibraryIndex> index = library_index(*resolver, "here");
  if (const auto& left_out = index->left_out(); !left_out.empty())
    print_error(fmt::format("wale: `{}`{} not searched: the modules before have {} MB, the most that are read\n",
                            visible_text(left_out.front()),
                            left_out.size() > 1 ? fmt::format(" and {} more are", left_out.size() - 1) : " is",
                            most_indexed >> 20));
  const std::vector<FoundMaterial> found = find_materials(*index, options.texts, options.kind);
  warn_of_library_variable();
  say_unread(roots);
  if (options.json) print_out(found_json(found));
  if (found.empty()) return refuse(why_nothing_is_found(*index, options.texts, options.kind));
  if (!options.json) print_out(found_text(found));
  return done;
}

Run declare_find(CLI::App& verb) {
  const auto options = std::make_shared<FindOptions>();
  verb.add_option(
      "TEXT", options->texts,
      "a word, or how it begins, as in ribbed: it may be in a material's name, other names, title, kind, `feels` or "
      "documentation; of several, a material must have all (default: lists every material)");
  verb.add_option("--kind", options->kind,
                  "only materials of this kind, as in fabric or fabric.woven (default: all kinds)")
      ->type_name("KIND");
  offer_library(verb, options->folders, "a folder whose materials are listed too, as in my/materials; may be repeated");
  offer_json(verb, options->json, "an array with all facts about each material");
  verb.footer("for example: wale find ribbed;  wale find --kind fabric cotton");
  return [options] { return find(*options); };
}

}  // namespace

extern const Verb find_verb{
    "find", "lists the materials of the library and of your .wale files here, or those with these words", declare_find};

}  // namespace wale::command
