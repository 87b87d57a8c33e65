#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/command/recalled.hpp"
#include "compiler/compare/propose_levels.hpp"

namespace wale::command {
namespace {

struct LevelsOptions {
  std::string percept;
  Choice choice;                       ///< only of the device
  std::optional<std::uint64_t> steps;  ///< number of levels; by default as many as are recognised
  bool side_by_side = false;           ///< as many as can be told apart
  std::optional<double> apart;         ///< in just noticeable differences; 1 by default
  bool json = false;
};

int levels(const LevelsOptions& options) {
  const CheckedModule known = known_here(options.choice.request());
  if (const auto has = has_device(known, options.choice); !has) return refuse(has.error());
  warn_of_device_files(options.choice);
  const bool to_recognise = !options.steps && !options.apart && !options.side_by_side;
  const auto proposed = to_recognise
                            ? propose_recognised_levels(options.percept, options.choice.device, 1, known.declarations())
                            : propose_levels(options.percept, options.choice.device, options.steps,
                                             options.apart.value_or(1), known.declarations());
  if (!proposed) return refuse(proposed.error());
  std::set<const Threshold*> recalled;
  for (const ProposedLevel& each : proposed->levels)
    if (each.threshold && each.threshold->recalled()) recalled.insert(each.threshold);
  print_recalled(recalled);
  print_out(options.json ? proposal_json(*proposed) : proposal_text(*proposed));
  return done;
}

Run declare_levels(CLI::App& verb) {
  const auto options = std::make_shared<LevelsOptions>();
  must_say(verb.add_option("PERCEPT", options->percept, "a percept or its opposite, as in roughness or smoothness"),
           "the name of a percept")
      ->required();
  offer_device(verb, options->choice, "--device", help_text::device_alone);
  offer_count(verb, "--steps", options->steps, {.least = 2, .most = 1000, .example = 5},
              "how many levels, as in 5 (default: as many as people recognise when each is felt alone)");
  verb.add_flag("--side-by-side", options->side_by_side,
                "as many levels as people can tell apart when they feel one after the other");
  offer_number(
      verb, "--jnd", options->apart, {.least = 0.01, .most = 1000, .example = 1.5},
      "how far apart neighbouring levels are at least, in just noticeable differences: at 1, people are right about "
      "three times in four (default: 1); without --steps as many levels as fit");
  offer_json(verb, options->json, "the result as a JSON object");
  verb.footer("for example: wale levels roughness --device falcon --steps 5");
  return [options] { return levels(*options); };
}

}  // namespace

extern const Verb levels_verb{
    "levels", "proposes levels of a percept that people recognise, or tell apart, on a device", declare_levels};

}  // namespace wale::command
