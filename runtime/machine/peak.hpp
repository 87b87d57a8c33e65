#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "runtime/machine/decoded_program.hpp"

namespace wale {

/// Fills a block of lanes with the places of a peak's lattice, from point `first` on, m.
void place_lanes(float* x, float* y, std::uint32_t first, float half_width, float half_height);

/// Hands peak `index`'s value at each point of its lattice (see `Peak`) to `take(point, value)`, in the lattice's order;
/// 0 where it is not finite. Allocates a block. The caller holds a `FloatingPointMode`.
template <typename Take>
[[gnu::always_inline]] inline void each_under_peak(const DecodedProgram& program, std::size_t index,
                                                   std::span<const float> registers, Take take) {
  const Peak& peak = program.description.peaks[index];
  const BlockOperand value = block_operand(program.description, peak.value);
  const BlockCode& code = program.peaks[index]->code();
  Block block(program.description);
  float* x = block.row(block_operand(program.description, static_cast<RegisterNumber>(Input::x)));
  float* y = block.row(block_operand(program.description, static_cast<RegisterNumber>(Input::y)));
  for (std::uint32_t first = 0; first < peak.points; first += lanes) {
    place_lanes(x, y, first, registers[peak.half_width], registers[peak.half_height]);
    block.run(code, registers.data(), nullptr);
    const std::size_t count = std::min<std::size_t>(lanes, peak.points - first);
    for (std::size_t lane = 0; lane < count; ++lane) {
      const float v = block.value(value, lane, registers.data());
      take(first + lane, std::isfinite(v) ? v + 0.0f : 0.0f);  // -0 counts as 0
    }
  }
}

/// The percentile of peak `index`'s value over its lattice (see `Peak`): value number ceil(percentile * n) of n in
/// ascending order, with the product in float. Values that are not finite count as 0. Allocates.
/// The caller holds a `FloatingPointMode`.
float value_of_peak(const DecodedProgram& program, std::size_t index, std::span<const float> registers);

}  // namespace wale
