#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "compiler/command/print.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/text/json_text.hpp"
#include "library/command/index_here.hpp"
#include "library/index/find.hpp"
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
  const auto here = index_here(options.choice);
  if (!here) return refuse(here.error());
  const MaterialIndex& index = here->index();
  const auto one = felt_material(index, options.choice, options.one);
  if (!one) return refuse(one.error());
  const auto other = felt_material(index, options.choice, options.other);
  if (!other) return refuse(other.error());
  const auto declared = common_modules();
  const Comparer comparer(declared->declarations, index.device());
  const BetweenProbe probe(comparer, one->cues, other->cues);
  constexpr std::uint64_t usually_given = 10;
  MaterialQuery sought{.texts = {}, .kind = options.kind, .feel = &probe, .without = one->is,
                .most = options.most.value_or(usually_given)};
  sought.without.insert(sought.without.end(), other->is.begin(), other->is.end());
  const auto found = find_entries(index, sought);
  if (!found) return refuse(found.error());
  const auto from = [&](const NearProbe& end, const FoundEntry& each) {
    const MaterialIndex& all = index;
    const auto meant = meant_entry(all, each.entry.module + "." + each.entry.name);
    return end.tell(all.columns(), meant ? all.columns().row_of(*meant).value_or(0) : 0);
  };
  if (options.json) {
    auto json = nlohmann::ordered_json::array();
    for (const FoundEntry& each : found->entries)
      json.push_back({{"name", each.entry.name},
                      {"title", each.entry.title},
                      {"kind", each.entry.kind},
                      {"from_first", distance_json(from(probe.one(), each))},
                      {"from_second", distance_json(from(probe.other(), each))}});
    print_out(json_lines(json));
  }
  if (found->entries.empty())
    return refuse(Error{.code = Code::unknown_name,
                        .sentence = fmt::format("no material lies between `{}` and `{}`: none is nearer to both than they are "
                                                "to each other",
                                                visible_text(one->name), visible_text(other->name)),
                        .mend = "`between(A, B, 0.5)` in a Wale file makes one of two settings of one material, `0.5 A + 0.5 B` "
                                "mixes any two"});
  if (options.json) return done;
  std::size_t width = 0;
  for (const FoundEntry& each : found->entries) width = std::max(width, each.entry.name.size());
  for (const FoundEntry& each : found->entries)
    print_out("{:{}}  from {}: {}\n{:{}}  from {}: {}\n", each.entry.name, width, one->name,
              distance_text(from(probe.one(), each)), "", width, other->name, distance_text(from(probe.other(), each)));
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
