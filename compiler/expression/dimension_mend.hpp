#pragma once

#include <optional>

#include "compiler/expression/reading.hpp"

namespace wale {

/// Reports an expression of the wrong dimension, with what to write instead.
[[gnu::cold]] void report_dimension(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, const Scope& scope,
                                    const Dimension& found, const Dimension& expected);

/// The same with other advice.
[[gnu::cold]] void report_dimension(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr,
                                    const Dimension& found, const Dimension& expected, Advice advice);

/// Advice for a product with a height in it, where a force is expected; nothing for any other expression.
[[gnu::cold]] std::optional<Advice> height_mend(const ExpressionReading& reading, const SyntaxTree& tree, ExprId expr,
                                                const Scope& scope, const Dimension& expected);

/// Advice on how to turn an expression of dimension `found` into one of dimension `expected`.
[[gnu::cold]] Advice dimension_mend(const ExpressionReading& reading, const SyntaxTree& tree, ExprId expr,
                                    const Scope& scope, const Dimension& expected, const Dimension& found);

}  // namespace wale
