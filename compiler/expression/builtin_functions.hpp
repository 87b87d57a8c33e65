#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/expression/check_expression.hpp"

namespace wale {

struct BuiltinFunctions;

/// A function of the compiler's own: its name, its arguments, how many of them are needed, and what it makes of them.
struct Builtin {
  std::string_view name;
  std::vector<std::string_view> formals;
  std::size_t needed;
  Value (*apply)(const BuiltinFunctions&);
  bool of_places = false;  ///< makes sense on a patch only
};

/// All but `curve`, which takes any number of arguments.
const std::vector<Builtin>& builtins();
/// The one of that name, or null.
const Builtin* builtin_named(const NameKey& name);

/// The meaning of each function that the compiler knows; a member a function, so that each reads on its own.
struct BuiltinFunctions {
  using Actual = ExpressionChecker::Actual;
  ExpressionChecker& checker;
  const std::vector<Actual>& actuals;
  Span span;

  Terms& terms() const { return checker.terms_; }
  const Value& value(std::size_t i) const { return actuals[i].value; }
  Value failed() const { return checker.failed(span); }
  Value scalar(TermId x, Dimension dimension = {}) const {
    return {.type = Value::Type::number, .x = x, .dimension = dimension, .span = span};
  }
  TermId scaled(TermId x, double factor) const {
    return terms().apply(Operation::multiply, x, terms().literal(factor, span), span);
  }

  // What arguments must be; false when they are not, reported.
  bool number(std::size_t i) const;
  bool plain(std::size_t i) const;
  bool is_vector(std::size_t i) const;
  bool text(std::size_t i, const char* example) const;
  Value mismatched(std::size_t a, std::size_t b) const;
  std::optional<double> constant_argument(std::size_t i, const Dimension& dimension, const char* example) const;
  std::optional<std::string> file_argument(std::string& name) const;

  TermId dot_product(const Value& a, const Value& b) const;
  Value of_plain(Operation operation, double before = 1, double after = 1) const;
  Value absolute() const;
  Value square_root() const;
  Value arctangent() const;
  Value lattice() const;
  Value extreme(Operation operation) const;
  Value vector() const;
  Value dot() const;
  Value length() const;
  Value normalise() const;
  Value within() const;
  Value gradient() const;
  Value peak() const;
  Value hold() const;
  Value phase() const;
  Value relief() const;
  Value image() const;
  Value table() const;
};

}  // namespace wale
