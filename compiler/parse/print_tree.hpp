#pragma once

#include <string>

#include "compiler/parse/syntax_tree.hpp"

namespace wale {

/// Prints the tree as S-expressions, with one line per declaration or statement, for `--emit tree` and the parser's
/// tests:
///
///     (material corduroy
///       (perceptual (roughness 0.6))
///       (physical
///         (param wale [2.5 mm] (in [1 mm] [5 mm]) "distance between ribs")))
std::string print_tree(const SyntaxTree& tree);

/// Prints one expression: `(+ a (* [2 mm/s^2] (sin x)))`.
std::string print_expression(const SyntaxTree& tree, ExprId id);

}  // namespace wale
