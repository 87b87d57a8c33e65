#pragma once

#include "compiler/expression/check_expression.hpp"

namespace wale {

/// Reports names without a meaning in the bodies of a file's functions: those that nothing calls are read nowhere else.
void check_functions(const SyntaxTree& tree, const Surroundings& surroundings);

/// Warns of what a file declares for itself and does not use, and of imports of which it uses nothing.
void warn_of_unused_declarations(const ModuleSet& modules, const Surroundings& surroundings);

}  // namespace wale
