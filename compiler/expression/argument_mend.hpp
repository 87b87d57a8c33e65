#pragma once

#include <optional>
#include <vector>

#include "compiler/expression/check_expression.hpp"

namespace wale {

/// The arguments of one call of a declared function, and the dimensions that the function gives them.
struct CallArguments {
  const SyntaxTree& tree;
  const Call& call;
  const FunctionDecl& function;
  const std::vector<std::optional<Dimension>>& dimensions;  ///< of each formal; empty for any
  const std::vector<Actual>& actuals;                       ///< in the order of the formals
  Span span;
};

/// Whether all given arguments have the types and dimensions that the function states. Otherwise they are reported, one
/// error for one mistake: exchanged arguments, a decimal comma, and the same wrong dimension of several arguments are
/// one mistake each.
bool fit(ExpressionReading& reading, const CallArguments& arguments, const Scope& scope);

/// Whether no number is given for an argument whose default is a vector; otherwise it is reported. `home` is the
/// function's tree.
bool are_vectors_where_needed(ExpressionReading& reading, const CallArguments& arguments, const SyntaxTree& home);

/// Warns of arguments that fit and seem to be exchanged all the same (W0313): a place `along` that is the same
/// everywhere while another argument is not, a `seed` that changes with the place.
void warn_of_exchanged(ExpressionReading& reading, const CallArguments& arguments);

/// The formal for which a misspelt argument name was meant: the only one without a value that has its dimension.
/// Empty if there is none.
std::string formal_of_dimension(const FunctionDecl& function, const std::vector<std::optional<Dimension>>& dimensions,
                                const Call& call, const SyntaxTree& tree, std::size_t positional,
                                const Dimension& dimension);

}  // namespace wale
