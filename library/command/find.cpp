#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/modules/library_folders.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/text/json_text.hpp"
#include "compiler/text/readable.hpp"
#include "compiler/typed_number.hpp"
#include "library/command/index_here.hpp"
#include "library/index/entry_json.hpp"
#include "library/store/seek.hpp"
#include "library/store/why_nothing.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct FindOptions {
  std::vector<std::string> texts;  ///< sought texts; a material must have all of them; empty for all materials
  std::string kind;                ///< empty for any kind
  IndexChoice choice;
  bool json = false;
  std::string near;                            ///< a material whose feel is sought
  std::map<std::string, std::string> levels;  ///< sought, by percept, as written
  std::optional<std::uint64_t> most;

  bool by_feel() const {
    return !near.empty() || std::ranges::any_of(levels, [](const auto& each) { return !each.second.empty(); });
  }
};

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

/// "0.6", "60 %" or "0.4..0.7".
Result<SoughtLevel> sought_level(const std::string& percept, const std::string& text) {
  const auto number = [](std::string each) -> std::optional<double> {
    const std::size_t begin = each.find_first_not_of(' '), end = each.find_last_not_of(" %");
    if (begin == std::string::npos || end == std::string::npos || end < begin) return std::nullopt;
    const double scale = each.find('%', end + 1) != std::string::npos ? 0.01 : 1;
    const auto value = read_number("", each.substr(begin, end - begin + 1));
    return value ? std::optional(*value * scale) : std::nullopt;
  };
  const std::size_t dots = text.find("..");
  const auto low = number(text.substr(0, dots));
  const auto high = dots == std::string::npos ? low : number(text.substr(dots + 2));
  if (!low || !high || !(*low >= 0) || !(*high <= 1) || !(*low <= *high))
    return Error{.code = Code::malformed_value,
                 .sentence = fmt::format("expected a level from 0 to 1, or two with .. between, found `{}`",
                                         visible_text(text)),
                 .mend = fmt::format("for example, `--{} 0.6` or `--{} 0.4..0.7`", percept, percept),
                 .place = {.name = "--" + percept}};
  return SoughtLevel{percept, *low, *high};
}

