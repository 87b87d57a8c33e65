#pragma once

#include "compiler/expression/check_expression.hpp"

namespace wale {

/// Checks one material with all materials that it is made from. `whole` means that its file was parsed and declared
/// without errors; only then are warnings of unused names reliable. Errors are reported to `surroundings.diagnostics`.
CheckedMaterial check_material(const Declared<MaterialDecl>& declared, const Surroundings& surroundings, bool whole);

}  // namespace wale
