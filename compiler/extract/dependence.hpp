#pragma once

#include <initializer_list>

#include "schema/patch_program.hpp"

namespace wale {

/// Whether the force of a tick is worked out from one of these inputs.
bool reads(const PatchProgram& program, std::initializer_list<Input> inputs);

/// Whether the force of a hand that has just come in depends on where it is.
bool depends_on_place(const PatchProgram& program);

/// Whether one tick may change what another one does.
bool remembers_anything(const PatchProgram& program);

}  // namespace wale
