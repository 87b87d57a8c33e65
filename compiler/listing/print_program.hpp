#pragma once

#include <functional>
#include <optional>
#include <string>

#include "wale/patch_program.hpp"

namespace wale {

/// The interval of an instruction's result in words ("-0.5 .. 2"), if it is known.
using IntervalOf =
    std::function<std::optional<std::string>(CodeSection section, std::size_t index, std::size_t instruction)>;

/// The program as the machine runs it: registers; then the instructions of each section with their cost, their line of
/// Wale and, if `interval_of` gives it, their interval; the use of the results; and the total cost.
///
/// Inputs, parameters and states are shown by name, constants by value, all other operands by register.
std::string print_program(const PatchProgram& program, const IntervalOf& interval_of = {});

}  // namespace wale
