#include "compiler/evidence/confirm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/declarations/dimension.hpp"
#include "compiler/diagnostics/advice.hpp"
#include "compiler/emit/emit.hpp"
#include "compiler/emit/lower.hpp"
#include "compiler/evidence/correct_fate.hpp"
#include "compiler/read/tolerances.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

/// The relief of these carriers' forces together and without any other, as far as no device limits it. `transcript` is
/// of the reading of the whole material: where no other force pushes a resting hand, that one is the same.
Relief relief_of(const SolvedMaterial& solved, const std::vector<std::array<TermId, 2>>& forces,
                 StaticTranscript& transcript, KeptReadings* kept) {
  SolvedMaterial alone = solved;
  alone.force = forces.front();
  for (std::size_t i = 1; i < forces.size(); ++i)
    for (std::size_t axis = 0; axis < 2; ++axis)
      alone.force[axis] = alone.terms.apply(Operation::add, alone.force[axis], forces[i][axis]);
  alone.limited = false;  // its shape counts, and not how much the device gives
  alone.percepts.clear(), alone.fates.clear(), alone.marks.clear();
  Diagnostics diagnostics;
  const LoweredMaterial lowered = lower(alone, diagnostics);
  if (diagnostics.has_errors()) return {};
  auto program = emit(lowered, alone, diagnostics);
  if (!program) return {};
  const auto loaded = Program::load(std::move(*program));
  if (!loaded) return {};
  ReadFirst first;
  first.kept = kept;
  (void)read_relief(Bank(*loaded), first, transcript);
  return first.still ? first.still->relief : Relief{};
}

void report_outside(const PerceptRecord& record, const OutsideRange& outside, Span place, Diagnostics& diagnostics) {
  const auto shown = [&](double value) {
    return readable("{:.3g}{}{}", value / outside.unit_in_si, outside.unit.empty() ? "" : " ", outside.unit);
  };
  const bool from = std::isfinite(outside.low) && outside.low > 0, to = std::isfinite(outside.high);
  const std::string quantity = with_article(outside.quantity);
  const std::string range = from && to ? fmt::format("from {} to {}", shown(outside.low), shown(outside.high))
                            : from     ? fmt::format("of {} or more", shown(outside.low))
                                       : fmt::format("of {} or less", shown(outside.high));
  diagnostics.report(
      Advice(fmt::format("beyond it nobody knows how {} grows; choose {} in this range, or describe the material by "
                         "its physics alone",
                         record.name, quantity))
          .fact("found", outside.value / outside.unit_in_si, outside.unit)
          .about(Code::beyond_validity, place,
                 fmt::format("expected {} {}, the {} range, found {} ({})", quantity, range,
                             outside.assumed ? "assumed" : "measured", shown(outside.value), record.source)));
}

void report_difference(const PerceptRecord& record, const PerceptReading& told, double asked, const std::string& cause,
                       Span place, Diagnostics& diagnostics) {
  diagnostics.report(
      Advice("change the other forces or the level until they agree; a level with a tolerance, as in "
             "`" +
             typeable("{} {:.2g} +- {:.2g}", record.name, asked, std::ceil(20 * std::abs(told.level - asked)) / 20) +
             "`, says that you know")
          .fact("asked", asked)
          .fact("reads", told.level)
          .about(Code::delivered_otherwise, place,
                 readable("{} {:.3g} is asked for, and the finished program reads {:.2g}: {}", record.name, asked,
                          told.level, cause)));
}

}  // namespace

