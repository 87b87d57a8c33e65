#pragma once

#include <cstddef>

#include "wale/program.hpp"

// What the machine is measured against: one material as `wale build --emit cpp` writes it, compiled by itself to a
// shared object. yardstick.cpp is the only file that knows what that text looks like. Parameters and the patch's size
// are the program's own. A state is `yardstick_state_size()` floats.

extern "C" {

/// Setup and peaks.
void yardstick_begin();

std::size_t yardstick_state_size();

/// The state of a hand that enters.
void yardstick_enter(const wale::Hand* hand, float* state);

/// One tick; N.
void yardstick_tick(const wale::Hand* hand, float* state, wale::Force* force);

/// The same for `count` instances in one loop that the compiler may vectorise; float k of instance i's state is
/// states[k * count + i].
void yardstick_batch(const wale::Hand* hands, float* states, wale::Force* forces, std::size_t count);
}
