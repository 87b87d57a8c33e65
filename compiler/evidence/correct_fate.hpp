#pragma once

#include <optional>
#include <string>

#include "compiler/evidence/percept_reading.hpp"

namespace wale {

/// A number that is read and kept in a program or told beside it: with three decimals, so that neither depends on the
/// last bits of a spectrum.
double as_kept(double value);

/// What a finished program reads of a percept that its fate does not say.
struct FateCorrection {
  PerceptReading told;
  std::string why;  ///< in a line
};

/// Corrects the fate of percept number `index`, which is asked for at the level `asked`, by what the program reads at
/// the bank's parameters: *kept* becomes *approximated*, with the level read, which may be above 1, and the reason
/// comes first. A percept
/// that is *saturated* reads less as everyone knows, so only what is outside of what was measured is added. Nothing,
/// and the fate stays as it is, if the program reads what is asked for.
std::optional<FateCorrection> correct_fate(FateRecord& fate, const Bank& bank, std::size_t index, double asked,
                                           const ForceReading& found, const Declarations& declarations);

}  // namespace wale
