#pragma once

#include "compiler/check/check.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/solve/solve.hpp"
#include "wale/program.hpp"

namespace wale {

/// Reports a height by whose slope no force can be scaled (W0409): one that is the same everywhere, one that only
/// jumps, and one whose slope covers so little of the patch that its 99th percentile is 0. If an argument was hardly
/// meant, that is why: the error takes the place of the warning. `bank`: null if there is no program, since the slope
/// is 0 by its formula.
void report_flat_height(const SolvedMaterial& solved, const CheckedMaterial& material, const Bank* bank,
                        Diagnostics& diagnostics);

/// Warns of a height with slopes that jumps besides (W0430).
void warn_of_jumps(const SolvedMaterial& solved, const CheckedMaterial& material, Diagnostics& diagnostics);

/// Warns of a feature so small that `lateral` holds most of it at the amplitude (W0437).
void warn_of_held_feature(const Bank& bank, const SolvedMaterial& solved, const CheckedMaterial& material,
                          Diagnostics& diagnostics);

}  // namespace wale
