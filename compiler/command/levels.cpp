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

/// What the finished program of one material has of the proposed levels.
struct LevelsRead {
  std::optional<Error> missing;  ///< why it does not have one of them
  bool lacks_wall = false;       ///< it is felt in a wall, and has none
};

/// A material with that percept on the device, and with another one beside it unless that is empty. Nothing is missing
/// if the device makes no force of it.
LevelsRead levels_read(const LevelProposal& proposal, const std::string& beside, const FileRequest& request,
                       const Declarations& declarations) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver(request.roots, nullptr, request.sandbox, request.devices);
  const std::string text =
      fmt::format("wale 1\nmaterial alone {{ perceptual {{ {} {}{} }} }}\n", proposal.percept,
                  proposal.levels.back().level, beside.empty() ? "" : fmt::format("; {} 1", beside));
  const auto program = compile(sources, sources.add("levels", text), "alone", proposal.device, *resolver, diagnostics);
  if (!program) return {};
  const auto& percepts = program->description().percepts;
  const auto record = std::ranges::find(percepts, proposal.percept, &PerceptRecord::name);
  if (record == percepts.end() || !record->parameter) return {};
  for (const ProposedLevel& each : proposal.levels) {
    std::vector<float> values;
    for (const Parameter& parameter : program->description().parameters) values.push_back(parameter.value);
    values[*record->parameter] = static_cast<float>(each.level);
    const Bank bank(*program, values, program->default_size());
    const ForceReading found = read(bank, declarations, parts_for(record->extractor));
    const auto index = static_cast<std::size_t>(record - percepts.begin());
    const PerceptReading told = percept_reading(bank, index, found, declarations);
    if (told.readable && told.size == 0)
      return {Error{Code::percept_unrealised,
                    fmt::format("no hand on `{}` meets {} {:.{}f}: its finished program reads 0", proposal.device,
                                proposal.percept, each.level, proposal.digits),
                    stands_outside(*record, found) ? "its wall stands outside of the patch of that device"
                                                   : "its patch or its speed is too small for it"},
              !found.wall && record->extractor == Extractor::wall_damping};
  }
  return {};
}

/// Why a hand does not meet one of the proposed levels on the device; nothing if it meets all. What is felt in a wall
/// is looked for beside one, which the proposal then names.
std::optional<Error> unread_level(LevelProposal& proposal, const FileRequest& request,
                                  const Declarations& declarations) {
  const DeviceDeclaration* device = declarations.devices.find(proposal.device);
  if (!device || device->profile.shaker || proposal.levels.empty()) return std::nullopt;
  LevelsRead alone = levels_read(proposal, {}, request, declarations);
  if (!alone.lacks_wall) return alone.missing;
  std::string wall;
  declarations.percepts.each([&](const std::string& name, const Percept& percept) {
    if (wall.empty() && percept.extractor == Extractor::wall_stiffness && percept.has_reference) wall = name;
  });
  if (wall.empty()) return alone.missing;
  LevelsRead beside = levels_read(proposal, wall, request, declarations);
  if (!beside.missing) proposal.beside = wall;
  return beside.missing;
}

int levels(const LevelsOptions& options) {
  const CheckedModule known = known_here(options.choice.request());
  if (const auto has = has_device(known, options.choice); !has) return refuse(has.error());
  warn_of_device_files(options.choice);
  const bool to_recognise = !options.steps && !options.apart && !options.side_by_side;
  auto proposed = to_recognise
                      ? propose_recognised_levels(options.percept, options.choice.device, 1, known.declarations())
                      : propose_levels(options.percept, options.choice.device, options.steps, options.apart.value_or(1),
                                       known.declarations());
  if (!proposed) return refuse(proposed.error());
  if (const auto unread = unread_level(*proposed, options.choice.request(), known.declarations()))
    return refuse(*unread);
  std::set<const Threshold*> recalled;
  for (const ProposedLevel& each : proposed->levels) {
    const Threshold* decides = each.floor ? each.floor : each.threshold;
    if (decides && decides->recalled()) recalled.insert(decides);
  }
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
