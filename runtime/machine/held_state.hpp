#pragma once

#include "runtime/machine/arithmetic.hpp"
#include "runtime/machine/grid.hpp"
#include "schema/patch_program.hpp"

namespace wale {

/// How a state begins and goes on, without its name.
struct StateRule {
  explicit StateRule(const State& state)
      : low(arithmetic::flushed(state.low)),
        high(arithmetic::flushed(state.high)),
        initial(state.initial),
        next(state.next) {}

  float low, high;
  RegisterNumber initial, next;
};

/// What a state becomes when code leaves `value` for it: held in its range, and `otherwise` for not-a-number.
inline float held_state(float value, const StateRule& rule, float otherwise) {
  return held_within(value, rule.low, rule.high, otherwise);
}

/// What a state begins with when `enter` leaves `value` for it.
inline float initial_state(float value, const StateRule& rule) {
  return held_state(value, rule, rule.low > 0.0f ? rule.low : (rule.high < 0.0f ? rule.high : 0.0f));
}

/// What is written to a grid at the end of a tick.
struct WriteRule {
  WriteRule(const GridWrite& write, const Grid& grid, const GridShape& where)
      : shape(where),
        u(write.u),
        v(write.v),
        value(write.value),
        low(arithmetic::flushed(grid.low)),
        high(arithmetic::flushed(grid.high)) {}

  GridShape shape;
  RegisterNumber u, v, value;
  float low, high;  ///< what the value is held in
};

}  // namespace wale
