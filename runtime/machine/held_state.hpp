#pragma once

#include "runtime/machine/arithmetic.hpp"
#include "schema/patch_program.hpp"

namespace wale {

/// What becomes of a state at the end of a tick, without its name.
struct StateRule {
  float low, high;
  RegisterNumber next;
};

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

}  // namespace wale
