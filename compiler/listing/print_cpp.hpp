#pragma once

#include <string>

#include "schema/patch_program.hpp"

namespace wale {

/// A verified program as one self-contained C++20 file: setup, entering and the tick as straight-line functions, with
/// the arithmetic that they need written into it. Same bits as the machine; how to use it says the comment at its head.
///
/// Operations are written as the column `meaning` of schema/instruction.def has them. What only pictures and
/// predictions need is left out.
std::string print_cpp(const PatchProgram& program);

}  // namespace wale
