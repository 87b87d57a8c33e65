#pragma once

#include <span>

#include "runtime/machine/decoded_program.hpp"

namespace wale {

/// Runs verified code once over the program's registers and the cells of all its grids (`cells` may be null for code
/// that reads no grid). Only `peak` instructions allocate, and only setup has them; other code is real-time: no
/// allocation, lock or system call. The caller holds a `FloatingPointMode`.
void run_lane(const DecodedProgram& program, std::span<const Instruction> code, float* registers, const float* cells);

}  // namespace wale
