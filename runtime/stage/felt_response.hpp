#pragma once

#include <span>

#include "wale/felt.hpp"

namespace wale {

/// Fits each law of `FeltResponse` to the ticks of a run, those within the patch, as if the force obeyed that law
/// alone.
FeltResponse response_of(std::span<const TickRecord> record, double seconds_per_tick);

}  // namespace wale
