#pragma once

#include "schema/patch_program.hpp"

namespace wale {

/// The part of `verify` that looks at figures rather than code: sizes of the register space and of tables, parameters,
/// states, grids, marks, peaks' lattices, the patch, the device, percepts. Throws a `Refusal`.
void verify_figures(const PatchProgram& program);

}  // namespace wale
