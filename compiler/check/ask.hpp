#pragma once

#include <optional>
#include <vector>

#include "compiler/check/assemble.hpp"

namespace wale {

/// Adds what a line of a material's perceptual block asks for; it replaces what was taken over for the same percept.
/// A percept that makes no sense is reported and not added.
void ask(const Declared<MaterialDecl>& declared, const PerceptStatement& node, const Surroundings& surroundings,
         std::vector<AskedPercept>& percepts);

/// The plain number that an expression of a declaration comes to; nothing when it is none, which has been reported.
std::optional<double> plain_constant(const Declared<MaterialDecl>& declared, ExprId expr,
                                     const Surroundings& surroundings);

}  // namespace wale
