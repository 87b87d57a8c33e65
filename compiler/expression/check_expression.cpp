#include "compiler/expression/check_expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/expression/arithmetic.hpp"
#include "compiler/expression/check_call.hpp"
#include "compiler/expression/check_name.hpp"
#include "compiler/expression/dimension_mend.hpp"
#include "compiler/expression/units_in_parentheses.hpp"
#include "compiler/parse/overloaded.hpp"

namespace wale {

namespace {

constexpr double largest_literal = 3.4e38;  // the largest float32, about

/// Reports a name that is also a unit, once for each name.
Value ambiguous_unit(ExpressionReading& reading, const Word& word, Span declared) {
  auto& reported = reading.known.ambiguous;
  if (std::ranges::find(reported, declared) != reported.end()) return failed_value(word.span);
  reported.push_back(declared);
  return reading.calls.report(
      Code::ambiguous_name, word.span, fmt::format("`{}` is a unit and also a name", word.text), "which one?",
      Advice(fmt::format("give the name another spelling, or write `* {}` if you mean the name", word.text))
          .see(declared, "the name is declared here"));
}

/// Names after the units of a number multiply or divide it: `0.3 denim`, `5 N / mass`.
Value times_name(ExpressionReading& reading, const Value& value, const SuffixFactor& part, Scope& scope) {
  if (!has_value(reading, part.name.text, scope)) {
    if (reading.names->units.contains(part.name.text))
      return reading.calls.report(Code::unknown_unit, part.name.span,
                                  fmt::format("the unit `{}` stands behind a name that is no unit", part.name.text), "",
                                  "a number's units come first, then the names that multiply or divide it");
    if (const auto hidden = private_name(reading, part.name)) return *hidden;
    const bool is_full = reading.surroundings.diagnostics.is_full();
    return reading.calls.report(Code::unknown_unit, part.name.span,
                                fmt::format("nothing declares a unit `{}`", part.name.text), "",
                                is_full ? "" : unit_mend(part.name, *reading.names, reading.surroundings));
  }
  Value factor = value_of_name(reading, part.name, scope);
  if (part.exponent != 1) {
    const Value exponent{
        .type = Value::Type::number, .x = reading.terms.literal(part.exponent, part.name.span), .span = part.name.span};
    factor = raised(reading, factor, exponent, part.name.span);
  }
  return part.divides ? quotient(reading, value, factor, value.span) : product(reading, value, factor, value.span);
}

Value number(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, const NumberLiteral& literal,
             Scope& scope) {
  const Span span = tree.span(expr);
  double factor = 1;
  Dimension dimension;
  const auto suffix = tree.suffix(literal);
  std::size_t next = 0;
  for (; next < suffix.size(); ++next) {
    const auto& part = suffix[next];
    const std::string_view key = part.name.text;
    const Unit* found = reading.names->units.find(key);
    if (!found) break;
    if (const auto* binding = scope.find(key)) return ambiguous_unit(reading, part.name, binding->declared);
    if (const auto* constant = reading.names->constants.entry(key))
      return ambiguous_unit(reading, part.name, constant->declared);
    const bool twice = next > 0 && suffix[next - 1].name.text == key && part.exponent == 1 && !part.divides &&
                       suffix[next - 1].exponent == 1 && !suffix[next - 1].divides;
    if (twice)  // as in `50 %%`
      return reading.calls.report(
          Code::unknown_unit, part.name.span, fmt::format("the unit `{}` stands twice", key), "",
          found->dimension.plain() ? std::string("write it once")
                                   : fmt::format("write it once, or `{}^2` for its square", key));
    const int exponent = part.divides ? -part.exponent : part.exponent;
    const auto scaled = exponent == 1 ? found->dimension : power(found->dimension, exponent);
    if (!scaled)
      return reading.calls.report(Code::number_out_of_range, part.name.span, "the exponent of the unit is out of range",
                                  "", "units take exponents such as ^2 or ^-1");
    factor *= exponent == 1 ? found->factor : std::pow(found->factor, exponent);
    dimension = dimension * *scaled;
  }
  const double scaled = literal.value * factor;
  if (!std::isfinite(scaled) || std::abs(scaled) > largest_literal)
    return reading.calls.report(Code::number_out_of_range, span, "the number is too large to hold", "",
                                fmt::format("the largest is about {:.1e} in base units", largest_literal));
  Value value{
      .type = Value::Type::number, .x = reading.terms.literal(scaled, span), .dimension = dimension, .span = span};
  for (; next < suffix.size(); ++next) {
    // Behind an unknown name, units cannot be told from names; names that have a value count as used.
    if (value.failed() && !has_value(reading, suffix[next].name.text, scope)) continue;
    value = times_name(reading, value, suffix[next], scope);
    value.span = span;
  }
  return value;
}

[[gnu::cold]] Value too_deep(ExpressionReading& reading, const Span& span) {
  return reading.calls.report(
      Code::nested_too_deep, span,
      fmt::format("expressions are nested more than {} deep, with those of the functions called", deepest_expression),
      "", Advice("call fewer functions inside one another").fact("limit", static_cast<double>(deepest_expression)));
}

Value part_of(ExpressionReading& reading, const SyntaxTree& tree, const Part& node, Scope& scope) {
  Value value = check_expression(reading, tree, node.whole, scope);
  if (value.failed()) return value;
  if (value.type != Value::Type::vector)
    return reading.calls.report(Code::wrong_type, value.span, fmt::format("{} has no parts", type_words(value.type)),
                                "", fmt::format("leave out the `.{}`", node.part));
  return value.part(node.part);
}

Value unary(ExpressionReading& reading, const SyntaxTree& tree, const Unary& node, Scope& scope) {
  const Value value = check_expression(reading, tree, node.operand, scope);
  switch (node.op) {
    case UnaryOperator::plus: return value;
    case UnaryOperator::negate: return negated(reading, value);
    case UnaryOperator::complement: break;
  }
  return complement(reading, value);
}

/// The name of a unit that a `*` or `/` joins to a number as if it were a value, `s` in `2 N*s`; empty otherwise.
std::string_view joined_unit(const ExpressionReading& reading, const SyntaxTree& tree, ExprId expr,
                             const Scope& scope) {
  const auto* node = std::get_if<Binary>(&tree.expr(expr));
  if (!node || (node->op != BinaryOperator::multiply && node->op != BinaryOperator::divide)) return {};
  const auto* name = std::get_if<NameUse>(&tree.expr(node->right));
  if (!name || !reading.names->units.contains(name->name) || has_value(reading, name->name, scope)) return {};
  const auto* literal = std::get_if<NumberLiteral>(&tree.expr(node->left));
  const bool has_unit = literal && literal->suffix.count > 0;
  return has_unit || !joined_unit(reading, tree, node->left, scope).empty() ? name->name : std::string_view();
}

/// Reports `2 N*s/m` once, with what was meant: `2 N s/m`.
Value report_joined_units(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr) {
  const Span span = tree.span(expr);
  std::string meant(reading.surroundings.sources.text(span));
  for (std::size_t star = meant.find('*'); star != std::string::npos; star = meant.find('*', star))
    meant.replace(star, 1, " ");
  meant.erase(std::unique(meant.begin(), meant.end(), [](char a, char b) { return a == ' ' && b == ' '; }),
              meant.end());
  return reading.calls.report(Code::unknown_name, span, "the units of a number are joined by spaces", "",
                              Advice(fmt::format("write `{}`", meant)).fix(replace(span, meant)));
}

Value binary(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, const Binary& node, Scope& scope) {
  if (!joined_unit(reading, tree, expr, scope).empty()) return report_joined_units(reading, tree, expr);
  if (begins_with_unit(reading, tree, node))
    if (const auto reported = report_units_in_parentheses(reading, tree, expr, node, scope)) return *reported;
  const Value left = check_expression(reading, tree, node.left, scope);
  const Value right = check_expression(reading, tree, node.right, scope);
  return applied(reading, {tree, node, left, right, scope, tree.span(expr)});
}

Value conditional(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, const Conditional& node,
                  Scope& scope) {
  const Value condition = check_expression(reading, tree, node.condition, scope);
  const Value yes = check_expression(reading, tree, node.yes, scope);
  const Value no = check_expression(reading, tree, node.no, scope);
  return chosen(reading, condition, yes, no, tree.span(expr));
}

}  // namespace

std::string customary_unit(const Declarations& declarations, const Dimension& dimension) {
  const Unit* millimetre = declarations.units.find("mm");
  if (millimetre && millimetre->dimension == dimension) return "mm";
  return declarations.names().unit(dimension);
}

Value check_expression(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, Scope& scope) {
  const Span span = tree.span(expr);
  if (reading.depth >= deepest_expression) return too_deep(reading, span);
  ++reading.depth;
  Value value =
      std::visit(Overloaded{
                     [&](const NumberLiteral& literal) { return number(reading, tree, expr, literal, scope); },
                     [&](const TextLiteral& literal) {
                       return Value{.type = Value::Type::text, .text = literal.text, .span = span};
                     },
                     [&](const NameUse& use) {
                       return value_of_name(reading, {use.name, span}, scope);
                     },
                     [&](const Unary& node) { return unary(reading, tree, node, scope); },
                     [&](const Binary& node) { return binary(reading, tree, expr, node, scope); },
                     [&](const Call& node) { return value_of_call(reading, tree, expr, node, scope); },
                     [&](const Conditional& node) { return conditional(reading, tree, expr, node, scope); },
                     [&](const Part& node) { return part_of(reading, tree, node, scope); },
                     [&](const Erroneous&) { return failed_value(span); },
                 },
                 tree.expr(expr));
  --reading.depth;
  value.span = span;
  return value;
}

Value ExpressionChecker::check(const SyntaxTree& tree, ExprId expr, Scope& scope) {
  return check_expression(reading_, tree, expr, scope);
}

Value check_expression_as(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, Scope& scope,
                          Value::Type type, const Dimension& dimension) {
  const Value value = check_expression(reading, tree, expr, scope);
  if (value.failed()) return value;
  const bool measurable = value.type == Value::Type::number || value.type == Value::Type::vector;
  const std::string written(reading.surroundings.sources.text(value.span));
  const bool is_height = value.type == Value::Type::number &&
                         reading.terms.dependence(value.x).on(Dependence::position) &&
                         (value.dimension.plain() || value.dimension == reading.names->dimension("length"));
  if (type == Value::Type::vector && is_height && dimension == reading.names->dimension("force")) {
    report_dimension(
        reading, tree, expr, value.dimension, dimension,
        Advice(fmt::format("a height is no force; to push the hand down its slopes write `lateral({})`", written)));
    return failed_value(value.span);
  }
  if (measurable && value.dimension != dimension) {
    report_dimension(reading, tree, expr, scope, value.dimension, dimension);
    return failed_value(value.span);
  }
  if (value.type == type) return value;
  const bool is_name = std::holds_alternative<NameUse>(tree.expr(expr));
  const std::string zero = "0 " + reading.dimension_names().unit(dimension);
  const std::string mend =
      type == Value::Type::vector && measurable ? fmt::format("give both parts, as in `vector({}, {})`", written, zero)
      : value.type == Value::Type::vector && is_name
          ? fmt::format("take one of its parts, `{0}.x` or `{0}.y`, or its `length({0})`", written)
      : value.type == Value::Type::vector ? fmt::format("take its `length({})`, or work with `x` and `y`", written)
                                          : make_calculable(value.type);
  auto height = type == Value::Type::vector && value.type == Value::Type::number
                    ? height_mend(reading, tree, expr, scope, dimension)
                    : std::nullopt;
  return reading.calls.report(Code::wrong_type, value.span,
                              fmt::format("expected {}, found {}", type_words(type), type_words(value.type)), "",
                              height ? *std::move(height) : Advice(mend));
}

Value ExpressionChecker::check_as(const SyntaxTree& tree, ExprId expr, Scope& scope, Value::Type type,
                                  const Dimension& dimension) {
  return check_expression_as(reading_, tree, expr, scope, type, dimension);
}

Value ExpressionChecker::named(const Word& word, Scope& scope) { return value_of_name(reading_, word, scope); }

std::optional<double> constant_number(ExpressionReading& reading, const Value& value) {
  const auto known = constant_value(reading.terms, value.x);
  if (!known) {
    reading.calls.report(Code::not_constant, value.span, "expected a value known at compile time", "it may change",
                         "use numbers, units and other constants");
    return std::nullopt;
  }
  if (!std::isfinite(*known)) {
    reading.calls.report(Code::number_out_of_range, value.span, "the result is not a finite number", "",
                         "look for a division by zero, or the root or logarithm of a negative number");
    return std::nullopt;
  }
  return known;
}

std::optional<double> constant_number(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, Scope& scope,
                                      const Dimension& dimension) {
  const Value value = check_expression_as(reading, tree, expr, scope, Value::Type::number, dimension);
  return value.failed() ? std::nullopt : constant_number(reading, value);
}

std::optional<double> ExpressionChecker::constant(const SyntaxTree& tree, ExprId expr, Scope& scope,
                                                  const Dimension& dimension) {
  return constant_number(reading_, tree, expr, scope, dimension);
}

std::optional<double> ExpressionChecker::constant(const Value& value) { return constant_number(reading_, value); }

Value ExpressionChecker::call_with(const Declared<FunctionDecl>& function, std::vector<Actual> actuals,
                                   const Scope& scope, Span span) {
  actuals.resize(function.node->parameters.size());
  return expanded(reading_, function, std::move(actuals), scope, span);
}

bool ExpressionChecker::report_private(const Word& word) { return private_name(reading_, word).has_value(); }

}  // namespace wale
