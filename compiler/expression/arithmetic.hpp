#pragma once

#include "compiler/expression/reading.hpp"

namespace wale {

// Operators on checked values. Errors are reported, and the value then is `failed`.

Value negated(Reading& reading, Value value);
Value complement(Reading& reading, Value condition);
Value product(Reading& reading, const Value& left, const Value& right, Span span);
Value quotient(Reading& reading, const Value& left, const Value& right, Span span);
/// The exponent decides the dimension, so a base with a dimension needs one that is known at compile time and comes to
/// whole twelfths.
Value raised(Reading& reading, const Value& base, const Value& exponent, Span span);

/// An operator with both its sides, which have been checked.
struct OperatorUse {
  const SyntaxTree& tree;
  const Binary& node;
  const Value &left, &right;
  Scope& scope;
  Span span;
};
Value applied(Reading& reading, const OperatorUse& use);

/// `if condition then yes else no`, all checked.
Value chosen(Reading& reading, const Value& condition, const Value& yes, const Value& no, Span span);

/// The mend for a value that is neither number nor vector.
std::string make_calculable(Value::Type type);

}  // namespace wale
