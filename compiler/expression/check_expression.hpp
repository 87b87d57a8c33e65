#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/expression/reading.hpp"

namespace wale {

/// An argument of a function of the language, already checked.
struct Actual {
  Value value;
  Span span;
  bool given = false;
};

/// The range that a state cannot leave, in SI.
struct StateBounds {
  double low = 0, high = 0;
};

/// Finds the types and dimensions of expressions, and turns them into terms with all functions inlined. One checker
/// serves one material. Its parts are functions that take an `ExpressionReading`: `check_name.hpp`, `arithmetic.hpp`,
/// `check_call.hpp`, `fields.hpp`, `builtin_functions.hpp`, `dimension_mend.hpp`.
class ExpressionChecker {
 public:
  ExpressionChecker(const Surroundings& surroundings, Terms& terms, std::vector<HeightTable>& tables)
      : reading_(surroundings, terms, tables) {}

  /// The expression's value. After an error, which is reported, the value is `failed`.
  Value check(const SyntaxTree& tree, ExprId expr, Scope& scope);

  /// The same, but reports a value of another type or dimension: "expected force, found energy".
  Value check_as(const SyntaxTree& tree, ExprId expr, Scope& scope, Value::Type type, const Dimension& dimension);

  /// The value of a name that the parser has read as a word.
  Value named(const Word& word, Scope& scope);

  /// The value in SI of an expression that must be constant and have that dimension; otherwise it is reported.
  std::optional<double> constant(const SyntaxTree& tree, ExprId expr, Scope& scope, const Dimension& dimension);
  /// The same for a number that has been checked.
  std::optional<double> constant(const Value& number);

  /// The bounds that a range gives to states of that dimension; empty after an error, which is reported.
  std::optional<StateBounds> bounds(const SyntaxTree& tree, const Range& written, Scope& scope,
                                    const Dimension& dimension);
  /// The bounds of states that have none of their own: as `state_bounds` below.
  std::optional<StateBounds> bounds_of(const Dimension& dimension, std::string_view declared);

  /// Calls a declared function with checked arguments in the order of its formals; those that are not given get their
  /// defaults.
  Value call_with(const Declared<FunctionDecl>& function, std::vector<Actual> actuals, const Scope& scope, Span span);

  /// Reports a name that an imported file declares without `export`; false if there is none.
  bool report_private(const Word& word);

  /// From now on, reads expressions with the names of another file.
  void read(const Declarations& declarations) { reading_.names = &declarations; }
  const Declarations& declarations() const { return *reading_.names; }

  /// Takes operations from the budget before they are done; false if it is spent, which has been reported.
  bool charge(std::size_t operations, const Span& span) { return reading_.charge(operations, span); }
  /// The component of a blend that spends the budget from now on; nothing outside blends.
  void spend_on(std::optional<Span> component) { reading_.component = component; }
  const std::optional<Span>& spender() const { return reading_.component; }

  /// From now on, tells which names are declared further down (`ExpressionReading::declared_below`).
  void look_below(std::function<std::optional<Span>(std::string_view)> declared) {
    reading_.declared_below = std::move(declared);
  }

  CallRecord& record() { return reading_.record; }

 private:
  ExpressionReading reading_;
};

/// The value of an expression: as `ExpressionChecker::check`, for the parts of the checker.
Value check_expression(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, Scope& scope);

/// As `ExpressionChecker::check_as` and `ExpressionChecker::constant`, for the parts of the checker.
Value check_expression_as(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, Scope& scope,
                          Value::Type type, const Dimension& dimension);
std::optional<double> constant_number(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, Scope& scope,
                                      const Dimension& dimension);
std::optional<double> constant_number(ExpressionReading& reading, const Value& number);

/// The bounds of states of a dimension that have none of their own: those of the dimension with the name `declared`
/// (may be empty), otherwise of the first in the alphabet that is equal to it and has bounds. Empty if there are none.
std::optional<StateBounds> state_bounds(ExpressionReading& reading, const Dimension& dimension,
                                        std::string_view declared = {});

/// In words, a quantity with which a value changes: "place", "velocity".
std::string what_changes(const Dependence& dependence);

/// Whether the compiler itself defines a function of that name.
bool is_builtin_function(std::string_view name);

/// Whether the language itself defines this name on a patch: the hand's place and motion, the patch's extents, time.
bool names_hand_or_patch(std::string_view name);

/// The value of a constant term in double precision; empty if the term is not constant. With `parameters` it may
/// depend on them too, and they have their default values.
std::optional<double> constant_value(const Terms& terms, TermId id, const std::vector<Parameter>* parameters = nullptr);

/// `hold(value, ceiling)` and `force = value limit ceiling`: limits a vector's length, then each part again, so that
/// rounding cannot exceed the limit.
Value held(Terms& terms, const Value& value, TermId ceiling, Span span);

/// The unit in which people write a quantity of this dimension: "mm" for a length, otherwise the coherent unit.
std::string customary_unit(const Declarations& declarations, const Dimension& dimension);

/// The fix that adds a missing unit after a bare number; none for other expressions.
std::vector<Fix> append_unit(const SyntaxTree& tree, ExprId expr, const std::string& unit, const SourceSet& sources);

/// The advice for a word that is not a unit: the import that brings it, the symbol of the unit that it spells out, or
/// the nearest name.
Advice unit_mend(const Word& word, const Declarations& declarations, const Surroundings& surroundings);

}  // namespace wale
