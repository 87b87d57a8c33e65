#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "compiler/command/print.hpp"
#include "compiler/text/json_text.hpp"
#include "library/command/index_here.hpp"
#include "library/store/seek.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct BetweenOptions {
  std::string one, other, kind;
  IndexChoice choice;
  std::optional<std::uint64_t> most;
  bool json = false;
};

int between(const BetweenOptions& options) {
  warn_of_library_variable();
  const auto here = index_here(options.choice, {options.one, options.other});
  if (!here) return refuse(here.error());
  const auto found = seek_between(here->index(), request_of(options.choice), options.one, options.other, options.kind,
                                  options.most.value_or(usually_between));
  if (!found) return refuse(found.error());
  if (options.json) {
    auto json = nlohmann::ordered_json::array();
    for (const FoundBetween::Each& each : found->found)
      json.push_back({{"name", each.found.entry.name},
                      {"title", each.found.entry.title},
                      {"kind", each.found.entry.kind},
                      {"from_first", distance_json(each.from_one)},
                      {"from_second", distance_json(each.from_other)}});
    print_out(json_lines(json));
  }
  if (found->found.empty())
    return refuse(Error{.code = Code::unknown_name,
                        .sentence = fmt::format("no material lies between `{}` and `{}`: none is nearer to both than they are "
                                                "to each other",
                                                visible_text(found->one), visible_text(found->other)),
                        .mend = "`between(A, B, 0.5)` in a Wale file makes one of two settings of one material, `0.5 A + 0.5 B` "
                                "mixes any two"});
  if (options.json) return done;
  std::size_t width = 0;
  for (const FoundBetween::Each& each : found->found) width = std::max(width, each.found.entry.name.size());
  for (const FoundBetween::Each& each : found->found)
    print_out("{:{}}  from {}: {}\n{:{}}  from {}: {}\n", each.found.entry.name, width, found->one,
              distance_text(each.from_one), "", width, found->other, distance_text(each.from_other));
  return done;
}

Run declare_between(CLI::App& verb) {
  const auto options = std::make_shared<BetweenOptions>();
  must_say(verb.add_option("A", options->one, "a material of the library, or of a Wale file of your own"), "a material")
      ->required();
  must_say(verb.add_option("B", options->other, "another one"), "a material")->required();
  verb.add_option("--kind", options->kind, "only materials of this kind (default: all kinds)")->type_name("KIND");
  offer_count(verb, "--most", options->most, {.least = 1, .most = 1'000'000, .example = 10},
              "so many at most (default: 10)");
  offer_index(verb, options->choice);
  offer_json(verb, options->json, "an array of those materials, with their distances from the two");
  verb.footer(
      "What is nearer to each of the two than they are to one another, that with the shorter longer way first.\n"
      "for example: wale between silk_charmeuse cotton_fleece");
  return [options] { return between(*options); };
}

}  // namespace

extern const Verb between_verb{"between", "lists the materials that lie between two, to the hand", declare_between};

}  // namespace wale::command
