#include "compiler/expression/arithmetic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/expression/check_expression.hpp"
#include "compiler/expression/dimension_mend.hpp"

namespace wale {

namespace {

std::string_view sign(BinaryOperator op) {
  switch (op) {
    case BinaryOperator::add: return "+";
    case BinaryOperator::subtract: return "-";
    case BinaryOperator::less: return "<";
    case BinaryOperator::less_equal: return "<=";
    case BinaryOperator::greater: return ">";
    default: return ">=";
  }
}

bool is_measurable(const Value& value) {
  return value.type == Value::Type::number || value.type == Value::Type::vector;
}

void report_mismatch(ExpressionReading& reading, const OperatorUse& use) {
  const auto& [tree, node, left, right, scope, span] = use;
  const SourceSet& sources = reading.surroundings.sources;
  const DimensionNames& names = reading.dimension_names();
  Advice advice = "";
  if (!left.dimension.plain() && !right.dimension.plain())
    advice = dimension_mend(reading, tree, node.right, scope, left.dimension, right.dimension)
                 .behind("to fit the left side: ");
  for (const bool is_left : {true, false}) {
    const Value &bare = is_left ? left : right, &other = is_left ? right : left;
    if (!bare.dimension.plain() || other.dimension.plain()) continue;
    const std::string unit = customary_unit(*reading.names, other.dimension);
    advice = Advice(fmt::format("a plain number needs a unit here, such as `{} {}`", sources.text(bare.span), unit))
                 .fix(append_unit(tree, is_left ? node.left : node.right, unit, sources));
  }
  const std::string of_left = names.words(left.dimension), of_right = names.words(right.dimension);
  Diagnostic diagnostic = std::move(advice)
                              .fact("expected", of_left)
                              .fact("found", of_right)
                              .because(fmt::format("both sides of `{}` must have the same dimension", sign(node.op)))
                              .about(Code::mismatched_dimensions, span,
                                     fmt::format("expected the same dimension on both sides of `{}`, found {} and {}",
                                                 sign(node.op), of_left, of_right));
  const auto sides = names.side_by_side(left.dimension, right.dimension);
  diagnostic.expected = sides[0] + "   (left)";
  diagnostic.found = sides[1] + "   (right)";
  reading.calls.say(std::move(diagnostic));
}

Value compared(ExpressionReading& reading, const OperatorUse& use) {
  const auto& [tree, node, left, right, scope, span] = use;
  if (left.type == Value::Type::vector)
    return reading.calls.report(Code::wrong_type, span, "vectors cannot be compared", "", "compare their `length(…)`");
  Terms& terms = reading.terms;
  const BinaryOperator op = node.op;
  const bool swapped = op == BinaryOperator::greater || op == BinaryOperator::less_equal;
  const bool negates = op == BinaryOperator::less_equal || op == BinaryOperator::greater_equal;
  Value result{.type = Value::Type::boolean, .span = span};
  result.x = swapped ? terms.apply(Operation::less, right.x, left.x, span)
                     : terms.apply(Operation::less, left.x, right.x, span);
  if (negates)
    result.x = terms.apply(Operation::select, result.x, terms.literal(0, span), terms.literal(1, span), span);
  return result;
}

/// "vector(10 mm, 0 mm)" for the number beside a vector, in the unit in which it is written.
std::string as_vector(const ExpressionReading& reading, const OperatorUse& use) {
  const bool left = use.left.type == Value::Type::number;
  const ExprId number = left ? use.node.left : use.node.right;
  const std::string unit = reading.dimension_names().unit((left ? use.left : use.right).dimension);
  if (!std::holds_alternative<NumberLiteral>(use.tree.expr(number)))
    return fmt::format("vector(…, 0{}{})", unit.empty() ? "" : " ", unit);
  const std::string written(reading.surroundings.sources.text(use.tree.span(number)));
  const std::size_t behind = std::min(written.find_first_of(' '), written.size());
  return fmt::format("vector({}, 0{})", written, written.substr(behind));
}

Value added_or_compared(ExpressionReading& reading, const OperatorUse& use) {
  const auto& [tree, node, left, right, scope, span] = use;
  if (left.type != right.type) {
    const bool orders = node.op != BinaryOperator::add && node.op != BinaryOperator::subtract;  // vectors have no order
    return reading.calls.report(
        Code::wrong_type, span,
        fmt::format("expected two numbers{} around `{}`, found {} and {}", orders ? "" : " or two vectors",
                    sign(node.op), type_words(left.type), type_words(right.type)),
        "", orders ? std::string("take `length(…)` of the vector, or its part along an axis, as in `hand.x`")
                   : fmt::format("make the number a vector, as in `{}`, or take `length(…)` of the vector",
                                 as_vector(reading, use)));
  }
  if (left.dimension != right.dimension) {
    report_mismatch(reading, use);
    return failed_value(span);
  }
  if (node.op != BinaryOperator::add && node.op != BinaryOperator::subtract) return compared(reading, use);
  const Operation operation = node.op == BinaryOperator::add ? Operation::add : Operation::subtract;
  Value result{.type = left.type, .dimension = left.dimension, .span = span};
  result.x = reading.terms.apply(operation, left.x, right.x, span);
  if (left.type == Value::Type::vector) result.y = reading.terms.apply(operation, left.y, right.y, span);
  return result;
}

/// `and` or `or` of two conditions, whose values are 1 or 0.
Value combined(ExpressionReading& reading, const OperatorUse& use) {
  for (const auto* side : {&use.left, &use.right})
    if (side->type != Value::Type::boolean)
      return reading.calls.report(Code::wrong_type, side->span,
                                  fmt::format("expected a condition, found {}", type_words(side->type)), "",
                                  "compare it with something, as in `x < 5 mm`");
  const auto operation = use.node.op == BinaryOperator::conjunction ? Operation::minimum : Operation::maximum;
  return {.type = Value::Type::boolean,
          .x = reading.terms.apply(operation, use.left.x, use.right.x, use.span),
          .span = use.span};
}

/// A whole power by repeated multiplication, which unlike exp2 and log2 is exact for small numbers and negative bases.
TermId whole_power(Terms& terms, TermId base, int exponent, Span span) {
  const TermId one = terms.literal(1, span);
  std::optional<TermId> result;
  TermId square = base;
  for (int left = std::abs(exponent); left > 0; left >>= 1) {
    if (left & 1) result = result ? terms.apply(Operation::multiply, *result, square, span) : square;
    if (left > 1) square = terms.apply(Operation::multiply, square, square, span);
  }
  if (!result) return one;
  return exponent < 0 ? terms.apply(Operation::divide, one, *result, span) : *result;
}

/// An exponent as a fraction with one of the denominators that dimensions have, `Dimension::unit_exponent` at most.
struct Fraction {
  int numerator = 0, denominator = 1;
};
std::optional<Fraction> fraction_of(double exponent, int denominator) {
  constexpr double largest = 1000, rounding = 1e-9;
  const double numerator = exponent * denominator;
  if (std::abs(numerator) > largest || std::abs(numerator - std::round(numerator)) > rounding) return std::nullopt;
  return Fraction{static_cast<int>(std::round(numerator)), denominator};
}

TermId power_by_logarithm(Terms& terms, TermId base, TermId exponent, Span span) {
  const TermId logarithm = terms.apply(Operation::log2, base, span);
  return terms.apply(Operation::exp2, terms.apply(Operation::multiply, exponent, logarithm, span), span);
}

/// A power with a known exponent; empty if that power of the base's dimension does not exist.
std::optional<Value> known_power(Terms& terms, const Value& base, const Value& exponent, double value, Span span) {
  constexpr int largest_whole = 16;
  for (const int denominator : {1, 2, 3, 4, 6, 12}) {
    const auto fraction = fraction_of(value, denominator);
    const auto dimension = fraction ? power(base.dimension, fraction->numerator, denominator) : std::nullopt;
    if (!dimension) continue;
    Value result{.type = Value::Type::number, .dimension = *dimension, .span = span};
    if (denominator == 2 && fraction->numerator == 1)
      result.x = terms.apply(Operation::square_root, base.x, span);
    else if (denominator == 1 && std::abs(fraction->numerator) <= largest_whole)
      result.x = whole_power(terms, base.x, fraction->numerator, span);
    else
      result.x = power_by_logarithm(terms, base.x, exponent.x, span);
    return result;
  }
  return std::nullopt;
}

}  // namespace

std::string make_calculable(Value::Type type) {
  if (type == Value::Type::boolean) return "turn it into a number, as in `if x < 5 mm then 1 else 0`";
  if (type == Value::Type::text) return "texts are for files and titles; write numbers without quotes";
  return "use numbers and vectors";
}

Value negated(ExpressionReading& reading, Value value) {
  if (value.failed()) return value;
  if (!is_measurable(value))
    return reading.calls.report(Code::wrong_type, value.span,
                                fmt::format("{} cannot be negated", type_words(value.type)), "",
                                make_calculable(value.type));
  value.x = reading.terms.apply(Operation::negate, value.x, value.span);
  if (value.type == Value::Type::vector) value.y = reading.terms.apply(Operation::negate, value.y, value.span);
  return value;
}

Value complement(ExpressionReading& reading, Value condition) {
  if (condition.failed()) return condition;
  if (condition.type != Value::Type::boolean)
    return reading.calls.report(Code::wrong_type, condition.span,
                                fmt::format("expected a condition after `not`, found {}", type_words(condition.type)),
                                "", "compare it with something, as in `not x < 5 mm`");
  Terms& terms = reading.terms;
  condition.x = terms.apply(Operation::select, condition.x, terms.literal(0), terms.literal(1), condition.span);
  return condition;
}

Value product(ExpressionReading& reading, const Value& left, const Value& right, Span span) {
  if (left.failed() || right.failed()) return failed_value(span);
  if (left.type == Value::Type::vector && right.type == Value::Type::vector)
    return reading.calls.report(Code::wrong_type, span, "two vectors cannot be multiplied", "",
                                "use `dot(a, b)`, or multiply their parts");
  Terms& terms = reading.terms;
  Value result{.type = Value::Type::number, .dimension = left.dimension * right.dimension, .span = span};
  const Value& vector = left.type == Value::Type::vector ? left : right;
  if (vector.type == Value::Type::vector) {
    const Value& number = left.type == Value::Type::vector ? right : left;
    result.type = Value::Type::vector;
    result.x = terms.apply(Operation::multiply, number.x, vector.x, span);
    result.y = terms.apply(Operation::multiply, number.x, vector.y, span);
    return result;
  }
  result.x = terms.apply(Operation::multiply, left.x, right.x, span);
  return result;
}

Value quotient(ExpressionReading& reading, const Value& left, const Value& right, Span span) {
  if (left.failed() || right.failed()) return failed_value(span);
  if (right.type == Value::Type::vector)
    return reading.calls.report(Code::wrong_type, span, "cannot divide by a vector", "", "divide by its `length(…)`");
  Value result{.type = left.type, .dimension = left.dimension / right.dimension, .span = span};
  result.x = reading.terms.apply(Operation::divide, left.x, right.x, span);
  if (left.type == Value::Type::vector) result.y = reading.terms.apply(Operation::divide, left.y, right.x, span);
  return result;
}

Value raised(ExpressionReading& reading, const Value& base, const Value& exponent, Span span) {
  if (base.failed() || exponent.failed()) return failed_value(span);
  const DimensionNames& names = reading.dimension_names();
  if (base.type != Value::Type::number || exponent.type != Value::Type::number)
    return reading.calls.report(Code::wrong_type, span, "only a number can be raised to a power", "",
                                "use `dot(a, a)` for the square of a vector");
  if (!exponent.dimension.plain())
    return reading.calls.report(Code::wrong_dimension, exponent.span, "the exponent must be a plain number",
                                names.unit(exponent.dimension),
                                Advice("divide it by a quantity of its own dimension")
                                    .fact("expected", names.words({}))
                                    .fact("found", names.words(exponent.dimension)));
  const auto value = constant_value(reading.terms, exponent.x);
  const bool whole = value && *value == std::floor(*value);
  if (!whole) reading.record.operands.push_back({base.x, "a fractional power", reading.calls.blame(base.span)});
  if (value)
    if (const auto result = known_power(reading.terms, base, exponent, *value, span)) return *result;
  if (!base.dimension.plain()) {
    const std::string of_base = names.words(base.dimension);
    return reading.calls.report(Code::wrong_dimension, base.span,
                                value ? fmt::format("this power of {} has no dimension", of_base)
                                      : fmt::format("{} to a power that may change has no fixed dimension", of_base),
                                names.unit(base.dimension),
                                "divide the base by a quantity of its own dimension, as in `(x / 1 mm)^1.3`");
  }
  return {.type = Value::Type::number, .x = power_by_logarithm(reading.terms, base.x, exponent.x, span), .span = span};
}

Value applied(ExpressionReading& reading, const OperatorUse& use) {
  const auto& [tree, node, left, right, scope, span] = use;
  if (left.failed() || right.failed()) return failed_value(span);
  if (node.op == BinaryOperator::conjunction || node.op == BinaryOperator::disjunction) return combined(reading, use);
  for (const auto* side : {&left, &right})
    if (!is_measurable(*side))
      return reading.calls.report(Code::wrong_type, side->span,
                                  fmt::format("cannot calculate with {}", type_words(side->type)), "",
                                  make_calculable(side->type));
  switch (node.op) {
    case BinaryOperator::multiply: return product(reading, left, right, span);
    case BinaryOperator::divide: return quotient(reading, left, right, span);
    case BinaryOperator::power: return raised(reading, left, right, span);
    default: return added_or_compared(reading, use);
  }
}

Value chosen(ExpressionReading& reading, const Value& condition, const Value& yes, const Value& no, Span span) {
  if (condition.failed() || yes.failed() || no.failed()) return failed_value(span);
  Terms& terms = reading.terms;
  if (condition.type != Value::Type::boolean)
    return reading.calls.report(Code::wrong_type, condition.span,
                                fmt::format("expected a condition, found {}", type_words(condition.type)), "",
                                "compare it with something, as in `x < 5 mm`");
  const auto known = reading.calls.empty() ? constant_value(terms, condition.x) : std::nullopt;
  if (known)
    reading.surroundings.diagnostics.report(
        {.code = Code::unreachable,
         .span = *known != 0 ? no.span : yes.span,
         .message = fmt::format("this is never used: the condition is always {}", *known != 0 ? "true" : "false"),
         .help = "remove the `if`, or let its condition depend on the hand or on a parameter"});
  if (yes.type == Value::Type::boolean && no.type == Value::Type::boolean)
    return {.type = Value::Type::boolean,
            .x = terms.apply(Operation::select, condition.x, yes.x, no.x, span),
            .span = span};
  if (yes.type != no.type || !is_measurable(yes))
    return reading.calls.report(Code::wrong_type, span,
                                fmt::format("expected the same type after `then` and `else`, found {} and {}",
                                            type_words(yes.type), type_words(no.type)),
                                "", "let both give a number, or both a vector");
  if (yes.dimension != no.dimension) {
    const DimensionNames& names = reading.dimension_names();
    const auto sides = names.side_by_side(yes.dimension, no.dimension);
    const std::string of_yes = names.words(yes.dimension), of_no = names.words(no.dimension);
    Diagnostic diagnostic =
        Advice("both must have the same dimension")
            .see(yes.span, of_yes)
            .see(no.span, of_no)
            .because("the value must have the same dimension in both cases")
            .fact("expected", of_yes)
            .fact("found", of_no)
            .about(Code::mismatched_dimensions, span,
                   fmt::format("expected the same dimension after `then` and `else`, found {} and {}", of_yes, of_no));
    diagnostic.expected = sides[0] + "   (then)";
    diagnostic.found = sides[1] + "   (else)";
    reading.calls.say(std::move(diagnostic));
    return failed_value(span);
  }
  Value result = yes;
  result.span = span;
  result.x = terms.apply(Operation::select, condition.x, yes.x, no.x, span);
  if (yes.type == Value::Type::vector) result.y = terms.apply(Operation::select, condition.x, yes.y, no.y, span);
  return result;
}

}  // namespace wale
