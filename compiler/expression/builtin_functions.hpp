#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/expression/check_expression.hpp"

namespace wale {

/// A call of a builtin function. Its arguments have been checked, and none that is required is missing.
struct BuiltinCall {
  ExpressionReading& reading;
  const std::vector<Actual>& actuals;
  Span span;
  const SyntaxTree& tree;  ///< the call's, as are the two below
  const Call& call;
  const Scope& scope;

  Terms& terms() const { return reading.terms; }
  const Value& value(std::size_t i) const { return actuals[i].value; }
  Value failed() const { return failed_value(span); }
  /// The call's result, if it is a number.
  Value scalar(TermId x, Dimension dimension = {}) const {
    return {.type = Value::Type::number, .x = x, .dimension = dimension, .span = span};
  }

  // Checks of arguments: false or nothing if one fails, which is reported.
  bool number(std::size_t i) const;
  bool plain(std::size_t i) const;
  bool is_vector(std::size_t i) const;
  bool text(std::size_t i, const char* example) const;
  /// Reports that argument `b` has another dimension than `a`, and returns the failed value.
  Value mismatched(std::size_t a, std::size_t b) const;
  std::optional<double> constant_argument(std::size_t i, const Dimension& dimension, const char* example) const;
};

/// A builtin function: its name, its arguments, how many of them are required, and the function that evaluates it.
struct Builtin {
  std::string_view name;
  std::vector<std::string_view> formals;
  std::size_t needed;
  Value (*apply)(const BuiltinCall&);
  bool of_places = false;  ///< can be used only on a patch
};

/// All builtin functions except `curve`, which takes any number of arguments.
const std::vector<Builtin>& builtins();
/// The builtin function with that name, or null.
const Builtin* builtin_named(std::string_view name);

// builtin_memory.cpp: functions that remember, each call with states of its own
Value phase(const BuiltinCall& call);
Value stretch(const BuiltinCall& call);

// builtin_files.cpp: functions that read files
Value relief(const BuiltinCall& call);
Value image(const BuiltinCall& call);
Value table(const BuiltinCall& call);

}  // namespace wale
