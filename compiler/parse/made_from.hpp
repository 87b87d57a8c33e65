#pragma once

#include <optional>
#include <vector>

#include "compiler/parse/syntax_tree.hpp"

namespace wale {

/// The material that a setting `like X`, `like "deep wale corduroy"` or `like fabric.woven` names; none for any other
/// setting, and none for a `like` that names no single material.
std::optional<Word> liked_by(const Setting& setting, const SyntaxTree& tree);

/// Every place of a material where the name of another may stand, in the order written: `like X`, `= X`, `= X(…)`,
/// `= 0.5 X + 30 % X + 0.2 * X(…)`, `= between(X, X(…), 0.3)`; a text in quotes is as good as a name. Whether the
/// names mean materials is not known here.
std::vector<Word> made_from(const MaterialDecl& material, const SyntaxTree& tree);

}  // namespace wale
