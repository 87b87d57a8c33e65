#include "compiler/evidence/correct_fate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wale {

double as_kept(double value) {
  constexpr double thousand = 1000;
  return std::round(value * thousand) / thousand;
}

std::optional<FateCorrection> correct_fate(FateRecord& fate, const Bank& bank, std::size_t index, double asked,
                                           const ForceReading& found, const Declarations& declarations) {
  const PerceptRecord& record = bank.program().description().percepts[index];
  FateCorrection correction{.told = percept_reading(bank, index, found, declarations)};
  correction.why = why_approximated(record, correction.told, asked, found, declarations);
  if (correction.why.empty()) return std::nullopt;
  if (fate.fate == Fate::saturated && outside_ranges(record, correction.told).empty()) return std::nullopt;
  if (fate.fate == Fate::kept) fate.fate = Fate::approximated;
  // Of what is unknown there is no level, so only the reason says it.
  if (fate.fate != Fate::saturated && !correction.told.unknown)
    fate.given = static_cast<float>(std::max(correction.told.level, 0.0));
  fate.reason = fate.reason.empty() ? correction.why : fmt::format("{}; {}", correction.why, fate.reason);
  return correction;
}

}  // namespace wale
