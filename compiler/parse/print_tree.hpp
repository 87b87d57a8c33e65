#pragma once

#include <string>

#include "compiler/parse/syntax_tree.hpp"

namespace wale {

/// The tree as S-expressions, one declaration or statement a line: what `--emit tree` shows and the parser's tests
/// compare.
///
///     (material corduroy
///       (perceptual (roughness 0.6))
///       (physical
///         (param wale [2.5 mm] (in [1 mm] [5 mm]) "distance between ribs")))
std::string print_tree(const SyntaxTree& tree);

/// One expression: `(+ a (* [2 mm/s^2] (sin x)))`.
std::string print_expression(const SyntaxTree& tree, ExprId id);

}  // namespace wale
