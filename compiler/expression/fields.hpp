#pragma once

#include <array>

#include "compiler/expression/reading.hpp"

namespace wale {

/// The value of a field at an argument of the type and dimension that it takes.
Value value_at(Terms& terms, const Field& field, const Value& argument, Span span);

/// Where a place lies in a memory: columns and rows from the centre of its first cell.
std::array<TermId, 2> memory_place(Terms& terms, std::uint32_t memory, const Value& place, Span span);

/// `curve(0 mm, 0 N, 2 mm, 1.5 N, …)`: places and values in turn, the places rising.
Value curve(Reading& reading, const SyntaxTree& tree, ExprId expr, const Call& call, Scope& scope);

/// A call of a field by its name: `detent(x)`.
Value call_field(Reading& reading, const SyntaxTree& tree, ExprId expr, const Call& call, const Field& field,
                 Scope& scope);

}  // namespace wale
