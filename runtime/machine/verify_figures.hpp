#pragma once

#include "schema/patch_program.hpp"

namespace wale {

/// The part of `verify` that looks at figures rather than code: sizes of the register space and of tables, parameters,
/// states, grids, marks, peaks' lattices, the patch, the device, percepts. Throws a `Refusal`.
void verify_figures(const PatchProgram& program);

/// The part that looks at what code costs: each run within its share of the period, setup within its limit. Throws too.
void verify_costs(const PatchProgram& program);

}  // namespace wale
