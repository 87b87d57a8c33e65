#pragma once

#include <vector>

#include "compiler/check/assemble.hpp"

namespace wale {

/// Adds a material's own statements to those that it takes over: they take the place of those of the same name; what is
/// new stands before the next that replaces something, so that the replacement may use it, or else at the end.
void override_statements(const Declared<MaterialDecl>& declared, std::vector<AssembledStatement>& all);

}  // namespace wale
