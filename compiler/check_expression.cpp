#include "compiler/check_expression.hpp"

#include <fmt/format.h>

#include <cmath>
#include <unordered_map>

#include "compiler/spelling.hpp"

namespace wale {

namespace {

template <typename... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <typename... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

constexpr double largest_literal = 3.4e38;  // what a register can hold

std::string_view verb(BinaryOperator op) {
  switch (op) {
    case BinaryOperator::add: return "added";
    case BinaryOperator::subtract: return "subtracted";
    default: return "compared";
  }
}

/// What to do with a value that is neither number nor vector.
std::string calculable(Value::Type type) {
  if (type == Value::Type::boolean) return "make a number of it, as in `if x < 5 mm then 1 else 0`";
  if (type == Value::Type::text) return "texts name files and titles; write numbers without quotes";
  return "use numbers and vectors";
}

double evaluate(Operation operation, double a, double b, double c) {
  switch (operation) {
    case Operation::add: return a + b;
    case Operation::subtract: return a - b;
    case Operation::multiply: return a * b;
    case Operation::divide: return a / b;
    case Operation::negate: return -a;
    case Operation::absolute: return std::abs(a);
    case Operation::minimum: return b < a ? b : a;
    case Operation::maximum: return a < b ? b : a;
    case Operation::floor: return std::floor(a);
    case Operation::square_root: return std::sqrt(a);
    case Operation::less: return a < b ? 1 : 0;
    case Operation::select: return a != 0 ? b : c;
    case Operation::sine: return std::sin(a);
    case Operation::cosine: return std::cos(a);
    case Operation::exp2: return std::exp2(a);
    case Operation::log2: return std::log2(a);
    case Operation::normal: return 0.5 * std::erfc(-a * M_SQRT1_2);
    case Operation::limit: return std::isnan(a) || !(b >= 0) ? 0 : std::min(std::max(a, -b), b);
    case Operation::sample:
    case Operation::peak: break;
  }
  return std::nan("");
}

}  // namespace

std::optional<double> constant_value(const Terms& terms, TermId id) {
  if (!terms.dependence(id).constant()) return std::nullopt;
  // A term may be used many times over: each is evaluated once, operands first, without recursion.
  std::unordered_map<TermId, double> known;
  std::vector<TermId> waiting{id};
  while (!waiting.empty()) {
    const TermId current = waiting.back();
    const Term& term = terms[current];
    if (known.contains(current)) {
      waiting.pop_back();
      continue;
    }
    if (term.kind == TermKind::literal) {
      known[current] = term.value;
      continue;
    }
    if (term.kind != TermKind::operation || term.operation == Operation::sample) return std::nullopt;
    const TermId operands[] = {term.a, term.b, term.c};
    const int count = operand_count(term.operation);
    bool ready = true;
    for (int i = 0; i < count; ++i)
      if (!known.contains(operands[i])) waiting.push_back(operands[i]), ready = false;
    if (!ready) continue;
    const auto value = [&](int i) { return i < count ? known[operands[i]] : 0.0; };
    known[current] = evaluate(term.operation, value(0), value(1), value(2));
  }
  return known[id];
}

bool names_hand_or_patch(std::string_view name) {
  return name == "x" || name == "y" || name == "hand" || name == "velocity" || name == "patch_half_width" ||
         name == "patch_half_height" || name == "patch_rim";
}

std::string customary_unit(const Declarations& declarations, const Dimension& dimension) {
  const auto millimetre = declarations.units.find("mm");
  if (millimetre != declarations.units.end() && millimetre->second.dimension == dimension) return "mm";
  return declarations.names.unit(dimension);
}

Value ExpressionChecker::failed(Span span) const { return {.type = Value::Type::failed, .span = span}; }

std::string ExpressionChecker::inside(Span span) const {
  return callees_.empty() || at_home(span) ? std::string{} : fmt::format(" (inside `{}`)", callees_.back());
}

std::string ExpressionChecker::called_from(Span span) const {
  if (!at_home(span) || callees_.front().starts_with("let ")) return {};
  return fmt::format("called on line {}", surroundings_.sources.place(call_sites_.front()).line);
}

Value ExpressionChecker::report(Code code, Span span, std::string message, std::string label, std::string help) {
  surroundings_.diagnostics.report({.code = code,
                                    .span = blame(span),
                                    .message = message + inside(span),
                                    .label = label.empty() ? called_from(span) : std::move(label),
                                    .help = std::move(help)});
  return failed(span);
}

const Unit* ExpressionChecker::unit(const std::string& name) const {
  const auto found = surroundings_.declarations.units.find(name);
  return found == surroundings_.declarations.units.end() ? nullptr : &found->second;
}

Value ExpressionChecker::check(const SyntaxTree& tree, ExprId expr, Scope& scope) {
  const Span span = tree.span(expr);
  Value value = std::visit(Overloaded{
                               [&](const NumberLiteral& literal) { return number(tree, expr, literal, scope); },
                               [&](const TextLiteral& literal) {
                                 return Value{.type = Value::Type::text, .text = literal.text, .span = span};
                               },
                               [&](const NameUse& use) {
                                 return name({use.name, span}, scope);
                               },
                               [&](const Unary& node) { return unary(tree, expr, node, scope); },
                               [&](const Binary& node) { return binary(tree, expr, node, scope); },
                               [&](const Call& node) { return call(tree, expr, node, scope); },
                               [&](const Conditional& node) { return conditional(tree, expr, node, scope); },
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
  std::size_t next = 0;
  for (; next < literal.suffix.size(); ++next) {
    const auto& part = literal.suffix[next];
    const Unit* found = unit(part.name.text);
    if (!found) break;
    if (scope.find(part.name.text))
      return report(
          Code::ambiguous_name, part.name.span,
          fmt::format("`{}` is a unit and a name of this material", part.name.text), "which of them?",
          fmt::format("give the name another spelling, or write `* {}` when the name is meant", part.name.text));
    const int exponent = part.divides ? -part.exponent : part.exponent;
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
  for (; next < literal.suffix.size(); ++next) {
    const auto& part = literal.suffix[next];
    const bool known = scope.find(part.name.text) || surroundings_.declarations.constants.contains(part.name.text) ||
                       names_hand_or_patch(part.name.text);
    if (!known) {
      std::vector<std::string> candidates;
      for (const auto& [name, definition] : surroundings_.declarations.units) candidates.push_back(name);
      const auto near = nearest_spelling(part.name.text, candidates);
      return report(Code::unknown_unit, part.name.span, fmt::format("nothing declares a unit `{}`", part.name.text), "",
                    near ? fmt::format("did you mean `{}`?", *near)
                         : "declare it, as in `unit thou = 25.4 um`, or use one of schema/units.wale");
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

Value ExpressionChecker::name(const Word& word, Scope& scope) {
  const auto vector_of = [&](Input x, Input y, const char* dimension) {
    return Value{.type = Value::Type::vector,
                 .x = terms_.input(x, word.span),
                 .y = terms_.input(y, word.span),
                 .dimension = surroundings_.declarations.dimension(dimension),
                 .span = word.span};
  };
  const auto scalar_of = [&](Input input) {
    return Value{.type = Value::Type::number,
                 .x = terms_.input(input, word.span),
                 .dimension = surroundings_.declarations.dimension("length"),
                 .span = word.span};
  };
  if (auto* binding = scope.find(word.text)) {
    binding->used = true;
    Value value = binding->value;
    value.span = word.span;
    return value;
  }
  if (scope.hand) {
    if (word.text == "hand") return vector_of(Input::x, Input::y, "length");
    if (word.text == "velocity") return vector_of(Input::velocity_x, Input::velocity_y, "velocity");
    if (word.text == "x") return scalar_of(Input::x);
    if (word.text == "y") return scalar_of(Input::y);
    if (word.text == "patch_half_width") return scalar_of(Input::patch_half_width);
    if (word.text == "patch_half_height") return scalar_of(Input::patch_half_height);
    if (word.text == "patch_rim") return scalar_of(Input::patch_rim);
  }
  if (word.text == "open") return {.type = Value::Type::open, .span = word.span};
  if (const auto found = surroundings_.declarations.constants.find(word.text);
      found != surroundings_.declarations.constants.end()) {
    const std::string guard = "let " + word.text;
    for (const auto& callee : callees_)
      if (callee == guard)
        return report(Code::recursive_definition, word.span, fmt::format("`{}` is defined by itself", word.text), "",
                      "a `let` may use only what does not need it");
    const auto known = constants_.find(found->second.node);
    if (known == constants_.end()) {
      if (callees_.size() >= deepest_call)
        return report(Code::nested_too_deep, word.span,
                      fmt::format("more than {} definitions lead to one another here", deepest_call), "",
                      "write some of them out");
      callees_.push_back(guard);
      call_sites_.push_back(word.span);
      Scope outside;
      const Value value = check(*found->second.tree, found->second.node->value, outside);
      call_sites_.pop_back();
      callees_.pop_back();
      constants_[found->second.node] = value;
    }
    Value value = constants_.at(found->second.node);
    value.span = word.span;
    return value;
  }
  const Unit* as_unit = unit(word.text);
  if (as_unit)
    return report(Code::unknown_name, word.span, fmt::format("`{}` is a unit, and a unit follows a number", word.text),
                  "", fmt::format("write `1 {}`", word.text));
  if (surroundings_.declarations.functions.contains(word.text))
    return report(Code::unknown_name, word.span, fmt::format("`{}` is a function and needs its arguments", word.text),
                  "", fmt::format("write `{}(…)`", word.text));
  const bool place = word.text == "hand" || word.text == "velocity" || word.text == "x" || word.text == "y";
  if (place)
    return report(Code::not_constant, word.span,
                  fmt::format("`{}` changes as the hand moves, and a constant is due here", word.text), "",
                  "use numbers, units and other constants");
  return report(
      Code::unknown_name, word.span, fmt::format("nothing here is called `{}`", word.text), "",
      spelling_help(word.text, &scope, false).value_or(fmt::format("declare it above, as in `let {} = …`", word.text)));
}

Value ExpressionChecker::unary(const SyntaxTree& tree, ExprId, const Unary& node, Scope& scope) {
  Value value = check(tree, node.operand, scope);
  if (value.failed() || node.op == UnaryOperator::plus) return value;
  if (value.type != Value::Type::number && value.type != Value::Type::vector)
    return report(Code::wrong_type, value.span, fmt::format("{} cannot be negated", type_words(value.type)), "",
                  calculable(value.type));
  value.x = terms_.apply(Operation::negate, value.x, value.span);
  if (value.type == Value::Type::vector) value.y = terms_.apply(Operation::negate, value.y, value.span);
  return value;
}

Value ExpressionChecker::binary(const SyntaxTree& tree, ExprId expr, const Binary& node, Scope& scope) {
  const Span span = tree.span(expr);
  const Value left = check(tree, node.left, scope);
  const Value right = check(tree, node.right, scope);
  if (left.failed() || right.failed()) return failed(span);
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
    auto sides = names().side_by_side(left.dimension, right.dimension);
    std::string help;
    if (!left.dimension.plain() && !right.dimension.plain())
      help = "to fit the left side: " + dimension_mend(tree, node.right, scope, left.dimension, right.dimension);
    for (const auto& [bare, other] : {std::pair{&left, &right}, std::pair{&right, &left}})
      if (bare->dimension.plain() && !other->dimension.plain())
        help = fmt::format("a plain number needs a unit here, such as `{} {}`", surroundings_.sources.text(bare->span),
                           customary_unit(surroundings_.declarations, other->dimension));
    surroundings_.diagnostics.report({.code = Code::mismatched_dimensions,
                                      .span = blame(span),
                                      .message = fmt::format("{} and {} cannot be {}{}", names().words(left.dimension),
                                                             names().words(right.dimension), verb(op), inside(span)),
                                      .label = called_from(span),
                                      .expected = sides[0] + "   (left)",
                                      .found = sides[1] + "   (right)",
                                      .help = help});
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
                  names().unit(exponent.dimension), "divide it by a quantity of its own dimension");
  Value result{.type = Value::Type::number, .span = span};
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
  if (yes.type != no.type || (yes.type != Value::Type::number && yes.type != Value::Type::vector))
    return report(Code::wrong_type, span,
                  fmt::format("`then` gives {} and `else` gives {}", type_words(yes.type), type_words(no.type)), "",
                  "let both give a number, or both a vector");
  if (yes.dimension != no.dimension) {
    const auto sides = names().side_by_side(yes.dimension, no.dimension);
    surroundings_.diagnostics.report(
        {.code = Code::mismatched_dimensions,
         .span = blame(span),
         .message = fmt::format("`then` gives {}, `else` gives {}{}", names().words(yes.dimension),
                                names().words(no.dimension), inside(span)),
         .label = called_from(span),
         .expected = sides[0] + "   (then)",
         .found = sides[1] + "   (else)",
         .help = "both must have one dimension"});
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
  if (value.failed()) return std::nullopt;
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
