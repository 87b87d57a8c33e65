#pragma once

#include <optional>
#include <vector>

#include "compiler/parse/syntax_tree.hpp"

namespace wale {

/// The name in a setting `like X`, `like "deep wale corduroy"` or `like fabric.woven`. None for other settings, and
/// none for a `like` without exactly one name.
std::optional<Word> liked_by(const Setting& setting, const SyntaxTree& tree);

/// All words of a material that may name another material, in the order written: X in `like X`, `= X`, `= X(…)`,
/// `= 0.5 X + 30 % X + 0.2 * X(…)`, `= between(X, X(…), 0.3)`. X may also be a text in quotes. Whether the words do
/// name materials is not known here.
std::vector<Word> made_from(const MaterialDecl& material, const SyntaxTree& tree);

/// The same of an expression that stands for a material: `X(…)`, `0.5 X + 30 % X`.
std::vector<Word> made_from(ExprId expr, const SyntaxTree& tree);

/// All words of an `experiment` that may name a material: in what its `stimulus` and `standard` are made of, and levels
/// of a `factor` that are words. Names of its factors are left out.
std::vector<Word> presented_by(const RecordDecl& experiment, const SyntaxTree& tree);

}  // namespace wale
