#pragma once

#include "compiler/expression/reading.hpp"

namespace wale {

// Operators on checked values. After an error, which is reported, the value is `failed`.

Value negated(ExpressionReading& reading, Value value);
Value complement(ExpressionReading& reading, Value condition);
Value product(ExpressionReading& reading, const Value& left, const Value& right, Span span);
Value quotient(ExpressionReading& reading, const Value& left, const Value& right, Span span);
/// A power. A base with a dimension needs an exponent that is known at compile time and gives whole twelfths of the
/// base dimensions, since the exponent decides the dimension of the result.
Value raised(ExpressionReading& reading, const Value& base, const Value& exponent, Span span);

/// An operator with its two checked operands.
struct OperatorUse {
  const SyntaxTree& tree;
  const Binary& node;
  const Value &left, &right;
  Scope& scope;
  Span span;
};
Value applied(ExpressionReading& reading, const OperatorUse& use);

/// `if condition then yes else no`, with checked operands.
Value chosen(ExpressionReading& reading, const Value& condition, const Value& yes, const Value& no, Span span);

/// The advice for a value that is neither a number nor a vector.
std::string make_calculable(Value::Type type);

}  // namespace wale
