#pragma once

#include "runtime/machine/decoded_program.hpp"

namespace wale {

/// Zero of the same sign for a subnormal, whatever code the compiler made of what came before.
inline float flushed(float value) {
  const float zero = arithmetic::float_of(arithmetic::bits_of(value) & 0x80000000u);
  return absolute(value) < arithmetic::least_normal ? zero : value;
}

/// What a state becomes when code leaves `value` for it: held in its range, and `otherwise` for not-a-number.
template <class StateOrRule>
float held_state(float value, const StateOrRule& state, float otherwise) {
  return flushed(value >= state.low ? (value <= state.high ? value : state.high)
                                    : (value < state.low ? state.low : otherwise));
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
