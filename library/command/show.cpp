#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "compiler/command/print.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/text/json_text.hpp"
#include "compiler/text/readable.hpp"
#include "library/command/index_here.hpp"
#include "library/index/entry_json.hpp"
#include "library/index/find.hpp"
#include "library/store/seek.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct ShowOptions {
  std::string name;
  IndexChoice choice;
  bool json = false;
};

constexpr std::size_t neighbours_shown = 5;

std::string percept_text(const EntryPercept& percept) {
  std::string text = fmt::format("  {:<13}", percept.name);
  text += percept.asked ? readable("asked {:.2f}{}, ", *percept.asked,
                                   percept.claimed ? fmt::format(" ({})", evidence_word(*percept.claimed)) : "")
                        : "";
  if (percept.lost) return text + "lost on this device\n";
  if (!percept.reads) return text + "reads unknown" + (percept.outside.empty() ? "" : ": " + percept.outside.front()) + "\n";
  text += readable("reads {:.2f} from {} {:.3g} {}; 95 % of the means of groups: {}{:.2f} .. {:.2f}; {}", *percept.reads,
                   percept.carrier, percept.size, percept.unit, percept.means_differ_more ? "at least " : "",
                   percept.means.low, percept.means.high, evidence_word(percept.evidence()));
  return text + "\n";
}

std::string entry_text(const Entry& entry) {
  const auto line = [](const char* what, const std::string& text) {
    return text.empty() ? std::string() : fmt::format("  {:<13}{}\n", what, visible_text(text));
  };
  std::string text = fmt::format("{} ({})\n", visible_text(entry.title.empty() ? entry.name : entry.title), entry.name);
  text += line("kind", entry.kind) + line("file", entry.file) + line("import", entry.module);
  std::map<std::string, std::vector<std::string>> names;
  for (const EntryName& each : entry.names) names[each.language].push_back(each.text);
  for (const auto& [language, all] : names)
    text += line(fmt::format("called {}", visible_text(language)).c_str(), fmt::format("{}", fmt::join(all, ", ")));
  text += line("feels", fmt::format("{}", fmt::join(entry.feels, ", ")));
  text += line("replaces", fmt::format("{}", fmt::join(entry.replaces, ", ")));
  text += line("licence", entry.licence.empty() ? "none: it may not be passed on" : entry.licence);
  for (const std::string& each : entry.sources) text += line("source", each);
  text += line("says", entry.documentation);
  text += fmt::format("\nfeels, on {}\n", entry.device);
  if (!entry.trouble.empty()) return text + "  it does not compile: " + visible_text(entry.trouble) + "\n";
  for (const EntryPercept& each : entry.felt.percepts) text += percept_text(each);
  if (entry.felt.percepts.empty()) text += "  no percept that a map tells\n";
  if (!entry.parameters.empty()) text += "\nparameters\n";
  for (const Parameter& each : entry.parameters)
    text += readable("  {:<13}{:.4g} in {:.4g} .. {:.4g}{}\n", each.name, each.value / each.unit_in_si,
                     each.low / each.unit_in_si, each.high / each.unit_in_si,
                     each.unit.empty() ? "" : " " + each.unit);
  return text;
}

int show(const ShowOptions& options) {
  warn_of_library_variable();
  const auto here = index_here(options.choice, {options.name});
  if (!here) return refuse(here.error());
  const MaterialIndex& index = here->index();
  const auto meant = meant_entry(index, options.name);
  if (!meant) {
    Error error = meant.error();
    if (options.name.find(".wale") != std::string::npos)
      error.mend = fmt::format("`wale describe {0}` says what it feels like, and `wale find --near {0}` what feels like that",
                               visible_text(options.name));
    return refuse(error);
  }
  const auto entry = index.entry(*meant);
  if (!entry) return refuse(entry.error());
  FoundEntries near;
  if (entry->felt.cues) {
    const auto declared = common_modules();
    const Comparer comparer(declared->declarations, index.device());
    const NearProbe probe(comparer, *entry->felt.cues);
    auto found = find_entries(index, {.texts = {},
                                      .kind = {},
                                      .feel = &probe,
                                      .without_kinds = kinds_left_out(entry->kind, entry->module),
                                      .without = {*meant},
                                      .most = neighbours_shown});
    if (!found) return refuse(found.error());
    near = *std::move(found);
  }
  if (options.json) {
    auto json = entry_json(*entry);
    json["nearest"] = nlohmann::ordered_json::array();
    for (const FoundEntry& each : near.entries)
      json["nearest"].push_back({{"name", each.entry.name}, {"distance", distance_json(*each.apart)}});
    print_out(json_lines(json));
    return done;
  }
  std::string text = entry_text(*entry);
  if (!near.entries.empty()) text += "\nnearest, in just noticeable differences\n";
  std::size_t width = 0;
  for (const FoundEntry& each : near.entries) width = std::max(width, each.entry.name.size());
  for (const FoundEntry& each : near.entries)
    text += fmt::format("  {:{}}  {}\n", each.entry.name, width, distance_text(*each.apart));
  print_out(text);
  return done;
}

Run declare_show(CLI::App& verb) {
  const auto options = std::make_shared<ShowOptions>();
  must_say(verb.add_option("NAME", options->name,
                           "a material of the library, by its name, a title, or what people call it"),
           "the name of a material", "`wale find` lists them")
      ->required();
  offer_index(verb, options->choice);
  offer_json(verb, options->json, "all that is known of it, as an object");
  verb.footer(
      "`wale describe` says more of what it does, `wale preview` draws it, `wale compare` holds two side by side.\n"
      "for example: wale show corduroy;  wale show \"beurre de cacahuète\"");
  return [options] { return show(*options); };
}

}  // namespace

extern const Verb show_verb{"show", "says what the library knows of a material, and which feel most like it", declare_show};

}  // namespace wale::command
