#include "compiler/expression/check_expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/parse/overloaded.hpp"

namespace wale {

namespace {

constexpr double largest_literal = 3.4e38;  // what a register can hold

std::string_view verb(BinaryOperator op) {
  switch (op) {
    case BinaryOperator::add: return "added";
    case BinaryOperator::subtract: return "subtracted";
    default: return "compared";
  }
}

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

/// What to do with a value that is neither number nor vector.
std::string calculable(Value::Type type) {
  if (type == Value::Type::boolean) return "make a number of it, as in `if x < 5 mm then 1 else 0`";
  if (type == Value::Type::text) return "texts name files and titles; write numbers without quotes";
  return "use numbers and vectors";
}

}  // namespace

std::string customary_unit(const Declarations& declarations, const Dimension& dimension) {
  const Unit* millimetre = declarations.units.find("mm");
  if (millimetre && millimetre->dimension == dimension) return "mm";
  return declarations.names().unit(dimension);
}

Value ExpressionChecker::failed(Span span) const { return {.type = Value::Type::failed, .span = span}; }

std::string ExpressionChecker::inside(Span span) const {
  if (callees_.empty() || at_home(span)) return {};
  return fmt::format(" (inside `{}{}`)", callees_.back().constant ? "let " : "", callees_.back().name);
}

std::string ExpressionChecker::called_from(Span span) const {
  if (!at_home(span) || callees_.front().constant) return {};
  return fmt::format("called on line {}", surroundings_.sources.place(call_sites_.front()).line);
}

Value ExpressionChecker::report(Code code, Span span, std::string message, std::string label, Advice advice) {
  Diagnostic diagnostic = std::move(advice).about(code, span, std::move(message));
  diagnostic.label = std::move(label);
  say(std::move(diagnostic));
  return failed(span);
}

/// Reports it where it is to be blamed.
void ExpressionChecker::say(Diagnostic diagnostic) {
  const Span span = diagnostic.span;
  diagnostic.span = blame(span);
  diagnostic.message += inside(span);
  if (diagnostic.label.empty()) diagnostic.label = called_from(span);
  if (diagnostic.span != span) diagnostic.fixes.clear();  // they are of the other file
  surroundings_.diagnostics.report(std::move(diagnostic));
}

Value ExpressionChecker::check(const SyntaxTree& tree, ExprId expr, Scope& scope) {
  const Span span = tree.span(expr);
  Value value = std::visit(Overloaded{
                               [&](const NumberLiteral& literal) { return number(tree, expr, literal, scope); },
                               [&](const TextLiteral& literal) {
                                 return Value{.type = Value::Type::text, .text = literal.text, .span = span};
                               },
                               [&](const NameUse& use) {
                                 auto* binding = scope.find(use.name);
                                 return binding ? bound(*binding, span, scope) : free_name({use.name, span}, scope);
                               },
                               [&](const Unary& node) { return unary(tree, expr, node, scope); },
                               [&](const Binary& node) { return binary(tree, expr, node, scope); },
                               [&](const Call& node) { return call(tree, expr, node, scope); },
                               [&](const Conditional& node) { return conditional(tree, expr, node, scope); },
                               [&](const Part& node) { return part(tree, node, scope); },
                               [&](const Erroneous&) { return failed(span); },
                           },
                           tree.expr(expr));
  value.span = span;
  return value;
}

Value ExpressionChecker::number(const SyntaxTree& tree, ExprId expr, const NumberLiteral& literal, Scope& scope) {
  const Span span = tree.span(expr);
  double factor = 1;
  Dimension dimension;
  const auto suffix = tree.suffix(literal);
  std::size_t next = 0;
  for (; next < suffix.size(); ++next) {
    const auto& part = suffix[next];
    const NameKey key = part.name.text;
    const Unit* found = unit(key);
    if (!found) break;
    if (const auto* binding = scope.find(key)) return ambiguous_unit(part.name, binding->declared);
    if (const auto* constant = declarations_->constants.entry(key))
      return ambiguous_unit(part.name, constant->declared);
    const int exponent = part.divides ? -part.exponent : part.exponent;
    if (exponent == 1) {  // as nearly always
      factor *= found->factor;
      dimension = dimension * found->dimension;
      continue;
    }
    const auto scaled = power(found->dimension, exponent);
    if (!scaled)
      return report(Code::number_out_of_range, part.name.span, "an exponent this large is out of range", "",
                    "units take exponents such as ^2 or ^-1");
    factor *= std::pow(found->factor, exponent);
    dimension = dimension * *scaled;
  }
  const double scaled = literal.value * factor;
  if (!std::isfinite(scaled) || std::abs(scaled) > largest_literal)
    return report(Code::number_out_of_range, span, "a number too large to hold", "",
                  fmt::format("the largest is about {:.1e} in base units", largest_literal));
  Value value{.type = Value::Type::number, .x = terms_.literal(scaled, span), .dimension = dimension, .span = span};

  // What follows the units is a product or quotient with names: 0.3 denim, 5 N / mass.
  for (; next < suffix.size(); ++next) {
    const auto& part = suffix[next];
    if (!has_meaning(part.name.text, scope)) {
      if (const auto hidden = private_name(part.name)) return *hidden;
      return report(Code::unknown_unit, part.name.span, fmt::format("nothing declares a unit `{}`", part.name.text), "",
                    surroundings_.diagnostics.is_full() ? "" : unit_mend(part.name, *declarations_));
    }
    Value factor_value = name(part.name, scope);
    if (part.exponent != 1) {
      const Value exponent{
          .type = Value::Type::number, .x = terms_.literal(part.exponent, part.name.span), .span = part.name.span};
      factor_value = raise(factor_value, exponent, part.name.span);
    }
    value = part.divides ? divide(value, factor_value, span) : multiply(value, factor_value, span);
  }
  return value;
}

/// A name that is also a unit is one mistake, however often it is met.
Value ExpressionChecker::ambiguous_unit(const Word& word, Span declared) {
  if (std::ranges::find(ambiguous_, declared) != ambiguous_.end()) return failed(word.span);
  ambiguous_.push_back(declared);
  return report(Code::ambiguous_name, word.span, fmt::format("`{}` is a unit and also a name", word.text),
                "which of them?",
                Advice(fmt::format("give the name another spelling, or write `* {}` when the name is meant", word.text))
                    .see(declared, "the name is declared here"));
}

Value ExpressionChecker::unary(const SyntaxTree& tree, ExprId, const Unary& node, Scope& scope) {
  Value value = check(tree, node.operand, scope);
  if (value.failed() || node.op == UnaryOperator::plus) return value;
  if (node.op == UnaryOperator::complement) {
    if (value.type != Value::Type::boolean)
      return report(Code::wrong_type, value.span,
                    fmt::format("`not` is of a condition, not of {}", type_words(value.type)), "",
                    "compare it with something, as in `not x < 5 mm`");
    value.x = terms_.apply(Operation::select, value.x, terms_.literal(0), terms_.literal(1), value.span);
    return value;
  }
  if (value.type != Value::Type::number && value.type != Value::Type::vector)
    return report(Code::wrong_type, value.span, fmt::format("{} cannot be negated", type_words(value.type)), "",
                  calculable(value.type));
  value.x = terms_.apply(Operation::negate, value.x, value.span);
  if (value.type == Value::Type::vector) value.y = terms_.apply(Operation::negate, value.y, value.span);
  return value;
}

Value ExpressionChecker::part(const SyntaxTree& tree, const Part& node, Scope& scope) {
  Value value = check(tree, node.whole, scope);
  if (value.failed()) return value;
  if (value.type != Value::Type::vector)
    return report(Code::wrong_type, value.span, fmt::format("{} has no parts", type_words(value.type)), "",
                  fmt::format("leave out the `.{}`", node.part));
  value.type = Value::Type::number;
  if (node.part == 'y') value.x = value.y;
  value.y = 0;
  return value;
}

Value ExpressionChecker::binary(const SyntaxTree& tree, ExprId expr, const Binary& node, Scope& scope) {
  const Span span = tree.span(expr);
  const Value left = check(tree, node.left, scope);
  const Value right = check(tree, node.right, scope);
  if (left.failed() || right.failed()) return failed(span);
  if (node.op == BinaryOperator::conjunction || node.op == BinaryOperator::disjunction) {
    for (const auto* side : {&left, &right})
      if (side->type != Value::Type::boolean)
        return report(Code::wrong_type, side->span,
                      fmt::format("a condition is due here, not {}", type_words(side->type)), "",
                      "compare it with something, as in `x < 5 mm`");
    const auto operation = node.op == BinaryOperator::conjunction ? Operation::minimum : Operation::maximum;
    return {.type = Value::Type::boolean, .x = terms_.apply(operation, left.x, right.x, span), .span = span};
  }
  for (const auto* side : {&left, &right})
    if (side->type != Value::Type::number && side->type != Value::Type::vector)
      return report(Code::wrong_type, side->span, fmt::format("{} cannot be calculated with", type_words(side->type)),
                    "", calculable(side->type));
  switch (node.op) {
    case BinaryOperator::multiply: return multiply(left, right, span);
    case BinaryOperator::divide: return divide(left, right, span);
    case BinaryOperator::power: return raise(left, right, span);
    default: return add_or_compare(tree, node, left, right, scope, span);
  }
}

Value ExpressionChecker::add_or_compare(const SyntaxTree& tree, const Binary& node, const Value& left,
                                        const Value& right, Scope& scope, Span span) {
  const BinaryOperator op = node.op;
  if (left.type != right.type)
    return report(Code::wrong_type, span,
                  fmt::format("{} and {} cannot be {}", type_words(left.type), type_words(right.type), verb(op)), "",
                  "make the number a vector, as in `vector(1 N, 0 N)`, or take `length(…)` of the vector");
  if (left.dimension != right.dimension) {
    mismatched_sides(tree, node, left, right, scope, span);
    return failed(span);
  }
  Value result{.type = left.type, .dimension = left.dimension, .span = span};
  if (op == BinaryOperator::add || op == BinaryOperator::subtract) {
    const Operation operation = op == BinaryOperator::add ? Operation::add : Operation::subtract;
    result.x = terms_.apply(operation, left.x, right.x, span);
    if (left.type == Value::Type::vector) result.y = terms_.apply(operation, left.y, right.y, span);
    return result;
  }
  if (left.type == Value::Type::vector)
    return report(Code::wrong_type, span, "vectors have no order", "", "compare their `length(…)`");
  result.type = Value::Type::boolean;
  result.dimension = {};
  const bool swapped = op == BinaryOperator::greater || op == BinaryOperator::less_equal;
  const bool negated = op == BinaryOperator::less_equal || op == BinaryOperator::greater_equal;
  result.x = swapped ? terms_.apply(Operation::less, right.x, left.x, span)
                     : terms_.apply(Operation::less, left.x, right.x, span);
  if (negated)
    result.x = terms_.apply(Operation::select, result.x, terms_.literal(0, span), terms_.literal(1, span), span);
  return result;
}

void ExpressionChecker::mismatched_sides(const SyntaxTree& tree, const Binary& node, const Value& left,
                                         const Value& right, Scope& scope, Span span) {
  Advice advice = "";
  if (!left.dimension.plain() && !right.dimension.plain())
    advice = dimension_mend(tree, node.right, scope, left.dimension, right.dimension).behind("to fit the left side: ");
  for (const bool is_left : {true, false}) {
    const Value &bare = is_left ? left : right, &other = is_left ? right : left;
    if (!bare.dimension.plain() || other.dimension.plain()) continue;
    const std::string unit = customary_unit(*declarations_, other.dimension);
    advice = Advice(fmt::format("a plain number needs a unit here, such as `{} {}`",
                                surroundings_.sources.text(bare.span), unit))
                 .fix(append_unit(tree, is_left ? node.left : node.right, unit, surroundings_.sources));
  }
  const std::string of_left = names().words(left.dimension), of_right = names().words(right.dimension);
  Diagnostic diagnostic = std::move(advice)
                              .fact("expected", of_left)
                              .fact("found", of_right)
                              .because(fmt::format("both sides of `{}` have one dimension", sign(node.op)))
                              .about(Code::mismatched_dimensions, span,
                                     fmt::format("{} and {} cannot be {}", of_left, of_right, verb(node.op)));
  const auto sides = names().side_by_side(left.dimension, right.dimension);
  diagnostic.expected = sides[0] + "   (left)";
  diagnostic.found = sides[1] + "   (right)";
  say(std::move(diagnostic));
}

Value ExpressionChecker::multiply(const Value& left, const Value& right, Span span) {
  if (left.failed() || right.failed()) return failed(span);
  if (left.type == Value::Type::vector && right.type == Value::Type::vector)
    return report(Code::wrong_type, span, "two vectors have no single product", "",
                  "use `dot(a, b)`, or multiply their parts");
  Value result{.type = Value::Type::number, .dimension = left.dimension * right.dimension, .span = span};
  const Value& vector = left.type == Value::Type::vector ? left : right;
  if (vector.type == Value::Type::vector) {
    const Value& number = left.type == Value::Type::vector ? right : left;
    result.type = Value::Type::vector;
    result.x = terms_.apply(Operation::multiply, number.x, vector.x, span);
    result.y = terms_.apply(Operation::multiply, number.x, vector.y, span);
    return result;
  }
  result.x = terms_.apply(Operation::multiply, left.x, right.x, span);
  return result;
}

Value ExpressionChecker::divide(const Value& left, const Value& right, Span span) {
  if (left.failed() || right.failed()) return failed(span);
  if (right.type == Value::Type::vector)
    return report(Code::wrong_type, span, "nothing can be divided by a vector", "", "divide by its `length(…)`");
  Value result{.type = left.type, .dimension = left.dimension / right.dimension, .span = span};
  result.x = terms_.apply(Operation::divide, left.x, right.x, span);
  if (left.type == Value::Type::vector) result.y = terms_.apply(Operation::divide, left.y, right.x, span);
  return result;
}

Value ExpressionChecker::raise(const Value& base, const Value& exponent, Span span) {
  if (base.failed() || exponent.failed()) return failed(span);
  if (base.type != Value::Type::number || exponent.type != Value::Type::number)
    return report(Code::wrong_type, span, "powers are of numbers", "", "use `dot(a, a)` for the square of a vector");
  if (!exponent.dimension.plain())
    return report(Code::wrong_dimension, exponent.span, "an exponent is a plain number",
                  names().unit(exponent.dimension),
                  Advice("divide it by a quantity of its own dimension")
                      .fact("expected", names().words({}))
                      .fact("found", names().words(exponent.dimension)));
  Value result{.type = Value::Type::number, .span = span};
  ask_of(exponent.x);
  const auto value = constant_value(terms_, exponent.x);
  constexpr int largest_whole = 16;
  if (value) {
    for (const int denominator : {1, 2, 3, 4, 6, 12}) {
      const double numerator = *value * denominator;
      if (std::abs(numerator) > 1000 || std::abs(numerator - std::round(numerator)) > 1e-9) continue;
      const auto dimension = power(base.dimension, static_cast<int>(std::round(numerator)), denominator);
      if (!dimension) continue;
      result.dimension = *dimension;
      if (denominator == 2 && std::round(numerator) == 1) {
        result.x = terms_.apply(Operation::square_root, base.x, span);
        return result;
      }
      const int whole = static_cast<int>(std::abs(std::round(numerator)));
      if (denominator == 1 && whole <= largest_whole) {
        // Multiplications are exact where exp2 and log2 are not, and take negative bases.
        TermId product = terms_.literal(1, span);
        bool started = false;
        TermId square = base.x;
        for (int left = whole; left > 0; left >>= 1) {
          if (left & 1)
            product = started ? terms_.apply(Operation::multiply, product, square, span) : square, started = true;
          if (left > 1) square = terms_.apply(Operation::multiply, square, square, span);
        }
        result.x = *value < 0 ? terms_.apply(Operation::divide, terms_.literal(1, span), product, span) : product;
        return result;
      }
      result.x = terms_.apply(
          Operation::exp2,
          terms_.apply(Operation::multiply, exponent.x, terms_.apply(Operation::log2, base.x, span), span), span);
      return result;
    }
  }
  if (!base.dimension.plain())
    return report(Code::wrong_dimension, base.span,
                  value ? fmt::format("this power of {} is no dimension", names().words(base.dimension))
                        : fmt::format("{} to a power that may change has no dimension", names().words(base.dimension)),
                  names().unit(base.dimension),
                  "divide the base by a quantity of its own dimension, as in `(x / 1 mm)^1.3`");
  result.x = terms_.apply(
      Operation::exp2, terms_.apply(Operation::multiply, exponent.x, terms_.apply(Operation::log2, base.x, span), span),
      span);
  return result;
}

Value ExpressionChecker::conditional(const SyntaxTree& tree, ExprId expr, const Conditional& node, Scope& scope) {
  const Span span = tree.span(expr);
  const Value condition = check(tree, node.condition, scope);
  const Value yes = check(tree, node.yes, scope);
  const Value no = check(tree, node.no, scope);
  if (condition.failed() || yes.failed() || no.failed()) return failed(span);
  if (condition.type != Value::Type::boolean)
    return report(Code::wrong_type, condition.span,
                  fmt::format("a condition is due here, not {}", type_words(condition.type)), "",
                  "compare it with something, as in `x < 5 mm`");
  if (callees_.empty() && constant_value(terms_, condition.x))
    surroundings_.diagnostics.report(
        {.code = Code::unreachable,
         .span = *constant_value(terms_, condition.x) != 0 ? no.span : yes.span,
         .message = fmt::format("this is never reached: the condition is always {}",
                                *constant_value(terms_, condition.x) != 0 ? "true" : "false"),
         .help = "leave the `if` out, or let its condition depend on the hand or on a parameter"});
  if (yes.type == Value::Type::boolean && no.type == Value::Type::boolean)
    return {.type = Value::Type::boolean,
            .x = terms_.apply(Operation::select, condition.x, yes.x, no.x, span),
            .span = span};
  if (yes.type != no.type || (yes.type != Value::Type::number && yes.type != Value::Type::vector))
    return report(Code::wrong_type, span,
                  fmt::format("`then` gives {} and `else` gives {}", type_words(yes.type), type_words(no.type)), "",
                  "let both give a number, or both a vector");
  if (yes.dimension != no.dimension) {
    const auto sides = names().side_by_side(yes.dimension, no.dimension);
    const std::string of_yes = names().words(yes.dimension), of_no = names().words(no.dimension);
    Diagnostic diagnostic =
        Advice("both must have one dimension")
            .see(yes.span, of_yes)
            .see(no.span, of_no)
            .because("whichever is chosen, the value has one dimension")
            .fact("expected", of_yes)
            .fact("found", of_no)
            .about(Code::mismatched_dimensions, span, fmt::format("`then` gives {}, `else` gives {}", of_yes, of_no));
    diagnostic.expected = sides[0] + "   (then)";
    diagnostic.found = sides[1] + "   (else)";
    say(std::move(diagnostic));
    return failed(span);
  }
  Value result = yes;
  result.span = span;
  result.x = terms_.apply(Operation::select, condition.x, yes.x, no.x, span);
  if (yes.type == Value::Type::vector) result.y = terms_.apply(Operation::select, condition.x, yes.y, no.y, span);
  return result;
}

Value ExpressionChecker::check_as(const SyntaxTree& tree, ExprId expr, Scope& scope, Value::Type type,
                                  const Dimension& dimension) {
  Value value = check(tree, expr, scope);
  if (value.failed()) return value;
  const bool measurable = value.type == Value::Type::number || value.type == Value::Type::vector;
  if (measurable && value.dimension != dimension) {
    report_dimension(tree, expr, scope, value, dimension);
    return failed(value.span);
  }
  if (value.type != type) {
    const std::string text(surroundings_.sources.text(value.span));
    const std::string zero = "0 " + names().unit(dimension);
    return report(
        Code::wrong_type, value.span, fmt::format("{} is due here, not {}", type_words(type), type_words(value.type)),
        "",
        type == Value::Type::vector && measurable ? fmt::format("give both parts, as in `vector({}, {})`", text, zero)
        : value.type == Value::Type::vector       ? fmt::format("take its `length({})`, or work with `x` and `y`", text)
                                                  : calculable(value.type));
  }
  return value;
}

std::optional<double> ExpressionChecker::constant(const SyntaxTree& tree, ExprId expr, Scope& scope,
                                                  const Dimension& dimension) {
  const Value value = check_as(tree, expr, scope, Value::Type::number, dimension);
  return value.failed() ? std::nullopt : constant(value);
}

std::optional<double> ExpressionChecker::constant(const Value& value) {
  const auto known = constant_value(terms_, value.x);
  if (!known) {
    report(Code::not_constant, value.span, "a value known at compile time is due here", "it may change",
           "use numbers, units and other constants");
    return std::nullopt;
  }
  if (!std::isfinite(*known)) {
    report(Code::number_out_of_range, value.span, "this comes to no finite number", "",
           "look for a division by zero, or the root or logarithm of less than nothing");
    return std::nullopt;
  }
  return known;
}

}  // namespace wale
