#pragma once

#include "runtime/machine/decoded_program.hpp"
#include "runtime/machine/held_state.hpp"

namespace wale {

/// Runs `enter` over registers that already hold the hand, and sets the state registers.
/// Real-time: allocates nothing, takes no lock, makes no system call, does not throw. The caller holds a
/// `FloatingPointMode`.
void enter_lane(const DecodedProgram& program, float* registers) noexcept;

/// As `enter_lane`, for a block. The caller holds a `FloatingPointMode`.
void enter_block(const DecodedProgram& program, Block& block, const float* registers, std::size_t count = lanes);

}  // namespace wale
