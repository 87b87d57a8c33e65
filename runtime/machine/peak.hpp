#pragma once

#include <span>

#include "runtime/machine/decoded_program.hpp"

namespace wale {

/// The percentile of peak `index`'s value over its lattice (see `Peak`): value number ceil(percentile * n) of n in
/// ascending order, with the product in float. Values that are not finite count as 0. Allocates.
/// The caller holds a `FloatingPointMode`.
float value_of_peak(const DecodedProgram& program, std::size_t index, std::span<const float> registers);

}  // namespace wale
