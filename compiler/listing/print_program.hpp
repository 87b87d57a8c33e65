#pragma once

#include <functional>
#include <optional>
#include <string>

#include "schema/patch_program.hpp"

namespace wale {

/// What the result of an instruction is known to lie in, in words ("-0.5 .. 2"), where anything is known of it.
using IntervalOf =
    std::function<std::optional<std::string>(CodeSection section, std::size_t index, std::size_t instruction)>;

/// The program as the machine runs it: registers, then each section's instructions with their cost, their line of Wale
/// and, where `interval_of` knows it, their interval; what becomes of the results; and what all of it costs.
///
/// Operands that have a name (inputs, parameters, states) go by it, constants by their value, all others by register.
std::string print_program(const PatchProgram& program, const IntervalOf& interval_of = {});

}  // namespace wale
