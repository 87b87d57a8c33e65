#pragma once

#include "compiler/expression/check_expression.hpp"
#include "compiler/expression/checked.hpp"

namespace wale {

/// Checks how the workspaces of a file are presented to people, its declarations `movie`, `keys` and `groups`, and adds
/// them to the module, whose workspaces are checked already. Errors are reported; what has one is left out.
void check_presentations(const SyntaxTree& tree, const Surroundings& surroundings, CheckedModule& module);

}  // namespace wale
