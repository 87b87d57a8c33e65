#pragma once

#include <initializer_list>

#include "wale/patch_program.hpp"

namespace wale {

/// Whether a tick computes the force from one of these inputs.
bool reads(const PatchProgram& program, std::initializer_list<Input> inputs);

/// Whether the force on a hand that has just entered depends on its position.
bool depends_on_place(const PatchProgram& program);

/// Whether one tick may change the result of a later one.
bool remembers_anything(const PatchProgram& program);

/// Whether all that is remembered goes by time alone, as the phase of a vibration does, whatever the hand does.
bool remembers_time_only(const PatchProgram& program);

/// Whether time alone may change the force on a hand that does the same again. Not told of memories over the patch.
bool goes_by_time(const PatchProgram& program);

/// Whether the force may differ between a hand that moves and one that rests at the same place and time.
bool depends_on_motion(const PatchProgram& program);

}  // namespace wale
