#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/expression/argument_mend.hpp"
#include "compiler/expression/reading.hpp"

namespace wale {

/// Advice for a product such as `2 pi * x * 5 mm` where a plain number is expected: `x / 5 mm`. `found` is its
/// dimension, which must be the square of that of the factor that was meant to divide.
[[gnu::cold]] std::optional<Advice> quotient_mend(const ExpressionReading& reading, const SyntaxTree& tree, ExprId expr,
                                                  const Scope& scope, const Dimension& found);

/// What is wrong with plain numbers among the arguments of a function that takes values of any dimension, such as
/// `modulo(x, 10)`, if an error is found inside the function: "write `10 mm`". Nothing if there are none beside values
/// with a dimension.
[[gnu::cold]] std::optional<Diagnostic> plain_beside_measured(const ExpressionReading& reading,
                                                              const CallArguments& arguments);

/// The text of an expression as a factor: in parentheses if it is a sum.
std::string as_factor(std::string_view text);

}  // namespace wale
