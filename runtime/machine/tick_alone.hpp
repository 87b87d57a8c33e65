#pragma once

#include <span>

#include "wale/program.hpp"

namespace wale {

/// `tick_all` on the calling thread alone: bit-identical, and it leaves the other cores to others.
void tick_alone(const Bank& bank, std::span<const Hand> hands, std::span<Force> forces);

}  // namespace wale
