#pragma once

#include <vector>

#include "compiler/describe/describe.hpp"

namespace wale {

/// The percepts that a program has a record of. `found` is the reading of the bank.
std::vector<DescribedPercept> recorded_percepts(const Bank& bank, const ForceReading& found,
                                                const Declarations& declarations);

/// Adds what each percept whose level is a parameter reads at the least, the middle and the greatest level. Runs the
/// program at each.
void tell_settings(std::vector<DescribedPercept>& percepts, const Bank& bank, const ForceReading& found,
                   const Declarations& declarations);

/// Adds where each other parameter ends what the percepts read that are asked for, if people would notice that it is
/// another level. Runs the program there, unless it costs much.
void tell_ends(std::vector<DescribedPercept>& percepts, const Bank& bank, const ForceReading& found,
               const Declarations& declarations);

/// Fills in the map, the grades, the intervals and what is outside or assumed of a percept whose size and level are
/// known, by a record of its map.
void tell_evidence(DescribedPercept& percept, const PerceptRecord& record, const Bank& bank, const ForceReading& found,
                   const Declarations& declarations);

}  // namespace wale
