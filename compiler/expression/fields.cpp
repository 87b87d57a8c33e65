#include "compiler/expression/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "compiler/expression/check_expression.hpp"
#include "compiler/expression/dimension_mend.hpp"

namespace wale {

Value value_at(Terms& terms, const Field& field, const Value& argument, Span span) {
  const auto literal = [&](double value) { return terms.literal(value, span); };
  const auto apply = [&](Operation operation, TermId a, TermId b) { return terms.apply(operation, a, b, span); };
  const auto between = [&](TermId value, TermId low, TermId high) {
    return apply(Operation::maximum, apply(Operation::minimum, value, high), low);
  };
  Value result{.type = Value::Type::number, .dimension = field.to, .span = span};
  const auto sampled = [&](TermId u, TermId v) {
    const TermId sample = terms.add({.kind = TermKind::operation,
                                     .operation = Operation::sample,
                                     .a = u,
                                     .b = v,
                                     .index = field.index,
                                     .span = span});
    const TermId code = terms.add({.kind = TermKind::component, .a = sample, .index = 0, .span = span});
    const TermId height = apply(Operation::multiply, code, literal(field.span));
    return field.low == 0 ? height : apply(Operation::add, height, literal(field.low));
  };
  switch (field.kind) {
    case Field::Kind::curve: {
      // Each segment adds its own rise, so that the curve is continuous in spite of rounding and needs no search.
      result.x = field.knots.front()[1];
      for (std::size_t i = 0; i + 1 < field.knots.size(); ++i) {
        const auto [from, start] = field.knots[i];
        const auto [to, end] = field.knots[i + 1];
        const TermId width = apply(Operation::subtract, to, from), rise = apply(Operation::subtract, end, start);
        const TermId along = between(apply(Operation::subtract, argument.x, from), literal(0), width);
        result.x =
            apply(Operation::add, result.x, apply(Operation::multiply, along, apply(Operation::divide, rise, width)));
      }
      return result;
    }
    case Field::Kind::table: {
      const TermId place = apply(Operation::multiply, apply(Operation::subtract, argument.x, literal(field.first)),
                                 literal(1 / field.step));
      result.x = sampled(between(place, literal(0), literal(field.samples - 1.0)), literal(0));
      return result;
    }
    case Field::Kind::relief: {
      const TermId u = apply(Operation::add, apply(Operation::multiply, argument.x, literal(1 / field.column)),
                             literal((field.columns - 1) / 2));
      const TermId v = apply(Operation::subtract, literal((field.rows - 1) / 2),
                             apply(Operation::multiply, argument.y, literal(1 / field.row)));
      result.x = sampled(u, v);
      return result;
    }
    case Field::Kind::memory: break;
  }
  const auto [u, v] = memory_place(terms, field.index, argument, span);
  const TermId recalled = terms.add({.kind = TermKind::operation,
                                     .operation = Operation::recall,
                                     .a = u,
                                     .b = v,
                                     .index = field.index,
                                     .span = span});
  result.x = terms.add({.kind = TermKind::component, .a = recalled, .index = 0, .span = span});
  return result;
}

std::array<TermId, 2> memory_place(Terms& terms, std::uint32_t memory, const Value& place, Span span) {
  const auto along = [&](TermId position, Input half, std::uint32_t axis) {
    const TermId half_cells =
        terms.apply(Operation::multiply, terms.add({.kind = TermKind::cells, .index = 2 * memory + axis, .span = span}),
                    terms.literal(0.5, span), span);
    const TermId from_centre = terms.apply(
        Operation::multiply, terms.apply(Operation::divide, position, terms.input(half, span), span), half_cells, span);
    return terms.apply(Operation::add, from_centre,
                       terms.apply(Operation::subtract, half_cells, terms.literal(0.5, span), span), span);
  };
  return {along(place.x, Input::patch_half_width, 0), along(place.y, Input::patch_half_height, 1)};
}

Value call_field(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, const Call& call, const Field& field,
                 Scope& scope) {
  const Span span = tree.span(expr);
  std::vector<Value> arguments;
  for (const auto& argument : tree.arguments(call))
    arguments.push_back(check_expression(reading, tree, argument.value, scope));
  if (std::ranges::any_of(arguments, &Value::failed)) return failed_value(span);
  const bool of_place = field.kind == Field::Kind::relief || field.kind == Field::Kind::memory;
  const auto expected = of_place ? Value::Type::vector : Value::Type::number;
  const std::string_view name = call.callee.text;
  if (arguments.size() != 1 || tree.arguments(call)[0].name)
    return reading.calls.report(
        Code::missing_argument, span,
        arguments.size() == 1 ? fmt::format("`{}` takes one place, which has no name", name)
                              : fmt::format("`{}` takes one place, found {} arguments", name, arguments.size()),
        "", of_place ? fmt::format("write `{}(hand)`", name) : fmt::format("write `{}(x)`", name));
  if (arguments[0].type != expected)
    return reading.calls.report(
        Code::wrong_type, arguments[0].span,
        fmt::format("expected {}, found {}", type_words(expected), type_words(arguments[0].type)), "",
        of_place ? "give a place, such as `hand` or `vector(x, 0 mm)`" : "give a number, such as `x`");
  if (arguments[0].dimension != field.from) {
    report_dimension(reading, tree, tree.arguments(call)[0].value, scope, arguments[0].dimension, field.from);
    return failed_value(span);
  }
  constexpr std::size_t operations_of_a_knot = 8;
  if (!reading.charge(operations_of_a_knot * field.knots.size(), span)) return failed_value(span);
  return value_at(reading.terms, field, arguments[0], span);
}

namespace {

/// The values of the arguments of `curve`; empty after an error, which is reported.
std::optional<std::vector<Value>> curve_values(ExpressionReading& reading, const SyntaxTree& tree, const Call& call,
                                               Scope& scope) {
  std::vector<Value> values;
  bool good = true;
  for (const auto& argument : tree.arguments(call)) {
    if (argument.name) {
      reading.calls.report(Code::unknown_argument, argument.name->span, "the arguments of `curve` have no names", "",
                           "give places and values in turn, as in `curve(0 mm, 0 N, 2 mm, 1 N)`");
      good = false;
    }
    values.push_back(check_expression(reading, tree, argument.value, scope));
    good = good && !values.back().failed();
  }
  return good ? std::optional(std::move(values)) : std::nullopt;
}

}  // namespace

Value curve(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, const Call& call, Scope& scope) {
  const Span span = tree.span(expr);
  const auto read = curve_values(reading, tree, call, scope);
  if (!read) return failed_value(span);
  const std::vector<Value>& values = *read;
  CallStack& calls = reading.calls;
  if (values.size() < 4 || values.size() % 2 != 0)
    return calls.report(
        Code::missing_argument, span,
        fmt::format("a curve needs at least two points, each a place and a value; found {} numbers", values.size()), "",
        "write, for example, `curve(0 mm, 0 N, 2 mm, 1 N)`");
  const Terms& terms = reading.terms;
  Field field{.kind = Field::Kind::curve, .from = values[0].dimension, .to = values[1].dimension};
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i].type != Value::Type::number)
      return calls.report(Code::wrong_type, values[i].span,
                          fmt::format("expected a number, found {}", type_words(values[i].type)), "",
                          "write a curve for each part of a vector");
    const Dimension& expected = i % 2 == 0 ? field.from : field.to;
    if (values[i].dimension != expected) {
      report_dimension(reading, tree, tree.arguments(call)[i].value, scope, values[i].dimension, expected);
      return failed_value(span);
    }
    if (terms.dependence(values[i].x).in_tick())
      return calls.report(Code::wrong_rate, values[i].span,
                          "the points of a curve must be constant, but this one changes", "",
                          "use constants and parameters; changing values can be arguments of the curve");
    if (i % 2 == 0) continue;
    field.knots.push_back({values[i - 1].x, values[i].x});
    if (i < 2) continue;
    const auto before = constant_value(terms, values[i - 3].x), here = constant_value(terms, values[i - 1].x);
    if (before && here && !(*here > *before))
      return calls.report(Code::value_out_of_range, values[i - 1].span,
                          "the places of a curve must rise from point to point", "",
                          "put the points in order; for a jump, set two places close to each other");
  }
  const Dimension to = field.to;
  return {.type = Value::Type::field, .dimension = to, .field = reading.record.keep(std::move(field)), .span = span};
}

}  // namespace wale
