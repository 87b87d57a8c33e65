#pragma once

#include <optional>

#include "compiler/expression/reading.hpp"

namespace wale {

/// Reports `3 N/(m/s)` and `3 N*(s/m)` once, with what was meant: `3 N s/m`. Nothing of any other expression, nor where
/// a unit in the parentheses is also the name of a value.
[[gnu::cold]] std::optional<Value> report_units_in_parentheses(ExpressionReading& reading, const SyntaxTree& tree,
                                                               ExprId expr, const Binary& node, const Scope& scope);

/// Whether the right side of a product or a quotient begins with the name of a unit, so that it is worth asking.
bool begins_with_unit(const ExpressionReading& reading, const SyntaxTree& tree, const Binary& node);

}  // namespace wale