std::string felt_text(const FoundEntries& found) {
  std::size_t name = 0, title = 0, kind = 0;
  for (const FoundEntry& each : found.entries) {
    name = std::max(name, each.entry.name.size());
    title = std::max(title, visible_text(each.entry.title).size());
    kind = std::max(kind, each.entry.kind.size());
  }
  std::string text;
  for (const FoundEntry& each : found.entries) {
    std::string line = fmt::format("{:{}}  {:{}}  {:{}}  {}", each.entry.name, name, visible_text(each.entry.title), title,
                                   each.entry.kind, kind,
                                   each.apart ? distance_text(*each.apart) : visible_text(each.entry.file));
    if (!each.entry.trouble.empty()) line += "  does not compile";
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string felt_json(const FoundEntries& found) {
  auto all = nlohmann::ordered_json::array();
  for (const FoundEntry& each : found.entries) {
    auto json = entry_json(each.entry);
    if (each.apart) json["distance"] = distance_json(*each.apart);
    if (each.score > 0) json["score"] = each.score;
    all.push_back(std::move(json));
  }
  return json_lines(all);
}

int tell_found(const FindOptions& options, const Result<FoundEntries>& found) {
  if (!found) return refuse(found.error());
  if (options.json) print_out(felt_json(*found));
  if (found->entries.empty())
    return refuse(Error{.code = Code::unknown_name,
                        .sentence = "no material is like that",
                        .mend = "ask for a wider range, or for fewer things at once"});
  if (!options.json) print_out(felt_text(*found));
  for (const auto& level : options.levels) {
    const auto& [percept, text] = level;
    const auto lacks = [&asked = level.first](const FoundEntry& each) {
      return each.apart && std::ranges::find(each.apart->unknown, asked) != each.apart->unknown.end();
    };
    if (!options.json && !text.empty() && std::ranges::all_of(found->entries, lacks))
      print_out("nothing is known of the {} of any of these: none has what carries it\n", percept);
  }
  if (!options.json && options.by_feel())
    print_out("in the order of the least that they can differ by, in just noticeable differences; each cue that is unknown "
              "counts as one more\n");
  return done;
}

int find_by_feel(const FindOptions& options) {
  std::vector<SoughtLevel> levels;
  for (const auto& [percept, text] : options.levels) {
    if (text.empty()) continue;
    const auto level = sought_level(percept, text);
    if (!level) return refuse(level.error());
    levels.push_back(*level);
  }
  std::vector<std::string> meant;
  if (!options.near.empty()) meant.push_back(options.near);
  const auto here = index_here(options.choice, meant);
  if (!here) return refuse(here.error());
  return tell_found(options, seek_by_feel(here->index(), request_of(options.choice),
                                          {options.texts, options.kind, options.near, levels, options.most}));
}

int find(const FindOptions& options) {
  if (options.by_feel() || !options.choice.file.empty()) return find_by_feel(options);
  const std::vector<std::string> roots = library_folders(options.choice.folders, std::getenv("WALE_LIBRARY"));
  const auto resolver = file_resolver(roots);
  // The index of what a file in the current folder could import; there need not be such a file.
  const std::shared_ptr<const LibraryIndex> index = library_index(*resolver, "here");
  if (const auto& left_out = index->left_out(); !left_out.empty())
    print_error(fmt::format("wale: `{}`{} not searched: the modules before have {} MB, the most that are read\n",
                            visible_text(left_out.front()),
                            left_out.size() > 1 ? fmt::format(" and {} more are", left_out.size() - 1) : " is",
                            most_indexed >> 20));
  const FoundByWords words = seek_by_words(*index, {options.texts, options.kind, {}, {}, options.most});
  const std::vector<FoundMaterial>& found = words.as_they_stand;
  warn_of_library_variable();
  say_unread(roots);
  if (!words.most_words.empty()) {
    const int told = tell_found(options, FoundEntries{words.most_words, words.most_words.size()});
    if (!words.have_all && !options.json) print_out("none has all of these words; these have the most of them\n");
    return told;
  }
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
      "documentation; of several, those that have all, or else the most (default: lists every material)");
  verb.add_option("--kind", options->kind,
                  "only materials of this kind, as in fabric or fabric.woven (default: all kinds)")
      ->type_name("KIND");
  must_say(verb.add_option("--near", options->near,
                           "those that feel most like this material, by its name or a Wale file of your own")
               ->type_name("MATERIAL"),
           "a material", "for example, `wale find --near corduroy`");
  common_modules()->declarations.percepts.each([&](const std::string& name, const Percept& percept) {
    if (!percept.has_reference) return;
    must_say(verb.add_option("--" + name, options->levels[name],
                             fmt::format("those whose {} is nearest to a level, or lies in a range: 0.6, 0.4..0.7", name))
                 ->type_name("LEVEL"),
             "a level");
    if (!percept.antonym.empty())
      must_say(verb.add_option("--" + percept.antonym, options->levels[percept.antonym],
                               fmt::format("the same from the other end of the scale of {}", name))
                   ->type_name("LEVEL"),
               "a level");
  });
  offer_count(verb, "--most", options->most, {.least = 1, .most = 1'000'000, .example = 20},
              "so many at most (default: 20 by feel, all by words)");
  offer_index(verb, options->choice);
  offer_json(verb, options->json, "an array with all facts about each material");
  verb.footer(
      "By feel, the nearest come first, in just noticeable differences. A cue that is unknown for one of the two is named:\n"
      "nobody knows how much more they differ, and in the order it counts as one difference more.\n"
      "for example: wale find ribbed;  wale find --kind fabric cotton;  wale find --near corduroy;\n"
      "             wale find --roughness 0.4..0.6 --stickiness 0.2 --kind paper");
  return [options] { return find(*options); };
}

}  // namespace

extern const Verb find_verb{
    "find", "lists the materials of the library and of your .wale files here, or those with these words", declare_find};

}  // namespace wale::command
