#pragma once

#include "wale/patch_program.hpp"
#include "wale/result.hpp"

namespace wale {

/// Whether a program is built for the device that `declared` describes: the same name, and the same figures wherever
/// its forces, places and times would mean something else (schema/PATCH_PROGRAM.md lists them). Errors: `other_device`,
/// or `other_figures` with each figure and both values.
Result<> is_built_for(const PatchProgram& program, const DeviceProfile& declared);

}  // namespace wale
