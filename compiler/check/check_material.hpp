#pragma once

#include "compiler/expression/check_expression.hpp"

namespace wale {

/// Checks one material, with all that it is made from. `whole`: its file has been read and declared without errors, so
/// that nothing of the material is missing and what seems unused is.
CheckedMaterial check_material(const Declared<MaterialDecl>& declared, const Surroundings& surroundings, bool whole);

}  // namespace wale
