#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/command/recalled.hpp"
#include "compiler/compare/propose_levels.hpp"
#include "compiler/compile.hpp"
#include "compiler/evidence/percept_reading.hpp"

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

/// Why a material with nothing but that percept does not have one of the proposed levels on the device, as its finished
/// program reads; nothing if it has all, or if the device makes no force of it alone.
std::optional<Error> unread_level(const LevelProposal& proposal, const FileRequest& request,
                                  const Declarations& declarations) {
  const DeviceDeclaration* device = declarations.devices.find(proposal.device);
  if (!device || device->profile.shaker || proposal.levels.empty()) return std::nullopt;
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver(request.roots, nullptr, request.sandbox, request.devices);
  const std::string text = fmt::format("wale 1\nmaterial alone {{ perceptual {{ {} {} }} }}\n", proposal.percept,
                                       proposal.levels.back().level);
  const auto program = compile(sources, sources.add("levels", text), "alone", proposal.device, *resolver, diagnostics);
  if (!program) return std::nullopt;
  const auto& percepts = program->description().percepts;
  const auto record = std::ranges::find(percepts, proposal.percept, &PerceptRecord::name);
  if (record == percepts.end() || !record->parameter) return std::nullopt;
  for (const ProposedLevel& each : proposal.levels) {
    std::vector<float> values;
    for (const Parameter& parameter : program->description().parameters) values.push_back(parameter.value);
    values[*record->parameter] = static_cast<float>(each.level);
    const Bank bank(*program, values, program->default_size());
    const ForceReading found = read(bank, declarations, parts_for(record->extractor));
    const auto index = static_cast<std::size_t>(record - percepts.begin());
    const PerceptReading told = percept_reading(bank, index, found, declarations);
    if (told.readable && told.size == 0)
      return Error{Code::percept_unrealised,
                   fmt::format("no hand on `{}` meets {} {:.{}f}: its finished program reads 0", proposal.device,
                               proposal.percept, each.level, proposal.digits),
                   stands_outside(*record, found) ? "its wall stands outside of the patch of that device"
                                                  : "its patch or its speed is too small for it"};
  }
  return std::nullopt;
}

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
  if (const auto unread = unread_level(*proposed, options.choice.request(), known.declarations()))
    return refuse(*unread);
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
