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

/// Gives expressions their types and dimensions and turns them into terms, inlining functions on the way. One checker
/// serves one material. The parts that do the work are functions of a `Reading`: `check_name.hpp`, `arithmetic.hpp`,
/// `check_call.hpp`, `fields.hpp`, `builtin_functions.hpp`, `dimension_mend.hpp`.
class ExpressionChecker {
 public:
  ExpressionChecker(const Surroundings& surroundings, Terms& terms, std::vector<HeightTable>& tables)
      : reading_(surroundings, terms, tables) {}

  /// The expression's value. Errors are reported, and the value then is `failed`.
  Value check(const SyntaxTree& tree, ExprId expr, Scope& scope);

  /// The same, and of this type and dimension, or reported: "force expected, found energy".
  Value check_as(const SyntaxTree& tree, ExprId expr, Scope& scope, Value::Type type, const Dimension& dimension);

  /// The value of a name that the parser has left as a word.
  Value named(const Word& word, Scope& scope);

  /// The value in SI of an expression of that dimension that needs nothing but literals; otherwise reported.
  std::optional<double> constant(const SyntaxTree& tree, ExprId expr, Scope& scope, const Dimension& dimension);
  /// The same of a number that has been checked.
  std::optional<double> constant(const Value& number);

  /// A call of a declared function with arguments that are values already, in the order of its formals; those not
  /// given take their defaults.
  Value call_with(const Declared<FunctionDecl>& function, std::vector<Actual> actuals, const Scope& scope, Span span);

  /// Reports a name that an imported file declares without `export`; false when there is none.
  bool report_private(const Word& word);

  /// Reads another file's expressions, with its names, from now on.
  void read(const Declarations& declarations) { reading_.names = &declarations; }
  const Declarations& declarations() const { return *reading_.names; }

  CallRecord& record() { return reading_.record; }

 private:
  Reading reading_;
};

/// The value of an expression: what `ExpressionChecker::check` gives, for the parts of the checker.
Value check_expression(Reading& reading, const SyntaxTree& tree, ExprId expr, Scope& scope);

/// In words, the quantity by which a value changes while the hand rests.
std::string what_changes(const Dependence& dependence);

/// A material that needs more terms than this is far beyond what a patch program holds.
inline constexpr std::size_t most_terms = std::size_t{1} << 18;

/// Whether the compiler itself defines a function of that name.
bool is_builtin_function(std::string_view name);

/// Whether the language itself gives this name a meaning on a patch: the hand's place and motion, the patch's extents,
/// time.
bool names_hand_or_patch(std::string_view name);

/// The value of a term that depends on nothing, in double precision, or nothing. With `parameters` it may depend on
/// those too.
std::optional<double> constant_value(const Terms& terms, TermId id, const std::vector<Parameter>* parameters = nullptr);

/// `hold(value, ceiling)` and `force = value limit ceiling`: limits a vector's length, then each part again, which
/// makes the limit exact whatever the rounding.
Value held(Terms& terms, const Value& value, TermId ceiling, Span span);

/// The unit that people would write a quantity of this dimension in: "mm" for a length, the coherent unit otherwise.
std::string customary_unit(const Declarations& declarations, const Dimension& dimension);

/// The fix that writes a forgotten unit behind a bare number; none where the expression is something else.
std::vector<Fix> append_unit(const SyntaxTree& tree, ExprId expr, const std::string& unit, const SourceSet& sources);

/// The mend for a word that is no unit: the symbol of a unit written out, or the nearest name.
Advice unit_mend(const Word& word, const Declarations& declarations, const Surroundings& surroundings);

}  // namespace wale
