#pragma once

#include "compiler/expression/check_expression.hpp"

namespace wale {

/// Reports unknown names in the bodies of a file's functions. Functions that are never called are read only here.
void check_functions(const SyntaxTree& tree, const Surroundings& surroundings);

/// Warns of private declarations that the file does not use, and of imports from which it uses nothing.
void warn_of_unused_declarations(const ModuleSet& modules, const Surroundings& surroundings);

}  // namespace wale
