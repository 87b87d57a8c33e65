#include "compiler/expression/argument_mend.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
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

bool of_place(const ExpressionReading& reading, const Actual& actual) {
  return actual.given && actual.value.type == Value::Type::number &&
         reading.terms.dependence(actual.value.x).on(Dependence::position);
}

/// The call as it would be written with the arguments in another order: each at the place of the one that it replaces.
std::string reordered(const SourceSet& sources, const CallArguments& arguments, const Fix& order) {
  std::vector<Edit> edits = order.edits;
  std::ranges::sort(edits, {}, [](const Edit& each) { return each.span.begin; });
  std::string text;
  Span rest = arguments.span;
  for (const Edit& each : edits) {
    text += sources.text({rest.source, rest.begin, each.span.begin});
    text += each.replacement;
    rest.begin = each.span.end;
  }
  return text += sources.text(rest);
}

/// An order of a call's arguments: for each formal the actual that it gets.
using Order = std::vector<std::size_t>;

Fix fix_of(const SourceSet& sources, const CallArguments& arguments, const Order& order) {
  Fix fix;
  for (std::size_t i = 0; i < order.size(); ++i)
    if (order[i] != i)
      fix.edits.push_back({arguments.actuals[i].span, std::string(sources.text(arguments.actuals[order[i]].span))});
  fix.title = fix.edits.size() == 2 ? "exchange the two arguments" : "put the arguments in order";
  return fix;
}

/// The orders of the arguments that a call has in which each fits, and in which most stay at their places.
class Orders {
 public:
  Orders(const ExpressionReading& reading, const CallArguments& arguments) : reading_(reading), arguments_(arguments) {
    const std::size_t count = arguments.actuals.size();
    for (std::size_t i = 0; i < count; ++i) {
      if (!arguments.actuals[i].given || !is_measured(arguments.actuals[i].value)) continue;
      given_.push_back(i), any_of_place_ = any_of_place_ || of_place(reading, arguments.actuals[i]);
    }
    order_.resize(count);
    for (std::size_t i = 0; i < count; ++i) order_[i] = i;
    taken_.resize(count);
    constexpr std::size_t most_ordered = 6;
    if (given_.size() <= most_ordered) look(0, 0);
  }

  /// The only one of those with the fewest exchanges.
  std::optional<Order> best() const { return number_ == 1 ? std::optional(best_) : std::nullopt; }

 private:
  bool is_named(const Actual& actual) const {
    return std::ranges::any_of(arguments_.tree.arguments(arguments_.call), [&](const Argument& each) {
      return each.name && arguments_.tree.span(each.value) == actual.span;
    });
  }

  bool fits(std::size_t from, std::size_t to) const {
    const Actual &actual = arguments_.actuals[from], &there = arguments_.actuals[to];
    const auto& expected = arguments_.dimensions[to];
    if (expected && actual.value.dimension != *expected) return false;
    const FormalUse use = use_of(arguments_.function.parameters[to]);
    const bool place = of_place(reading_, actual);
    if (use == FormalUse::place && any_of_place_ && !place) return false;
    if ((use == FormalUse::repeating || use == FormalUse::choosing) && place) return false;
    if (from == to) return true;
    // Where any value fits, neither a name that the author wrote nor the place alone tells anything.
    return expected || (!is_named(there) && actual.value.dimension != there.value.dimension);
  }

  void look(std::size_t at, std::size_t moved) {
    if (moved > fewest_) return;
    if (at == given_.size()) {
      number_ = moved < fewest_ ? 1 : number_ + 1;
      fewest_ = moved, best_ = order_;
      return;
    }
    for (const std::size_t from : given_) {
      if (taken_[from] || !fits(from, given_[at])) continue;
      taken_[from] = true, order_[given_[at]] = from;
      look(at + 1, moved + (from == given_[at] ? 0 : 1));
      taken_[from] = false, order_[given_[at]] = given_[at];
    }
  }

  const ExpressionReading& reading_;
  const CallArguments& arguments_;
  std::vector<std::size_t> given_;
  bool any_of_place_ = false;
  std::vector<char> taken_;
  Order order_, best_;
  std::size_t fewest_ = SIZE_MAX, number_ = 0;
};

