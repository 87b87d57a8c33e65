#pragma once

#include "compiler/declarations/declarations.hpp"
#include "wale/patch_program.hpp"

namespace wale {

/// What a record of a percept says of its map: grades, figures, and the stimuli that it was measured with. Without the
/// carrier in a program, its code and its thresholds. `percept` is as `carried_on` the device.
PerceptRecord record_by(const Map& map, const Percept& percept, const DeviceDeclaration& device,
                        const Declarations& declarations);

}  // namespace wale
