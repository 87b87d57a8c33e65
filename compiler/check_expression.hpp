#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/declarations.hpp"
#include "compiler/diagnostic.hpp"
#include "compiler/resolver.hpp"
#include "compiler/syntax_tree.hpp"
#include "compiler/value.hpp"

namespace wale {

/// What surrounds the expressions of one material or declaration while they are checked.
struct Surroundings {
  const SourceSet& sources;
  const Declarations& declarations;
  Diagnostics& diagnostics;
  Resolver* resolver = nullptr;  ///< for images; none where no file may be read
};

/// Gives expressions their types and dimensions and turns them into terms, inlining functions on the way.
///
/// One checker serves one material: its terms, its tables and the carriers that its calls leave behind.
class ExpressionChecker {
 public:
  ExpressionChecker(Surroundings surroundings, Terms& terms, std::vector<HeightTable>& tables)
      : surroundings_(surroundings), terms_(terms), tables_(tables) {}

  /// The expression's value; what is wrong is reported, and the value then is `failed`.
  Value check(const SyntaxTree& tree, ExprId expr, Scope& scope);

  /// The same, and of this type and dimension, or reported: "force expected, found energy".
  Value check_as(const SyntaxTree& tree, ExprId expr, Scope& scope, Value::Type type, const Dimension& dimension);

  /// The value of a name that the parser has left as a word.
  Value named(const Word& word, Scope& scope) { return name(word, scope); }

  /// The value in SI of an expression of that dimension that needs nothing but literals; otherwise reported.
  std::optional<double> constant(const SyntaxTree& tree, ExprId expr, Scope& scope, const Dimension& dimension);

  const std::vector<Carrier>& carriers() const { return carriers_; }
  const std::vector<Span>& open_spans() const { return open_spans_; }

 private:
  friend struct BuiltinFunctions;

  /// An actual argument, checked, bound to the formal of that name.
  struct Actual {
    Value value;
    Span span;
    bool given = false;
  };

  Value number(const SyntaxTree& tree, ExprId expr, const NumberLiteral& literal, Scope& scope);
  Value name(const Word& word, Scope& scope);
  Value unary(const SyntaxTree& tree, ExprId expr, const Unary& unary, Scope& scope);
  Value binary(const SyntaxTree& tree, ExprId expr, const Binary& binary, Scope& scope);
  Value conditional(const SyntaxTree& tree, ExprId expr, const Conditional& conditional, Scope& scope);
  Value call(const SyntaxTree& tree, ExprId expr, const Call& call, Scope& scope);
  Value call_function(const SyntaxTree& tree, ExprId expr, const Call& call, const Declared<FunctionDecl>& function,
                      Scope& scope);
  bool bind_arguments(const SyntaxTree& tree, const Call& call, const std::vector<std::string>& formals, Scope& scope,
                      std::vector<Actual>& actuals);
  void record_carrier(const Call& call, const FunctionDecl& function, Scope& formals, const Value& result, Span span);

  Value add_or_compare(const SyntaxTree& tree, const Binary& node, const Value& left, const Value& right, Scope& scope,
                       Span span);
  Value multiply(const Value& left, const Value& right, Span span);
  Value divide(const Value& left, const Value& right, Span span);
  Value raise(const Value& base, const Value& exponent, Span span);

  Value failed(Span span) const;
  Value report(Code code, Span span, std::string message, std::string label = {}, std::string help = {});
  void report_dimension(const SyntaxTree& tree, ExprId expr, Scope& scope, const Value& value,
                        const Dimension& expected);
  std::string dimension_mend(const SyntaxTree& tree, ExprId expr, Scope& scope, const Dimension& expected,
                             const Dimension& found);
  std::optional<std::string> spelling_help(const std::string& word, const Scope* scope, bool functions) const;
  /// Where to point: inside a function of another file, at the call that led there.
  Span blame(Span span) const { return call_sites_.empty() || at_home(span) ? span : call_sites_.front(); }
  bool at_home(Span span) const { return !call_sites_.empty() && span.source == call_sites_.front().source; }
  std::string inside(Span span) const;       ///< " (inside `grating`)", where the place does not say so
  std::string called_from(Span span) const;  ///< "called on line 12", for a place inside a function of the same file
  const DimensionNames& names() const { return surroundings_.declarations.names; }
  const Unit* unit(const std::string& name) const;

  Surroundings surroundings_;
  Terms& terms_;
  std::vector<HeightTable>& tables_;
  std::vector<Carrier> carriers_;
  std::vector<Span> open_spans_;
  std::map<const Constant*, Value> constants_;
  bool too_large_ = false;  ///< reported
  std::vector<Span> call_sites_;
  std::vector<std::string> callees_;
};

/// Definitions lead to one another at most so deep.
inline constexpr std::size_t deepest_call = 64;

/// Whether the compiler itself defines a function of that name.
bool is_builtin_function(const std::string& name);

/// Whether the language itself gives this name a meaning on a patch: the hand's place and velocity, the patch's
/// extents.
bool names_hand_or_patch(std::string_view name);

/// The value of a term that depends on nothing, in double precision, or nothing.
std::optional<double> constant_value(const Terms& terms, TermId id);

/// The unit that people would write a quantity of this dimension in: "mm" for a length, the coherent unit otherwise.
std::string customary_unit(const Declarations& declarations, const Dimension& dimension);

}  // namespace wale