void report_order(ExpressionReading& reading, const CallArguments& arguments, const Order& order, std::size_t wrong) {
  const SourceSet& sources = reading.surroundings.sources;
  const auto& formals = arguments.function.parameters;
  Fix fix = fix_of(sources, arguments, order);
  const DimensionNames& names = reading.dimension_names();
  const std::string expected = names.words(*arguments.dimensions[wrong]);
  const std::string found = names.words(arguments.actuals[wrong].value.dimension);
  reading.calls.say(
      Advice(fmt::format("{}: `{}`", fix.title, reordered(sources, arguments, fix)))
          .see(arguments.actuals[order[wrong]].span, fmt::format("this would be `{}`", formals[wrong].name.text))
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

/// Whether a formal is one number: a place on a line, or what has a number as its default.
bool is_of_a_line(const FunctionDecl& function, std::size_t i, const SyntaxTree& home) {
  if (use_of(function.parameters[i]) != FormalUse::any) return true;
  const auto& value = function.parameters[i].default_value;
  return value && std::holds_alternative<NumberLiteral>(home.expr(*value));
}

}  // namespace

bool fit(ExpressionReading& reading, const CallArguments& arguments, const Scope& scope) {
  std::vector<std::size_t> wrong;
  for (std::size_t i = 0; i < arguments.actuals.size(); ++i)
    if (misfits(arguments, i)) wrong.push_back(i);
  if (wrong.empty()) return true;
  if (const auto order = Orders(reading, arguments).best()) {
    report_order(reading, arguments, *order, wrong.front());
    return false;
  }
  std::set<std::size_t> said;
  std::vector<std::pair<Dimension, Dimension>> pairs;
  for (const std::size_t i : wrong) {
    if (said.contains(i)) continue;
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
  return false;
}

bool are_vectors_where_needed(ExpressionReading& reading, const CallArguments& arguments, const SyntaxTree& home) {
  for (std::size_t i = 0; i < arguments.actuals.size(); ++i) {
    const Actual& actual = arguments.actuals[i];
    if (actual.given && actual.value.type == Value::Type::vector && is_of_a_line(arguments.function, i, home)) {
      const std::string text(reading.surroundings.sources.text(actual.span));
      reading.calls.report(
          Code::wrong_type, actual.span,
          fmt::format("expected a number as `{}`, found a vector", arguments.function.parameters[i].name.text), "",
          Advice(fmt::format("take what it is along one axis, as in `{}.x`", text))
              .fix(insert_after(actual.span, ".x", {}, false)));
      return false;
    }
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
  const auto warn = [&](std::size_t i, std::string message, Advice help) {
    reading.surroundings.diagnostics.report(
        std::move(help).about(Code::swapped_arguments, arguments.actuals[i].span, std::move(message)));
  };
  const SourceSet& sources = reading.surroundings.sources;
  for (std::size_t i = 0; i < formals.size(); ++i) {
    const Actual& actual = arguments.actuals[i];
    if (!actual.given || actual.value.type != Value::Type::number) continue;
    const std::string_view name = formals[i].name.text;
    const FormalUse use = use_of(formals[i]);
    if (use == FormalUse::place && constant_value(reading.terms, actual.value.x)) {
      const auto other =
          std::ranges::find_if(arguments.actuals, [&](const Actual& each) { return of_place(reading, each); });
      if (other == arguments.actuals.end()) continue;
      const auto j = static_cast<std::size_t>(other - arguments.actuals.begin());
      Advice help = "let it change with `x` or `y`";
      if (other->value.dimension == actual.value.dimension) {
        Order order(formals.size());
        for (std::size_t k = 0; k < order.size(); ++k) order[k] = k == i ? j : k == j ? i : k;
        Fix fix = fix_of(sources, arguments, order);
        help = Advice(fmt::format("exchange the two: `{}`", reordered(sources, arguments, fix))).fix(std::move(fix));
      }
      warn(i,
           fmt::format("`{}` is the place, but it is the same everywhere here, and `{}` changes with the place", name,
                       formals[j].name.text),
           std::move(help));
    }
    if (use == FormalUse::choosing && of_place(reading, actual))
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
