#pragma once

#include "runtime/machine/arithmetic.hpp"
#include "runtime/machine/grid.hpp"
#include "wale/patch_program.hpp"

namespace wale {

/// A state's range, and the registers of its first and next values.
struct StateRule {
  explicit StateRule(const State& state)
      : low(arithmetic::flushed(state.low)),
        high(arithmetic::flushed(state.high)),
        initial(state.initial),
        next(state.next) {}

  float low, high;
  RegisterNumber initial, next;
};

/// The next value of a state whose register holds `value`: clamped to its range; `otherwise` for not-a-number.
inline float held_state(float value, const StateRule& rule, float otherwise) {
  return held_within(value, rule.low, rule.high, otherwise);
}

/// The first value of a state whose register holds `value` after `enter`: clamped to its range; for not-a-number the
/// number of the range that is nearest to 0.
inline float initial_state(float value, const StateRule& rule) {
  return held_state(value, rule, rule.low > 0.0f ? rule.low : (rule.high < 0.0f ? rule.high : 0.0f));
}

/// A write to a grid at the end of a tick.
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
  float low, high;  ///< the value is clamped to this range
};

}  // namespace wale
