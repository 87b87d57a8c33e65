#pragma once

#include <array>

#include "compiler/expression/reading.hpp"

namespace wale {

/// The value of a field at `argument`, which has the right type and dimension.
Value value_at(Terms& terms, const Field& field, const Value& argument, Span span);

/// The column and row of a place in a memory, counted in cells from the centre of its first cell.
std::array<TermId, 2> memory_place(Terms& terms, std::uint32_t memory, const Value& place, Span span);

/// The value of `curve(0 mm, 0 N, 2 mm, 1.5 N, …)`: places and values alternate, and the places rise.
Value curve(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, const Call& call, Scope& scope);

/// The value of a call of a field: `detent(x)`.
Value call_field(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, const Call& call, const Field& field,
                 Scope& scope);

}  // namespace wale