BandShares band_shares(const Bank& bank, ReadFirst& first, const SolvedMaterial& solved,
                       const Declarations& declarations) {
  struct Texture {
    const PerceptRecord* record = nullptr;
    double aimed = 0;
  };
  std::vector<Texture> textures;
  std::vector<std::array<TermId, 2>> forces;
  bool as_aimed = true;
  StaticTranscript transcript;
  std::optional<ForceReading> found;
  for (std::size_t i = 0; i < solved.percepts.size(); ++i) {
    const SolvedPercept& percept = solved.percepts[i];
    const PerceptRecord& record = percept.record;
    const bool is_solved = record.parameter || record.blended;
    if (!percept.asked || !is_solved || record.extractor != Extractor::lateral_force) continue;
    if (std::ranges::find(forces, percept.force) != forces.end()) continue;
    if (!found) found = read_relief(bank, first, transcript);
    if (!found) found = read_again(bank, declarations, parts_for(bank.program().description()), first);
    const PerceptReading told = percept_reading(bank, i, *found, declarations);
    as_aimed = as_aimed && told.size == told.aimed;
    textures.push_back({&record, told.aimed}), forces.push_back(percept.force);
  }
  BandShares shares;
  if (as_aimed) return shares;
  const Relief relief = relief_of(solved, forces, transcript, first.kept);
  if (!(relief.amplitude > 0)) return shares;
  for (const auto& [record, aimed] : textures) {
    const Percept banded{
        .name = record->name, .extractor = record->extractor, .period = {record->period_low, record->period_high}};
    const double inside = relief.within(band_of(banded, declarations));
    // One force has its amplitude by definition. What several have together is read.
    const double share = inside / (forces.size() == 1 ? relief.amplitude : aimed);
    const bool counts = inside >= least_of_relief * relief.amplitude && aimed > 0;
    const Percept* declared = declarations.percepts.find(record->name);
    // The spectrum of an irregular relief has tails in every band, so its share is less sharp.
    const double least = !declared ? 0 : relief.regular() ? declared->least_share : declared->least_irregular_share;
    if (counts && std::abs(share - 1) > least) shares[record->name] = as_kept(share);
  }
  return shares;
}

std::optional<std::vector<FateRecord>> confirm(const Bank& bank, const ForceReading& found,
                                               const SolvedMaterial& solved, const CheckedMaterial& material,
                                               const Declarations& declarations, bool doubted,
                                               Diagnostics& diagnostics) {
  std::vector<FateRecord> fates = solved.fates;
  bool changed = false;
  for (std::size_t i = 0; i < solved.percepts.size(); ++i) {
    const SolvedPercept& percept = solved.percepts[i];
    const PerceptRecord& record = percept.record;
    const auto asked = std::ranges::find(material.percepts, record.name, &AskedPercept::name);
    const auto fate =
        std::ranges::find_if(fates, [&](const FateRecord& each) { return each.percept && each.name == record.name; });
    if (!percept.asked || asked == material.percepts.end() || fate == fates.end()) continue;
    const auto correction = correct_fate(*fate, bank, i, *percept.asked, found, declarations);
    if (!correction) continue;
    changed = true;
    fate->given = std::clamp(fate->given, 0.0f, 1.0f);  // as a program may hold it
    if (doubted && correction->told.size == 0) continue;
    const std::vector<OutsideRange> outside = outside_ranges(record, correction->told);
    for (const OutsideRange& each : outside) report_outside(record, each, asked->place(), diagnostics);
    // A force that is switched or swells while it is felt reads as its author meant; a constant factor has its own
    // warning.
    const auto changes = [&](TermId force) { return material.terms.dependence(force).changing(); };
    const bool as_meant = !record.basis.summand && (!material.scaled_textures.empty() || !material.force ||
                                                    changes((*material.force)[0]) || changes((*material.force)[1]));
    // That a program pushes nowhere has a warning of its own, with this cause.
    const bool never_pushes = std::ranges::any_of(diagnostics.all(), [&](const Diagnostic& each) {
      return each.code == Code::never_pushes && each.span == solved.force_span;
    });
    const PerceptReading& told = correction->told;
    const bool noticed = differs(record, told.aimed, *percept.asked, told.size, told.level);
    if (outside.empty() && noticed && !as_meant && !never_pushes)
      report_difference(record, correction->told, *percept.asked, correction->why, asked->place(), diagnostics);
  }
  return changed ? std::optional(std::move(fates)) : std::nullopt;
}

}  // namespace wale
