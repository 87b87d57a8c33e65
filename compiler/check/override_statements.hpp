#pragma once

#include <vector>

#include "compiler/check/assemble.hpp"

namespace wale {

/// Adds a material's own statements to those from another material. An own statement replaces one of the same name. A
/// new one goes before the next replacement, so that the replacement may use it, or else at the end.
void override_statements(const Declared<MaterialDecl>& declared, std::vector<AssembledStatement>& all);

}  // namespace wale
