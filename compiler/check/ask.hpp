#pragma once

#include <optional>
#include <vector>

#include "compiler/check/assemble.hpp"

namespace wale {

/// Adds the percept of one line of a material's perceptual block. It replaces one that another material gave for the
/// same percept. Errors in the line are reported, and the percept is then not added.
void ask(const Declared<MaterialDecl>& declared, const PerceptStatement& node, const Surroundings& surroundings,
         std::vector<AskedPercept>& percepts);

/// The value of a level by its name, as in `fine`. Empty after an error, which is reported.
std::optional<double> named_level(const Declarations& declarations, const std::string& percept, const Word& word,
                                  Diagnostics& diagnostics);

/// The value of an expression that must be a plain number known at compile time. Empty after an error, which is
/// reported.
std::optional<double> plain_constant(const Declared<MaterialDecl>& declared, ExprId expr,
                                     const Surroundings& surroundings);

}  // namespace wale
