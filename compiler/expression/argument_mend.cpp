#include "compiler/expression/argument_mend.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/expression/dimension_mend.hpp"
#include "compiler/expression/formal_use.hpp"

namespace wale {

namespace {

bool is_measured(const Value& value) { return value.type == Value::Type::number || value.type == Value::Type::vector; }

/// The expression of the argument that became this actual.
ExprId expression_of(const CallArguments& arguments, const Actual& actual) {
  for (const Argument& argument : arguments.tree.arguments(arguments.call))
    if (arguments.tree.span(argument.value) == actual.span) return argument.value;
  return arguments.tree.arguments(arguments.call).front().value;
}

bool misfits(const CallArguments& arguments, std::size_t i) {
  const Actual& actual = arguments.actuals[i];
  return actual.given && arguments.dimensions[i] && is_measured(actual.value) &&
         actual.value.dimension != *arguments.dimensions[i];
}

/// Whether the actual `i` would do as the formal `j`, which it does not have to for its own.
bool would_do(const CallArguments& arguments, std::size_t i, std::size_t j) {
  const Value& value = arguments.actuals[i].value;
  if (!is_measured(value)) return false;
  return arguments.dimensions[j] ? value.dimension == *arguments.dimensions[j] : true;
}

/// The other argument with which a misfitting one was exchanged: each fits at the place of the other.
std::optional<std::size_t> exchanged_with(const CallArguments& arguments, std::size_t i) {
  for (std::size_t j = 0; j < arguments.actuals.size(); ++j) {
    const bool stated = arguments.dimensions[j].has_value();
    if (j == i || !arguments.actuals[j].given || (stated && !misfits(arguments, j))) continue;
    if (!would_do(arguments, i, j) || !would_do(arguments, j, i)) continue;
    // Where any value fits, the place alone tells nothing.
    if (!stated && arguments.actuals[j].value.dimension == arguments.actuals[i].value.dimension) continue;
    return j;
  }
  return std::nullopt;
}

void report_exchanged(ExpressionReading& reading, const CallArguments& arguments, std::size_t i, std::size_t j) {
  const SourceSet& sources = reading.surroundings.sources;
  const auto& formals = arguments.function.parameters;
  const Span first = arguments.actuals[std::min(i, j)].span, second = arguments.actuals[std::max(i, j)].span;
  Fix fix = replace(first, std::string(sources.text(second)), "exchange the two arguments", false);
  fix.edits.push_back({second, std::string(sources.text(first))});
  const DimensionNames& names = reading.dimension_names();
  const std::size_t wrong = arguments.dimensions[std::min(i, j)] ? std::min(i, j) : std::max(i, j);
  const std::string expected = names.words(*arguments.dimensions[wrong]);
  const std::string found = names.words(arguments.actuals[wrong].value.dimension);
  reading.calls.say(
      Advice(fmt::format("exchange the two arguments: `{}({}, {})`", arguments.call.callee.text, sources.text(second),
                         sources.text(first)))
          .see(arguments.actuals[wrong == i ? j : i].span, fmt::format("this would be `{}`", formals[wrong].name.text))
          .fix(std::move(fix))
          .fact("expected", expected)
          .fact("found", found)
          .about(Code::wrong_dimension, arguments.actuals[wrong].span,
                 fmt::format("expected {} as `{}`, found {}", expected, formals[wrong].name.text, found)));
}

/// `spring(1,5 N/m)`: a bare number and one with the unit that was expected, with nothing but a comma between them.
bool is_decimal_comma(ExpressionReading& reading, const CallArguments& arguments, std::size_t i) {
  if (i + 1 >= arguments.actuals.size() || !arguments.actuals[i + 1].given) return false;
  const SyntaxTree& tree = arguments.tree;
  const auto* whole = std::get_if<NumberLiteral>(&tree.expr(expression_of(arguments, arguments.actuals[i])));
  const auto* rest = std::get_if<NumberLiteral>(&tree.expr(expression_of(arguments, arguments.actuals[i + 1])));
  const Span before = arguments.actuals[i].span, after = arguments.actuals[i + 1].span;
  if (!whole || !rest || whole->suffix.count > 0 || after.begin != before.end + 1 ||
      arguments.actuals[i + 1].value.dimension != *arguments.dimensions[i])
    return false;
  const SourceSet& sources = reading.surroundings.sources;
  const std::string meant = fmt::format("{}.{}", sources.text(before), sources.text(after));
  const Span comma = {before.source, before.end, after.begin};
  reading.calls.report(Code::wrong_dimension, {before.source, before.begin, after.end},
                       "decimals are written with a point, and a comma begins another argument", "",
                       Advice(fmt::format("write `{}`", meant)).fix(replace(comma, ".", "write a decimal point")));
  return true;
}

/// Another argument of the dimension of a misfitting one where a plain number was expected: the length of which it is
/// a share.
std::optional<Advice> share_mend(ExpressionReading& reading, const CallArguments& arguments, std::size_t i) {
  if (!arguments.dimensions[i]->plain()) return std::nullopt;
  const SourceSet& sources = reading.surroundings.sources;
  for (std::size_t j = arguments.actuals.size(); j-- > 0;) {
    const Actual& other = arguments.actuals[j];
    if (j == i || !other.given || misfits(arguments, j) || !is_measured(other.value)) continue;
    if (other.value.dimension != arguments.actuals[i].value.dimension) continue;
    if (reading.terms.dependence(other.value.x).on(Dependence::position)) continue;
    const auto& formals = arguments.function.parameters;
    return Advice(fmt::format("`{}` is a plain number, a share of `{}`: write `{} / ({})`", formals[i].name.text,
                              formals[j].name.text, sources.text(arguments.actuals[i].span), sources.text(other.span)));
  }
  return std::nullopt;
}

/// Whether the default of a formal is a vector, as `vector(0 m, 0 m)` says.
bool is_vector_by_default(const FunctionDecl& function, std::size_t i, const SyntaxTree& home) {
  const auto& value = function.parameters[i].default_value;
  const auto* call = value ? std::get_if<Call>(&home.expr(*value)) : nullptr;
  return call && call->callee.text == "vector";
}

}  // namespace

bool fit(ExpressionReading& reading, const CallArguments& arguments, const Scope& scope) {
  std::vector<std::size_t> wrong;
  for (std::size_t i = 0; i < arguments.actuals.size(); ++i)
    if (misfits(arguments, i)) wrong.push_back(i);
  std::set<std::size_t> said;
  std::vector<std::pair<Dimension, Dimension>> pairs;
  for (const std::size_t i : wrong) {
    if (said.contains(i)) continue;
    const bool named = std::ranges::any_of(arguments.tree.arguments(arguments.call), [&](const Argument& each) {
      return each.name && arguments.tree.span(each.value) == arguments.actuals[i].span;
    });
    if (const auto other = named ? std::nullopt : exchanged_with(arguments, i)) {
      report_exchanged(reading, arguments, i, *other);
      said.insert(*other);
      continue;
    }
    if (is_decimal_comma(reading, arguments, i)) {
      said.insert(i + 1);
      continue;
    }
    const std::pair pair(*arguments.dimensions[i], arguments.actuals[i].value.dimension);
    if (std::ranges::find(pairs, pair) != pairs.end()) continue;
    pairs.push_back(pair);
    const ExprId expr = expression_of(arguments, arguments.actuals[i]);
    auto advice = share_mend(reading, arguments, i);
    if (!advice) advice = dimension_mend(reading, arguments.tree, expr, scope, pair.first, pair.second);
    for (const std::size_t other : wrong)
      if (other > i && *arguments.dimensions[other] == pair.first &&
          arguments.actuals[other].value.dimension == pair.second)
        advice = std::move(*advice).see(arguments.actuals[other].span, "and here");
    report_dimension(reading, arguments.tree, expr, pair.second, pair.first, *std::move(advice));
  }
  return wrong.empty();
}

bool are_vectors_where_needed(ExpressionReading& reading, const CallArguments& arguments, const SyntaxTree& home) {
  for (std::size_t i = 0; i < arguments.actuals.size(); ++i) {
    const Actual& actual = arguments.actuals[i];
    if (!actual.given || actual.value.type != Value::Type::number || !is_vector_by_default(arguments.function, i, home))
      continue;
    const std::string text(reading.surroundings.sources.text(actual.span));
    const std::string zero = fmt::format("0 {}", customary_unit(*reading.names, actual.value.dimension));
    reading.calls.report(
        Code::wrong_type, actual.span,
        fmt::format("expected a vector as `{}`, found a number", arguments.function.parameters[i].name.text), "",
        Advice(fmt::format("give both parts, as in `vector({}, {})`", text, zero))
            .fix(replace(actual.span, fmt::format("vector({}, {})", text, zero), {}, false)));
    return false;
  }
  return true;
}

namespace {

/// What to write where the place stands for a number that chooses: "for one more place write `noise2(u, v)`" if a
/// function of the same name, but for the number of places, takes one place more.
std::string on_a_plane(const ExpressionReading& reading, const CallArguments& arguments) {
  const auto is_place = [](const FormalParameter& each) { return !each.default_value; };
  const auto places = std::ranges::count_if(arguments.function.parameters, is_place);
  const std::string wider = fmt::format("{}{}", arguments.call.callee.text, places + 1);
  const auto* function = reading.names->functions.find(wider);
  if (!function || std::ranges::count_if(function->node->parameters, is_place) != places + 1)
    return "give a whole number";
  std::vector<std::string_view> names;
  for (const FormalParameter& each : function->node->parameters)
    if (is_place(each)) names.push_back(each.name.text);
  return fmt::format("for one more place write `{}({})`", wider, fmt::join(names, ", "));
}

}  // namespace

void warn_of_exchanged(ExpressionReading& reading, const CallArguments& arguments) {
  const auto& formals = arguments.function.parameters;
  const auto of_place = [&](const Actual& actual) {
    return actual.given && actual.value.type == Value::Type::number &&
           reading.terms.dependence(actual.value.x).on(Dependence::position);
  };
  const auto warn = [&](std::size_t i, std::string message, std::string help) {
    reading.surroundings.diagnostics.report(
        Advice(std::move(help)).about(Code::swapped_arguments, arguments.actuals[i].span, std::move(message)));
  };
  const SourceSet& sources = reading.surroundings.sources;
  for (std::size_t i = 0; i < formals.size(); ++i) {
    const Actual& actual = arguments.actuals[i];
    if (!actual.given || actual.value.type != Value::Type::number) continue;
    const std::string_view name = formals[i].name.text, callee = arguments.call.callee.text;
    const FormalUse use = use_of(formals[i]);
    if (use == FormalUse::place && constant_value(reading.terms, actual.value.x)) {
      const auto other = std::ranges::find_if(arguments.actuals, of_place);
      if (other == arguments.actuals.end()) continue;
      warn(i,
           fmt::format("`{}` is the place, but it is the same everywhere here, and `{}` changes with the place", name,
                       formals[static_cast<std::size_t>(other - arguments.actuals.begin())].name.text),
           fmt::format("exchange the two: `{}({}, {})`", callee, sources.text(other->span), sources.text(actual.span)));
    }
    if (use == FormalUse::choosing && of_place(actual))
      warn(i,
           fmt::format("a `{}` chooses one of many noises, but this one changes with the place, so the noise jumps",
                       name),
           on_a_plane(reading, arguments));
  }
}

std::string formal_of_dimension(const FunctionDecl& function, const std::vector<std::optional<Dimension>>& dimensions,
                                const Call& call, const SyntaxTree& tree, std::size_t positional,
                                const Dimension& dimension) {
  std::string meant;
  for (std::size_t i = positional; i < function.parameters.size(); ++i) {
    const std::string_view name = function.parameters[i].name.text;
    const bool is_given = std::ranges::any_of(
        tree.arguments(call), [&](const Argument& each) { return each.name && each.name->text == name; });
    if (is_given || !dimensions[i] || *dimensions[i] != dimension || dimension.plain()) continue;
    if (!meant.empty()) return {};
    meant = std::string(name);
  }
  return meant;
}

}  // namespace wale
