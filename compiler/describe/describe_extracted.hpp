#pragma once

#include "compiler/declarations/declarations.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/read/read.hpp"

namespace wale {

/// Fills in the 95 % intervals of a percept, and whether it is near the threshold. The interval of means follows from
/// the scatter (standard deviation of the means, in log10 of magnitude); that of single people from the spread of their
/// exponents (0: not known). `size_over_one` is the size of the carrier over its size at the reference stimulus.
void tell_intervals(DescribedPercept& percept, double scatter, double spread, double size_over_one,
                    double near_threshold);

/// Adds what the force alone shows, as `found` by a reading: the percepts that the program has no record of, by the
/// maps for its device, and the texture with the rules that classify it.
void describe_extracted(Description& description, const Bank& bank, const ForceReading& found,
                        const Declarations& declarations);

}  // namespace wale
