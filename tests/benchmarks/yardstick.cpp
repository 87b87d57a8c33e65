// Compiled with -DWALE_PATCH='"MATERIAL.cpp"' -DWALE_PATCH_NAMESPACE=wale_patch_MATERIAL, see tests/benchmarks/run.

#include "tests/benchmarks/yardstick.hpp"

#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <type_traits>

#include WALE_PATCH

namespace {

namespace patch = WALE_PATCH_NAMESPACE;

// A struct without members has a size all the same.
constexpr std::size_t state_size = std::is_empty_v<patch::State> ? 0 : sizeof(patch::State) / sizeof(float);

std::optional<patch::Setup> bank;

patch::Hand inputs_of(const wale::Hand& hand) {
  return {hand.position.x,
          hand.position.y,
          hand.velocity.x,
          hand.velocity.y,
          hand.acceleration.x,
          hand.acceleration.y,
          hand.raw_velocity.x,
          hand.raw_velocity.y,
          hand.raw_acceleration.x,
          hand.raw_acceleration.y,
          hand.workspace.x,
          hand.workspace.y,
          static_cast<float>(hand.time),
          hand.button ? 1.0f : 0.0f};
}

/// The state whose floats are `apart` from each other.
patch::State state_of([[maybe_unused]] const float* values, [[maybe_unused]] std::size_t apart) {
  if constexpr (state_size == 0) {
    return {};
  } else {
    std::array<float, state_size> all;
    for (std::size_t k = 0; k < state_size; ++k) all[k] = values[k * apart];
    return std::bit_cast<patch::State>(all);
  }
}

void keep([[maybe_unused]] const patch::State& state, [[maybe_unused]] float* values,
          [[maybe_unused]] std::size_t apart) {
  if constexpr (state_size > 0) {
    const auto all = std::bit_cast<std::array<float, state_size>>(state);
    for (std::size_t k = 0; k < state_size; ++k) values[k * apart] = all[k];
  }
}

}  // namespace

void yardstick_begin() { bank = patch::setup({}, {}); }

std::size_t yardstick_state_size() { return state_size; }

void yardstick_enter(const wale::Hand* hand, float* state) { keep(patch::enter(*bank, inputs_of(*hand)), state, 1); }

void yardstick_tick(const wale::Hand* hand, float* values, wale::Force* force) {
  patch::State state = state_of(values, 1);
  const patch::Force found = patch::tick(*bank, state, inputs_of(*hand));
  keep(state, values, 1);
  force->x = found.x;
  force->y = found.y;
}

void yardstick_batch(const wale::Hand* hands, float* states, wale::Force* forces, std::size_t count) {
  const patch::Setup shared = *bank;
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    patch::State state = state_of(states + i, count);
    const patch::Force found = patch::tick(shared, state, inputs_of(hands[i]));
    keep(state, states + i, count);
    forces[i].x = found.x;
    forces[i].y = found.y;
  }
}
