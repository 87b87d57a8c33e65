#pragma once

#include <memory>

#include "compiler/check/assembled_material.hpp"

namespace wale {

/// Assembles a material from its own statements and from others: `like`, `= other(parameter: value)`, `= 0.7 a + 0.3
/// b`, `= between(a, b, t)`. Null if there was an error, which is reported.
std::shared_ptr<const AssembledMaterial> assemble(const Declared<MaterialDecl>& material,
                                                  const Surroundings& surroundings);

}  // namespace wale
