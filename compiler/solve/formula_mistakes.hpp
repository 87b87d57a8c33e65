#pragma once

#include "compiler/check/check.hpp"
#include "compiler/diagnostics/diagnostic.hpp"

namespace wale {

/// Warns of an angle that turns, or of a place in a noise, which goes through a single cycle over many patches (W0308):
/// metres were written where millimetres were meant; and of an angle that turns within two encoder counts (W0309).
/// Whether it warned.
bool warn_of_cycles(const CheckedMaterial& material, const DeviceProfile& device, Diagnostics& diagnostics);

/// Warns (W0308) of a root or a logarithm of negative numbers that leaves the force, or a height, without a number at
/// many places. Whether it warned.
bool warn_of_no_number(const CheckedMaterial& material, const DeviceProfile& device, Diagnostics& diagnostics);

}  // namespace wale
