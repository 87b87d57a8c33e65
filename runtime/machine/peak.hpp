#pragma once

#include <span>

#include "runtime/machine/decoded_program.hpp"

namespace wale {

/// Fills a block of lanes with the places of a peak's lattice, from point `first` on, m.
void place_lanes(float* x, float* y, std::uint32_t first, float half_width, float half_height);

/// The percentile of peak `index`'s value over its lattice (see `Peak`): value number ceil(percentile * n) of n in
/// ascending order, with the product in float. Values that are not finite count as 0. Allocates.
/// The caller holds a `FloatingPointMode`.
float value_of_peak(const DecodedProgram& program, std::size_t index, std::span<const float> registers);

}  // namespace wale
