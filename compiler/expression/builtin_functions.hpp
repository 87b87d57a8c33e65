#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/expression/check_expression.hpp"

namespace wale {

/// A call of a builtin function, with its arguments checked and those needed given.
struct BuiltinCall {
  Reading& reading;
  const std::vector<Actual>& actuals;
  Span span;

  Terms& terms() const { return reading.terms; }
  const Value& value(std::size_t i) const { return actuals[i].value; }
  Value failed() const { return failed_value(span); }
  /// A number that the call gives.
  Value scalar(TermId x, Dimension dimension = {}) const {
    return {.type = Value::Type::number, .x = x, .dimension = dimension, .span = span};
  }

  // Checks of arguments: false or nothing where one fails, which is reported.
  bool number(std::size_t i) const;
  bool plain(std::size_t i) const;
  bool is_vector(std::size_t i) const;
  bool text(std::size_t i, const char* example) const;
  /// Argument `b` has another dimension than `a`, which is reported: the call has failed.
  Value mismatched(std::size_t a, std::size_t b) const;
  std::optional<double> constant_argument(std::size_t i, const Dimension& dimension, const char* example) const;
};

/// A builtin function: its name, its arguments, how many of them are needed, and what it gives.
struct Builtin {
  std::string_view name;
  std::vector<std::string_view> formals;
  std::size_t needed;
  Value (*apply)(const BuiltinCall&);
  bool of_places = false;  ///< makes sense on a patch only
};

/// All but `curve`, which takes any number of arguments.
const std::vector<Builtin>& builtins();
/// The one of that name, or null.
const Builtin* builtin_named(std::string_view name);

// builtin_files.cpp: those that read files
Value relief(const BuiltinCall& call);
Value image(const BuiltinCall& call);
Value table(const BuiltinCall& call);

}  // namespace wale
