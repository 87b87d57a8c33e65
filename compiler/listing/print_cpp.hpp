#pragma once

#include <string>

#include "schema/patch_program.hpp"

namespace wale {

/// A verified program as one self-contained C++20 file: setup, entering and the tick as straight-line functions,
/// together with the arithmetic that they need. It gives the same bits as the machine; the comment at its head says how
/// to use it.
///
/// Operations are written as in the column `meaning` of schema/instruction.def. Pictures and predictions are left out.
std::string print_cpp(const PatchProgram& program);

}  // namespace wale
