#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "compiler/compare/compare.hpp"
#include "compiler/compare/propose_levels.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/describe/describe_figure.hpp"
#include "compiler/text/json_text.hpp"
#include "compiler/text/readable.hpp"

namespace wale {

namespace {

/// The grade of the number of recognised levels; beyond the sizes that were compared it is extrapolated.
std::string recognition_word(const LevelProposal& proposal) {
  const bool compared = proposal.recognition->compared(proposal.levels.front().size, proposal.levels.back().size);
  return compared ? evidence_word(proposal.recognition_evidence) : "extrapolated";
}

}  // namespace

std::string levels_line(const LevelProposal& proposal) {
  std::vector<std::string> levels;
  const std::size_t count = proposal.levels.size();
  for (std::size_t i = 0; i < count; ++i)
    levels.push_back(fmt::format("level_{} {}", i + 1, proposal.levels[proposal.reversed ? count - 1 - i : i].level));
  return fmt::format("levels {} {{ {} }}", proposal.percept, fmt::join(levels, "; "));
}

std::string proposal_text(const LevelProposal& proposal) {
  const std::size_t count = proposal.levels.size();
  std::string text =
      fmt::format("{} levels of {} on {}, over the range that {} and that it renders\n", count, proposal.asked,
                  proposal.device, proposal.map->valid_assumed ? "is assumed for its map" : "was measured");
  text += fmt::format("  {:<14} {:>8}  {:>14}  apart\n", "", "level", proposal.carrier);
  std::set<const Threshold*> thresholds;
  for (std::size_t i = 0; i < count; ++i) {
    const ProposedLevel& each = proposal.levels[proposal.reversed ? count - 1 - i : i];
    const ProposedLevel& after = proposal.reversed && i > 0 ? proposal.levels[count - i] : each;
    const std::string apart = i == 0 ? "-" : fmt::format("{:.2f}", after.apart);
    text += fmt::format("  {:<14} {:>8.{}f}  {:>14}  {:>5}", fmt::format("level_{}", i + 1),
                        proposal.reversed ? 1 - each.level : each.level, proposal.digits,
                        fmt::format("{} {}", with_digits(each.size, 3), proposal.unit), apart);
    if (i > 0 && after.floor)
      text += fmt::format("  ({})", floor_words(*after.floor, after.least, proposal.unit));
    else if (i > 0 && after.threshold)
      text += fmt::format("  ({}: {})", after.outside.empty() ? evidence_word(after.evidence) : "extrapolated",
                          after.threshold->source);
    text += '\n';
    if (after.threshold && !after.floor) thresholds.insert(after.threshold);
  }
  text += "  apart: just noticeable differences at d' = 1 from the level before";
  for (const Threshold* each : thresholds)
    text += readable(";\n  Weber fraction {:.2g} ({}, {})", each->weber, each->source, threshold_conditions(*each));
  text +=
      fmt::format("\n  {} by {} ({})\n", proposal.carrier, proposal.map->source, evidence_word(proposal.map_evidence));
  text += fmt::format("  told apart side by side: {} levels{}\n", proposal.most,
                      proposal.most > count ? "; `--side-by-side` proposes them" : "");
  if (proposal.apart != 1)
    text += readable("  {:.4g} just noticeable differences apart or more: {} levels\n", proposal.apart, proposal.fit);
  if (!proposal.beside.empty())
    text += readable("  felt in the face of a wall only: ask for {} too, or write a wall\n", proposal.beside);
  if (const Threshold* found = proposal.recognition)
    text += readable("  recognised alone: about {:.0f} ({:.2g} within {}: {}, {})\n", std::round(found->recognised),
                     found->recognised, found->valid ? found->valid->written : "an unknown range", found->source,
                     recognition_word(proposal));
  else
    text += "  recognised alone: unknown; nobody has published it for this cue. Expect far fewer than side by side\n";
  if (proposal.recognition && count > proposal.recognised())
    text += "  these levels are for comparing, not for naming: people confuse them when each is felt alone\n";
  return text + '\n' + levels_line(proposal) + '\n';
}

std::string proposal_json(const LevelProposal& proposal) {
  using Json = nlohmann::ordered_json;
  Json json = {{"asked", proposal.asked},
               {"percept", proposal.percept},
               {"device", proposal.device},
               {"carrier", proposal.carrier},
               {"unit", proposal.unit},
               {"map", {{"source", proposal.map->source}, {"evidence", evidence_word(proposal.map_evidence)}}},
               {"most", proposal.most},
               {"apart", proposal.apart},
               {"fit", proposal.fit},
               {"beside", proposal.beside.empty() ? Json(nullptr) : Json(proposal.beside)}};
  Json& alone = json["recognised_alone"] = nullptr;
  if (const Threshold* found = proposal.recognition)
    alone = Json{{"levels", found->recognised},
                 {"source", found->source},
                 {"evidence", recognition_word(proposal)},
                 {"valid", found->valid ? Json(found->valid->written) : Json(nullptr)}};
  Json& levels = json["levels"] = Json::array();
  for (const ProposedLevel& each : proposal.levels) {
    Json& level = levels.emplace_back(Json{{"level", each.level}, {"size", each.size}});
    if (proposal.reversed) level[proposal.asked] = 1 - each.level;
    level["apart"] = levels.size() == 1 ? Json(nullptr) : Json(each.apart);
    if (each.threshold) write_threshold(level, *each.threshold, each.evidence, each.outside);
    if (each.floor) write_floor(level, *each.floor, each.least);
  }
  json["wale"] = levels_line(proposal);
  return json_lines(json);
}

}  // namespace wale
