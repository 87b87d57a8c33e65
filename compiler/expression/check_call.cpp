#include "compiler/expression/check_call.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <utility>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/expression/argument_mend.hpp"
#include "compiler/expression/builtin_functions.hpp"
#include "compiler/expression/check_name.hpp"
#include "compiler/expression/dimension_mend.hpp"
#include "compiler/expression/fields.hpp"
#include "compiler/expression/formal_use.hpp"
#include "compiler/expression/plain_number_mend.hpp"

namespace wale {

namespace {

using FormalNames = std::vector<std::string_view>;

FormalNames names_of(const std::vector<FormalParameter>& parameters) {
  FormalNames names;
  names.reserve(parameters.size());
  for (const FormalParameter& each : parameters) names.push_back(each.name.text);
  return names;
}

std::string takes(const FormalNames& formals) {
  return formals.empty() ? "write it without arguments" : fmt::format("it takes: {}", fmt::join(formals, ", "));
}

/// A declared function and the dimensions of its formals; null for one of the compiler's own.
struct Declaration {
  const FunctionDecl* function = nullptr;
  const std::vector<std::optional<Dimension>>* dimensions = nullptr;
};

/// The advice for an argument name that the function does not have.
Advice argument_name_mend(const SyntaxTree& tree, const Call& call, const Word& name, const Value& value,
                          const FormalNames& formals, std::size_t position, const Declaration& declaration) {
  std::string meant;
  if (declaration.function && value.type == Value::Type::number)
    meant = formal_of_dimension(*declaration.function, *declaration.dimensions, call, tree, position, value.dimension);
  const std::string all = fmt::format("it takes: {}", fmt::join(formals, ", "));
  Advice otherwise = all;
  if (!meant.empty())
    otherwise = Advice(fmt::format("did you mean `{}`? {}", meant, all)).fix(replace(name.span, meant, {}, false));
  return did_you_mean(name.span, name.text, {formals.begin(), formals.end()}, std::move(otherwise));
}

/// The index of the formal for an argument; the number of formals if there is none, which is reported.
std::size_t formal_of(ExpressionReading& reading, const SyntaxTree& tree, const Argument& argument, const Value& value,
                      const Call& call, const FormalNames& formals, std::size_t position,
                      const Declaration& declaration) {
  const std::string_view callee = call.callee.text;
  const Span span = tree.span(argument.value);
  if (argument.name) {
    const Word& name = *argument.name;
    const auto found = std::ranges::find(formals, name.text);
    if (found == formals.end())
      reading.calls.report(Code::unknown_argument, name.span,
                           fmt::format("`{}` takes no argument `{}`", callee, name.text), "",
                           argument_name_mend(tree, call, name, value, formals, position, declaration));
    return static_cast<std::size_t>(found - formals.begin());
  }
  if (position >= formals.size())
    reading.calls.report(Code::unknown_argument, span,
                         fmt::format("`{}` takes {} argument{}, and this is one too many", callee, formals.size(),
                                     formals.size() == 1 ? "" : "s"),
                         "", takes(formals));
  return std::min(position, formals.size());
}

/// The values of a call's arguments in the order of the formals; empty after an error, which is reported.
struct BoundArguments {
  std::vector<Actual> actuals;
  bool good = true;
};
BoundArguments bind_arguments(ExpressionReading& reading, const SyntaxTree& tree, const Call& call,
                              const FormalNames& formals, Scope& scope, const Declaration& declaration = {}) {
  BoundArguments bound{.actuals = std::vector<Actual>(formals.size())};
  std::size_t position = 0;
  for (const Argument& argument : tree.arguments(call)) {
    const Span span = tree.span(argument.value);
    const Value value = check_expression(reading, tree, argument.value, scope);
    const std::size_t index = formal_of(reading, tree, argument, value, call, formals, position, declaration);
    if (!argument.name) ++position;
    if (index == formals.size()) {
      bound.good = false;
      continue;
    }
    Actual& actual = bound.actuals[index];
    if (actual.given) {
      reading.calls.report(Code::declared_twice, span, fmt::format("the argument `{}` is given twice", formals[index]),
                           "", Advice("give it once").see(actual.span, "given here first"));
      bound.good = false;
      continue;
    }
    actual = {.value = value, .span = span, .given = true};
    if (value.failed()) bound.good = false;
  }
  return bound;
}

Value missing_argument(ExpressionReading& reading, const Call& call, Span span, std::string_view formal,
                       const FormalNames& formals) {
  return reading.calls.report(Code::missing_argument, span,
                              fmt::format("`{}` needs its argument `{}`", call.callee.text, formal), "",
                              fmt::format("it takes: {}", fmt::join(formals, ", ")));
}

Value call_builtin(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, const Call& call,
                   const Builtin& builtin, Scope& scope) {
  const Span span = tree.span(expr);
  const auto [actuals, good] = bind_arguments(reading, tree, call, builtin.formals, scope);
  if (!good) return failed_value(span);
  for (std::size_t i = 0; i < builtin.needed; ++i)
    if (!actuals[i].given) return missing_argument(reading, call, span, builtin.formals[i], builtin.formals);
  for (const auto& actual : actuals)
    if (actual.given && actual.value.type == Value::Type::open)
      return reading.calls.report(Code::wrong_type, actual.span,
                                  "`open` can be the default of a function's argument, but not a value", "",
                                  "leave the argument out");
  if (builtin.of_places && !scope.hand)
    return reading.calls.report(
        Code::not_constant, span,
        fmt::format("expected a constant, but `{}` depends on the place on a patch", builtin.name), "",
        "use it in a material's physical block");
  return builtin.apply(BuiltinCall{reading, actuals, span, tree, call, scope});
}

/// Whether a function may be expanded here: it does not call itself, and the calls are not too deep. Otherwise it is
/// reported.
bool may_expand(ExpressionReading& reading, const Word& callee) {
  CallStack& calls = reading.calls;
  if (calls.contains(callee.text, false)) {
    calls.report(Code::recursive_definition, callee.span, fmt::format("`{}` would call itself", callee.text), "",
                 "functions are expanded where they are called, so they cannot call themselves");
    return false;
  }
  if (calls.depth() >= deepest_call) {
    calls.report(Code::nested_too_deep, callee.span,
                 fmt::format("more than {} definitions are nested here", deepest_call), "", "write some of them out");
    return false;
  }
  return true;
}

std::optional<Dimension> dimension_of(const FormalParameter& formal, const Declarations& home) {
  return formal.dimension ? home.dimension_named(formal.dimension->text) : std::nullopt;
}

Value call_function(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, const Call& call,
                    const Declared<FunctionDecl>& function, Scope& scope) {
  const Span span = tree.span(expr);
  if (!may_expand(reading, call.callee)) return failed_value(span);
  const auto& parameters = function.node->parameters;
  const FormalNames formals = names_of(parameters);
  std::vector<std::optional<Dimension>> dimensions;
  dimensions.reserve(parameters.size());
  for (const FormalParameter& each : parameters) dimensions.push_back(dimension_of(each, *function.home));
  auto [actuals, bound] = bind_arguments(reading, tree, call, formals, scope, {function.node, &dimensions});
  bool good = bound;
  for (std::size_t i = 0; i < formals.size(); ++i) {
    if (!actuals[i].given && !parameters[i].default_value && bound) {
      missing_argument(reading, call, span, formals[i], formals);
      good = false;
    }
  }
  const CallArguments arguments{tree, call, *function.node, dimensions, actuals, span};
  good = fit(reading, arguments, scope) && good;
  good = good && are_vectors_where_needed(reading, arguments, *function.tree);
  if (good && reading.calls.empty()) reading.calls.expect(plain_beside_measured(reading, arguments));
  if (good && reading.calls.empty()) warn_of_exchanged(reading, arguments);
  return good ? expanded(reading, function, std::move(actuals), scope, span) : failed_value(span);
}

Value unknown_function(ExpressionReading& reading, const Call& call, Scope& scope) {
  const std::string_view name = call.callee.text;
  if (scope.find(name) || reading.names->constants.contains(name) || names_hand_or_patch(name))
    return reading.calls.report(Code::wrong_type, call.callee.span, fmt::format("`{}` is not a function", name), "",
                                fmt::format("to multiply, write `{} * (…)`", name));
  if (const auto hidden = private_name(reading, call.callee)) return *hidden;
  if (reading.names->units.contains(name))
    return reading.calls.report(Code::unknown_name, call.callee.span,
                                fmt::format("`{}` is a unit, not a function", name), "",
                                "to multiply, write `* (…)`; a range is written `in LOW .. HIGH`");
  return reading.calls.report(Code::unknown_name, call.callee.span, fmt::format("no function is called `{}`", name), "",
                              spelling_mend(reading, call.callee, nullptr, Sought::function,
                                            "schema/LANGUAGE.md lists them; `function name(…) = …` declares one",
                                            call.arguments.count));
}

/// Whether that argument of that function carries a percept: "lateral amplitude".
bool carries_a_percept(const ExpressionReading& reading, std::string_view function, std::string_view argument) {
  bool carries = false;
  reading.surroundings.declarations.percepts.each([&](const std::string&, const Percept& percept) {
    const std::string_view carrier = percept.carrier;
    carries = carries || (carrier.size() == function.size() + 1 + argument.size() && carrier.starts_with(function) &&
                          carrier[function.size()] == ' ' && carrier.ends_with(argument));
  });
  return carries;
}

/// Records the carrier of a function whose argument may be left open: that argument is the size of a percept's carrier.
void record_carrier(ExpressionReading& reading, const FunctionDecl& function, const std::vector<Actual>& actuals,
                    const FormalParameter& formal, const Value& result, Span span) {
  const Terms& terms = reading.terms;
  // Backwards: if two formals have the same name, which is an error, the last one counts.
  const auto last = std::find_if(function.parameters.rbegin(), function.parameters.rend(),
                                 [&](const FormalParameter& each) { return each.name.text == formal.name.text; });
  const Value& size = actuals[static_cast<std::size_t>(function.parameters.rend() - last) - 1].value;
  const auto of_height = height_of(function);
  const Value* height = of_height ? &actuals[*of_height].value : nullptr;
  Carrier carrier{.name = fmt::format("{} {}", function.name.text, formal.name.text),
                  .size = size.x,
                  .open = terms[size.x].kind == TermKind::open,
                  .dimension = size.dimension,
                  .force_x = result.x,
                  .force_y = result.y,
                  .relief = {},
                  .span = reading.calls.blame(span),
                  .size_span = reading.calls.blame(size.span)};
  if (const auto fixed = carrier.open ? std::nullopt : constant_value(terms, size.x); fixed && *fixed < 0) {
    if (!height) return;  // other forces with a negative size carry no percept
    reading.calls.report(Code::value_out_of_range, span, fmt::format("`{}` is negative", formal.name.text), "",
                         "give a positive size; to push the other way, negate the height");
    return;
  }
  if (height && !terms.dependence(height->x).on(Dependence::position)) {
    reading.calls.report(Code::flat_height, span,
                         "this height is the same everywhere, and a flat height gives no force", "",
                         "let it change with `x` or `y`, as in `grating(x, period: 2.5 mm)`");
    return;
  }
  if (height) {
    carrier.relief = height->x;
    carrier.relief_dimension = height->dimension;
  }
  reading.record.carriers.push_back(std::move(carrier));
}

/// The open quantity for an argument with the default `open`; `solve` finds its value.
Value open_quantity(ExpressionReading& reading, const FormalParameter& formal, const Declarations& home, Span span) {
  auto& open_spans = reading.record.open_spans;
  const auto index = static_cast<std::uint32_t>(open_spans.size());
  open_spans.push_back(reading.calls.blame(span));
  return {.type = Value::Type::number,
          .x = reading.terms.add({.kind = TermKind::open, .index = index, .span = span}),
          .dimension = dimension_of(formal, home).value_or(Dimension{}),
          .span = span};
}

/// Gives missing arguments their defaults; false if any argument has failed.
bool fill_in(ExpressionReading& reading, const Declared<FunctionDecl>& function, std::vector<Actual>& actuals,
             bool hand, Span span) {
  bool good = true;
  for (std::size_t i = 0; i < actuals.size(); ++i) {
    const auto& formal = function.node->parameters[i];
    Value& value = actuals[i].value;
    if (!actuals[i].given) {
      Scope defaults;
      defaults.hand = hand;
      if (!reading.charge(operations_of_text(function.tree->span(*formal.default_value)), span)) return false;
      value = check_expression(reading, *function.tree, *formal.default_value, defaults);
      value.span = span;
    }
    if (value.type == Value::Type::open) value = open_quantity(reading, formal, *function.home, span);
    if (use_of(formal) == FormalUse::repeating && value.type == Value::Type::number &&
        value.dimension == dimension_of(formal, *function.home))
      reading.record.periods.push_back({value.x, reading.calls.blame(actuals[i].given ? actuals[i].span : span)});
    good = good && !value.failed();
  }
  return good;
}

Value body(ExpressionReading& reading, const Declared<FunctionDecl>& function, const std::vector<Actual>& actuals,
           bool hand) {
  const FunctionDecl& declaration = *function.node;
  Scope names;
  names.hand = hand;
  names.reserve(actuals.size());
  for (std::size_t i = 0; i < actuals.size(); ++i)
    names.declare(declaration.parameters[i].name.text, actuals[i].value, declaration.parameters[i].name.span);
  return check_expression(reading, *function.tree, declaration.body, names);
}

}  // namespace

Value expanded(ExpressionReading& reading, const Declared<FunctionDecl>& function, std::vector<Actual> actuals,
               const Scope& scope, Span span) {
  const FunctionDecl& declaration = *function.node;
  const auto* outside_names = std::exchange(reading.names, function.home);
  Value result = failed_value(span);
  constexpr std::size_t operations_of_a_call = 8, of_an_argument = 4;
  const std::size_t operations = operations_of_a_call + of_an_argument * actuals.size() +
                                 operations_of_text(function.tree->span(declaration.body));
  if (reading.charge(operations, span) && fill_in(reading, function, actuals, scope.hand, span)) {
    reading.calls.enter(declaration.name.text, false, span);
    result = body(reading, function, actuals, scope.hand);
    reading.calls.leave();
  }
  reading.names = outside_names;
  result.span = span;
  if (result.type == Value::Type::vector)
    for (const auto& formal : declaration.parameters)
      if (formal.default_value && carries_a_percept(reading, declaration.name.text, formal.name.text))
        record_carrier(reading, declaration, actuals, formal, result, span);
  return result;
}

Value value_of_call(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, const Call& call, Scope& scope) {
  const Span span = tree.span(expr);
  const std::string_view callee = call.callee.text;
  if (call.quoted)
    return reading.calls.report(Code::wrong_type, call.callee.span, "a text is no function", "",
                                "write the name of a function, without quotes");
  auto* binding = scope.find(callee);
  if (binding && binding->value.type == Value::Type::field) {
    binding->used = true;
    return call_field(reading, tree, expr, call, *binding->value.field, scope);
  }
  const Builtin* builtin = builtin_named(callee);
  const auto* function = builtin ? nullptr : reading.names->functions.find(callee);  // no function is both
  if (binding && !function && binding->value.failed()) {
    binding->used = true;
    return failed_value(span);  // reported at its declaration
  }
  if (function) return call_function(reading, tree, expr, call, *function, scope);
  if (callee == "curve") return curve(reading, tree, expr, call, scope);
  if (builtin) return call_builtin(reading, tree, expr, call, *builtin, scope);
  if (reading.names->constants.contains(callee)) {
    const Value constant = value_of_name(reading, call.callee, scope);
    if (constant.failed()) return constant;
    if (constant.type == Value::Type::field) return call_field(reading, tree, expr, call, *constant.field, scope);
  }
  for (const Argument& argument : tree.arguments(call))
    check_expression(reading, tree, argument.value, scope);  // to report the errors of the arguments too
  return unknown_function(reading, call, scope);
}

std::string what_changes(const Dependence& dependence) {
  if (dependence.on(Dependence::velocity)) return "velocity";
  return dependence.on(Dependence::state) ? "what the material remembers" : "time";
}

}  // namespace wale
