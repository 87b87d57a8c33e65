#pragma once

#include <span>
#include <vector>

#include "runtime/machine/decoded_program.hpp"

namespace wale {

/// Peak `index`'s value at each point of its lattice (see `Peak`), in the lattice's order; 0 where it is not finite.
/// Allocates. The caller holds a `FloatingPointMode`.
std::vector<float> values_under_peak(const DecodedProgram& program, std::size_t index,
                                     std::span<const float> registers);

/// The percentile of peak `index`'s value over its lattice (see `Peak`): value number ceil(percentile * n) of n in
/// ascending order, with the product in float. Values that are not finite count as 0. Allocates.
/// The caller holds a `FloatingPointMode`.
float value_of_peak(const DecodedProgram& program, std::size_t index, std::span<const float> registers);

}  // namespace wale
