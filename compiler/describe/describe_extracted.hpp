#pragma once

#include "compiler/declarations/declarations.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/read/read.hpp"

namespace wale {

/// Adds what the force alone shows, as `found` by a reading: the percepts that the program has no record of, by the
/// maps for its device, and the texture with the rules that classify it.
void describe_extracted(Description& description, const Bank& bank, const ForceReading& found,
                        const Declarations& declarations);

}  // namespace wale
