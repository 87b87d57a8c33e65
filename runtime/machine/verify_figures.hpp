#pragma once

#include "schema/patch_program.hpp"
#include "schema/sentence.hpp"

namespace wale {

/// Ends verifying with a sentence made of `parts`, thrown as an `Error` that `verify` returns.
template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  fail(Code::refused_program, parts...);
}

/// The part of `verify` that checks figures and not code: the size of the register space and of tables, parameters,
/// states, grids, marks, the lattices of peaks, the patch, the device, percepts. Throws as `refuse` does.
void verify_figures(const PatchProgram& program);

/// The part that checks the cost of code: each run within its share of the period, setup within its limit. Throws as
/// `refuse` does.
void verify_costs(const PatchProgram& program);

}  // namespace wale
