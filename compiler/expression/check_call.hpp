#pragma once

#include <vector>

#include "compiler/expression/check_expression.hpp"

namespace wale {

/// The value of a call of a declared or builtin function, or of a curve, table, relief or memory.
Value value_of_call(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, const Call& call, Scope& scope);

/// Expands the body of a declared function. `actuals` are in the order of its formals; those that are not given get
/// their defaults.
Value expanded(ExpressionReading& reading, const Declared<FunctionDecl>& function, std::vector<Actual> actuals,
               const Scope& scope, Span span);

}  // namespace wale
