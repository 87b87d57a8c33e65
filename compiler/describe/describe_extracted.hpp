#pragma once

#include "compiler/declarations/declarations.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/extract/extract.hpp"

namespace wale {

/// What follows from a level and its map's doubts: both 95 % intervals, by the scatter of means (of log10 magnitude)
/// and the spread of single observers' exponents (0: not known), and whether it is near the threshold. `size_over_one`
/// is the carrier's size over that of the reference stimulus.
void tell_intervals(DescribedPercept& percept, double scatter, double spread, double size_over_one,
                    double near_threshold);

/// Adds to a description what the program's force alone tells, as it was `found` in it: the percepts that it has no
/// record of, by the maps that set levels on its device, and its texture with the rules that classify it.
void describe_extracted(Description& description, const Bank& bank, const Extraction& found,
                        const Declarations& declarations);

}  // namespace wale
