#pragma once

#include "runtime/machine/decoded_program.hpp"

namespace wale {

/// What a state becomes when code leaves `value` for it: held in its range, and `otherwise` for not-a-number.
inline float held_state(float value, const State& state, float otherwise) {
  return value >= state.low ? (value <= state.high ? value : state.high) : (value < state.low ? state.low : otherwise);
}

/// What a state begins with when `enter` leaves `value` for it.
inline float initial_state(float value, const State& state) {
  return held_state(value, state, state.low > 0.0f ? state.low : (state.high < 0.0f ? state.high : 0.0f));
}

/// Runs `enter` over registers that hold the hand already, and sets the state registers.
/// Real-time: allocates nothing, takes no lock, makes no system call, does not throw. The caller holds a
/// `FloatingPointMode`.
void enter_lane(const DecodedProgram& program, float* registers) noexcept;

/// The same over a block. The caller holds a `FloatingPointMode`.
void enter_block(const DecodedProgram& program, Block& block, const float* registers);

}  // namespace wale
