#pragma once

#include "schema/sentence.hpp"
#include "wale/patch_program.hpp"

namespace wale {

/// Ends the verification: throws an `Error` with a sentence made of `parts`, which `verify` returns.
template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  fail(Code::refused_program, parts...);
}

/// The part of `verify` that checks figures: the number of registers, tables, parameters, states, grids, marks, the
/// lattices of peaks, the patch, the device, percepts and fates. Throws as `refuse` does.
void verify_figures(const PatchProgram& program);

/// The part of it that checks the figures of a device.
void verify_device(const DeviceProfile& device);

/// The part of `verify` that checks the cost of code: each section within its share of the period, setup within its
/// limit. Throws as `refuse` does.
void verify_costs(const PatchProgram& program);

}  // namespace wale
