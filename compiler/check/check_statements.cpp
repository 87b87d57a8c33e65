#include "compiler/check/check_statements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <type_traits>
#include <utility>

#include "compiler/text/readable.hpp"

namespace wale {

namespace {

/// The name that a statement declares, or null.
const Word* declared_word(const PhysicalStatement& statement) {
  return std::visit(
      [](const auto& node) -> const Word* {
        using Node = std::decay_t<decltype(node)>;
        if constexpr (std::is_same_v<Node, ForceStatement>)
          return node.name ? &*node.name : nullptr;
        else if constexpr (requires { node.name; } && !std::is_same_v<Node, UpdateStatement>)
          return &node.name;
        else
          return nullptr;
      },
      statement.what);
}

/// "3.25 mm", "0.5".
std::string with_unit(double value, const std::string& unit) {
  return readable("{:.6g}{}{}", value, unit.empty() ? "" : " ", unit);
}

}  // namespace

StatementChecker::StatementChecker(CheckedMaterial& material, ExpressionChecker& checker,
                                   const Surroundings& surroundings, std::string prefix)
    : material_(material), checker_(checker), surroundings_(surroundings), prefix_(std::move(prefix)) {
  scope_.hand = true;
}

void StatementChecker::check(const std::vector<AssembledStatement>& statements) {
  constexpr std::size_t operations_of_a_statement = 4;
  scope_.reserve(statements.size());
  const auto is_parameter = [](const AssembledStatement& each) {
    return std::holds_alternative<ParamStatement>(each.statement->what);
  };
  const auto parameters = static_cast<std::size_t>(std::ranges::count_if(statements, is_parameter));
  if (material_.parameters.empty()) material_.parameters.reserve(parameters);
  checker_.look_below([&](std::string_view name) -> std::optional<Span> {
    if (!statement_) return std::nullopt;
    for (const auto& each : std::span(statement_ + 1, statements.data() + statements.size()))
      if (const Word* declared = declared_word(*each.statement); declared && declared->text == name)
        return declared->span;
    return std::nullopt;
  });
  for (const auto& assembled : statements) {
    const Span& span = assembled.statement->span;
    if (!checker_.charge(operations_of_a_statement + operations_of_text(span), span)) break;
    statement_ = &assembled;
    checker_.read(*assembled.home);
    std::visit(*this, assembled.statement->what);
  }
  checker_.look_below({});
}

// ---- values -------------------------------------------------------------------------------------------------------

void StatementChecker::operator()(const LetStatement& node) {
  declare(node.name, checker_.check(tree(), node.value, scope_));
}

void StatementChecker::operator()(const HeightStatement& node) {
  Value value = checker_.check(tree(), node.value, scope_);
  if (value.failed()) return declare_failed(node.name);
  if (value.type != Value::Type::number) {
    report(Code::wrong_type, value.span,
           fmt::format("a height must be a number at each place, not {}", type_words(value.type)),
           value.type == Value::Type::field ? "take its value at a place: name it with `let`, then write `name(hand)`"
           : value.type == Value::Type::vector && value.dimension == declarations().dimension("force")
               ? fmt::format("a force is no height; write `force {} = …`", node.name.text)
               : "write it in terms of `x` and `y`, as in `grating(x, period: 2.5 mm)`");
    return declare_failed(node.name);
  }
  const Dimension length = declarations().dimension("length");
  if (!value.dimension.plain() && value.dimension != length) {
    const auto& names = declarations().names();
    const auto sides = names.side_by_side(length, value.dimension);
    surroundings_.diagnostics.report(
        {.code = Code::wrong_dimension,
         .span = value.span,
         .message = fmt::format("a height must be a length or a plain number, found {}", names.words(value.dimension)),
         .label = names.unit(value.dimension),
         .expected = sides[0],
         .found = sides[1],
         .help = fmt::format("`lateral` uses only its shape: make it a plain number, as in `/ 1 {}`",
                             customary_unit(declarations(), value.dimension)),
         .facts = {{"expected", names.words(length)}, {"found", names.words(value.dimension)}}});
    return declare_failed(node.name);
  }
  if (const auto dependence = material_.terms.dependence(value.x); dependence.changing()) {
    report(Code::wrong_rate, value.span,
           fmt::format("a height must depend on the place only, but this changes with {}", what_changes(dependence)),
           "use `x` and `y` only; multiply the force by whatever changes");
    return declare_failed(node.name);
  }
  last_height_ = value;
  declare(node.name, value);
}

void StatementChecker::operator()(const ForceStatement& node) {
  const Span span = statement_->statement->span;
  if (!node.name && whole_force_)
    report(Code::declared_twice, span, "a material can have only one `force = …`",
           Advice("add the terms up, or give each a name: `force texture = …`, `force drag = …`")
               .see(*whole_force_, "the first one"));
  if (!node.name && !whole_force_) whole_force_ = span;
  Value value = checker_.check_as(tree(), node.value, scope_, Value::Type::vector, declarations().dimension("force"));
  if (node.limit) {
    const auto ceiling = force_limit(*node.limit);
    if (ceiling && !value.failed()) value = held(material_.terms, value, *ceiling, tree().span(node.value));
  }
  if (!value.failed()) layers_.push_back({value, tree().span(node.value)});
  if (!node.name) return;
  declare(*node.name, value);
  if (auto* binding = scope_.find(node.name->text)) binding->used = true;
}

/// The limit of `limit 3 N`. Empty if it is not a force, or not constant from tick to tick, which is reported.
std::optional<TermId> StatementChecker::force_limit(ExprId expr) {
  const Value limit = checker_.check_as(tree(), expr, scope_, Value::Type::number, declarations().dimension("force"));
  if (limit.failed()) return std::nullopt;
  const Terms& terms = material_.terms;
  if (const auto dependence = terms.dependence(limit.x); dependence.in_tick()) {
    report(Code::wrong_rate, limit.span,
           fmt::format("a force's limit must be constant, but this changes with {}",
                       dependence.changing() ? what_changes(dependence) : "place"),
           "use numbers and parameters; for a changing limit, write `hold(force, ceiling)`");
    return std::nullopt;
  }
  // The range of a value is known only if the value is a parameter itself.
  const auto known = constant_value(terms, limit.x, &material_.parameters);
  const bool moves = terms[limit.x].kind == TermKind::parameter;
  if ((known && !(*known > 0)) || (moves && material_.parameters[terms[limit.x].index].low < 0)) {
    report(Code::value_out_of_range, limit.span, "a force's limit must be greater than zero",
           known && *known < 0 && !moves ? "it limits the force's size in every direction: leave out the `-`"
                                         : "write, for example, `limit 3 N`");
    return std::nullopt;
  }
  return limit.x;
}

/// What to write for a patch of one size, or of more than two, with the author's own.
std::string StatementChecker::two_sizes(const PatchStatement& node) const {
  const auto text = [&](ExprId size) { return surroundings_.sources.text(tree().span(size)); };
  if (node.sizes.size() > 2) return fmt::format("write `patch {}, {}`", text(node.sizes[0]), text(node.sizes[1]));
  const ExprId only = node.sizes.front();
  const auto* product = std::get_if<Binary>(&tree().expr(only));
  if (product && product->op == BinaryOperator::multiply)
    return fmt::format("write `patch {}, {}`", text(product->left), text(product->right));
  return fmt::format("write `patch {0}, {0}`", text(only));
}

void StatementChecker::operator()(const PatchStatement& node) {
  const Span span = statement_->statement->span;
  if (node.sizes.size() != 2)
    return report(Code::wrong_type, span, "a patch needs a width and a height", two_sizes(node));
  std::array<double, 2> sizes{};
  for (std::size_t side = 0; side < 2; ++side) {
    const auto size = checker_.constant(tree(), node.sizes[side], scope_, declarations().dimension("length"));
    if (!size) return;
    if (!(*size > 0))
      return report(Code::value_out_of_range, tree().span(node.sizes[side]),
                    "the sides of a patch must be greater than zero", "write, for example, `patch 95 mm, 95 mm`");
    sizes[side] = *size;
  }
  if (std::exchange(patch_seen_, true))
    return report(Code::declared_twice, span, "a material can have only one patch",
                  Advice("keep one of them").see(material_.patch_span, "the first one"));
  // A blend is as large as its largest component, unless it has a patch of its own.
  for (std::size_t side = 0; side < 2 && !prefix_.empty(); ++side)
    sizes[side] = material_.patch ? std::max(sizes[side], (*material_.patch)[side]) : sizes[side];
  material_.patch = sizes;
  material_.patch_span = span;
}

void StatementChecker::operator()(const ActiveStatement& node) {
  const Span span = statement_->statement->span;
  const auto power = checker_.constant(tree(), node.power, scope_, declarations().dimension("power"));
  if (!power) return;
  if (!(*power > 0 && *power <= most_active_watt))
    return report(Code::value_out_of_range, tree().span(node.power),
                  fmt::format("the active power must be greater than zero and at most {} W", most_active_watt),
                  "write, for example, `active 0.3 W`");
  if (std::exchange(active_seen_, true))
    return report(Code::declared_twice, span, "a material can have only one `active`",
                  Advice("keep one of them").see(material_.active_span, "the first one"));
  // The powers of a blend's components add up.
  material_.active_watt = prefix_.empty() ? *power : std::min(double{most_active_watt}, material_.active_watt + *power);
  material_.active_span = span;
}

void StatementChecker::operator()(const ShowStatement& node) {
  ShowChecker(material_, checker_, surroundings_, scope_).check(tree(), node.value);
}

// ---- parameters ---------------------------------------------------------------------------------------------------

void StatementChecker::operator()(const ParamStatement& node) {
  const Value value = checker_.check(tree(), node.value, scope_);
  if (value.failed() || lacks_its_unit(node, value) || disagrees_with_its_range(node, value))
    return declare_failed(node.name);
  if (value.type != Value::Type::number) {
    report(Code::wrong_type, value.span, fmt::format("a parameter must be a number, not {}", type_words(value.type)),
           "use one `param` for each part");
    return declare_failed(node.name);
  }
  const auto number = parameter_value(node, value);
  if (!number) return declare_failed(node.name);
  Parameter parameter{.name = std::string(node.name.text),
                      .description = std::string(node.description.empty() ? node.documentation : node.description)};
  parameter.value = static_cast<float>(*number);
  double low = *number, high = *number;
  const Span default_span = place_of_default(node);
  if (node.range && range_lacks_its_unit(node, *node.range, value.dimension)) return declare_failed(node.name);
  if (node.range) {
    const auto from = checker_.constant(tree(), node.range->low, scope_, value.dimension);
    const auto to = checker_.constant(tree(), node.range->high, scope_, value.dimension);
    if (!from || !to) return declare_failed(node.name);
    low = *from, high = *to;
    if (low > high)
      report(Code::value_out_of_range, tree().span(node.range->low), "the range runs from high to low",
             "swap its ends");
    else if (!(*number >= low && *number <= high)) {
      const Span range = {tree().source, tree().span(node.range->low).begin, tree().span(node.range->high).end};
      const auto [unit, size] = written_unit(node, value.dimension);
      const bool computed = statement_->value && statement_->value->made_at;
      report(Code::value_out_of_range, default_span,
             computed ? fmt::format("`{}` is {}, outside its range", node.name.text, with_unit(*number / size, unit))
             : statement_->value ? fmt::format("this is outside the range of `{}`", node.name.text)
                                 : fmt::format("the default of `{}` is outside its range", node.name.text),
             Advice(statement_->value ? fmt::format("its range is {}", surroundings_.sources.text(range))
                                      : "widen the range or change the default")
                 .see(range, "the range")
                 .fact("low", low / size, unit)
                 .fact("high", high / size, unit));
    }
  }
  warn_of_percent(node);
  parameter.low = static_cast<float>(low);
  parameter.high = static_cast<float>(high);
  std::tie(parameter.unit, parameter.unit_in_si) = written_unit(node, value.dimension);
  parameter.si_unit = declarations().names().unit(value.dimension);
  check_soft_range(node, value.dimension, *number, parameter);

  const auto is_taken = [&](const std::string& name) {
    return material_.parameter_names.contains(material_.parameters, name);
  };
  if (!prefix_.empty() && is_taken(parameter.name))
    parameter.name = material_.parameter_names.free(material_.parameters, prefix_ + "_" + parameter.name);
  const auto index = static_cast<std::uint32_t>(material_.parameters.size());
  declare(node.name, {.type = Value::Type::number,
                      .x = material_.terms.parameter(index, node.name.span),
                      .dimension = value.dimension,
                      .span = node.name.span});
  if (is_taken(parameter.name)) return;  // reported as declared twice
  material_.parameters.push_back(std::move(parameter));
  material_.parameter_spans.push_back(node.name.span);
}

/// A name that is still free. In a blend, a name that another component has taken gets the component's name as a
/// prefix.
std::string StatementChecker::free_name(const std::string& name,
                                        const std::function<bool(const std::string&)>& taken) const {
  if (prefix_.empty() || !taken(name)) return name;
  const std::string longer = prefix_ + "_" + name;
  std::string numbered = longer;
  for (int count = 2; taken(numbered); ++count) numbered = fmt::format("{}_{}", longer, count);
  return numbered;
}

/// The default: the parameter's own, or that of an instance or a mixture.
std::optional<double> StatementChecker::parameter_value(const ParamStatement& node, const Value& own_value) {
  if (!statement_->value) return checker_.constant(own_value);
  double sum = 0;
  constexpr std::size_t operations_of_a_part = 8;
  if (!checker_.charge(operations_of_a_part * statement_->value->parts.size(), node.name.span)) return std::nullopt;
  for (const auto& part : statement_->value->parts) {
    Scope outside;
    checker_.read(*part.home);
    const bool own = part.tree == statement_->tree && part.value == node.value;
    const auto value = checker_.constant(*part.tree, part.value, own ? scope_ : outside, own_value.dimension);
    if (!value) return std::nullopt;
    sum += part.weight * *value;
  }
  checker_.read(declarations());
  return sum;
}

/// The place of the default: the `between` that computed it, the argument that gave it, or the declaration.
Span StatementChecker::place_of_default(const ParamStatement& node) const {
  if (!statement_->value) return tree().span(node.value);
  const Mixture::Part& first = statement_->value->parts.front();
  return statement_->value->made_at.value_or(first.tree->span(first.value));
}

/// Sets the usual range, for sliders: the soft range, or the hard one if the author gives no soft one.
void StatementChecker::check_soft_range(const ParamStatement& node, const Dimension& dimension, double value,
                                        Parameter& parameter) {
  parameter.soft_low = parameter.low;
  parameter.soft_high = parameter.high;
  if (!node.soft_range || range_lacks_its_unit(node, *node.soft_range, dimension)) return;
  const auto from = checker_.constant(tree(), node.soft_range->low, scope_, dimension);
  const auto to = checker_.constant(tree(), node.soft_range->high, scope_, dimension);
  if (!from || !to) return;
  const Span span = {tree().source, tree().span(node.soft_range->low).begin, tree().span(node.soft_range->high).end};
  if (!(*from <= *to) || static_cast<float>(*from) < parameter.low || static_cast<float>(*to) > parameter.high)
    return report(Code::value_out_of_range, span,
                  *from <= *to ? "the soft range reaches beyond the hard one" : "the range runs from high to low",
                  *from <= *to ? "widen the range after `in`, or narrow this one" : "swap its ends");
  parameter.soft_low = static_cast<float>(*from);
  parameter.soft_high = static_cast<float>(*to);
  const auto as_float = static_cast<float>(value);
  const bool allowed = as_float >= parameter.low && as_float <= parameter.high;  // otherwise W0305 has been reported
  if (allowed && !(value >= *from && value <= *to)) {
    const auto [unit, size] = written_unit(node, dimension);
    report(Code::beyond_soft_range, place_of_default(node),
           fmt::format("`{}` is {}, outside its usual range", node.name.text, with_unit(value / size, unit)),
           Advice(fmt::format("the usual range is {}", surroundings_.sources.text(span)))
               .see(span, "the usual range")
               .fact("low", *from / size, unit)
               .fact("high", *to / size, unit));
  }
}

/// The unit that the author wrote for a parameter, and its factor to SI.
std::pair<std::string, double> StatementChecker::written_unit(const ParamStatement& node,
                                                              const Dimension& dimension) const {
  const Range range = node.range.value_or(Range{node.value, node.value});
  for (ExprId expr : {node.value, range.low, range.high}) {
    while (const auto* unary = std::get_if<Unary>(&tree().expr(expr))) expr = unary->operand;
    const auto* literal = std::get_if<NumberLiteral>(&tree().expr(expr));
    if (!literal || literal->suffix.count == 0) continue;
    double factor = 1;
    std::string text;
    bool known = true;
    for (const auto& part : tree().suffix(*literal)) {
      const Unit* found = declarations().units.find(part.name.text);
      if (!found) {
        known = false;
        break;
      }
      const int exponent = part.divides ? -part.exponent : part.exponent;
      factor *= exponent == 1 ? found->factor : std::pow(found->factor, exponent);
      text += text.empty() ? (part.divides ? "1/" : "") : part.divides ? "/" : " ";
      text += part.name.text;
      if (part.exponent != 1) text += fmt::format("^{}", part.exponent);
    }
    if (known) return {text, factor};
  }
  return {declarations().names().unit(dimension), 1.0};
}

// ---- names --------------------------------------------------------------------------------------------------------

void StatementChecker::declare(const Word& name, const Value& value) {
  if (name.text == "open")
    return report(Code::declared_twice, name.span, "`open` is reserved for quantities that the compiler solves",
                  "give it another name");
  if (names_hand_or_patch(name.text))
    return report(Code::declared_twice, name.span,
                  fmt::format("`{}` is already a name of the hand or the patch", name.text), "give it another name");
  if (const auto* other = scope_.find(name.text)) {
    const unsigned line = surroundings_.sources.place(other->declared).line;
    return report(Code::declared_twice, name.span, fmt::format("`{}` is declared already, on line {}", name.text, line),
                  Advice("give one of them another name").see(other->declared, "declared here first"));
  }
  if (const auto* hidden = declarations().constants.entry(name.text)) {
    const bool here = hidden->declared.source == name.span.source;
    report(Code::shadowed_name, name.span, fmt::format("`{}` hides the constant of the same name", name.text),
           Advice(fmt::format("give it another name; the constant is {}",
                              here ? fmt::format("on line {}", surroundings_.sources.place(hidden->declared).line)
                                   : fmt::format("in {}", surroundings_.sources[hidden->declared.source].name)))
               .see(hidden->declared, "the constant that it hides"));
  }
  scope_.declare(name.text, value, name.span);
}

/// Declares a name whose value has an error, so that its uses are not reported as unknown.
void StatementChecker::declare_failed(const Word& name) {
  declare(name, {});
  if (auto* binding = scope_.find(name.text)) binding->used = true;
}

void StatementChecker::warn_of_unused_names(Span own) const {
  std::vector<std::pair<std::string_view, Span>> unused;
  for (const auto& binding : scope_.bindings()) {
    const bool written_here =
        binding.declared.source == own.source && binding.declared.begin >= own.begin && binding.declared.end <= own.end;
    if (written_here && !binding.used && !binding.value.failed()) unused.emplace_back(binding.name, binding.declared);
  }
  std::ranges::sort(unused, {}, [](const auto& entry) { return entry.second.begin; });
  for (const auto& [name, span] : unused) {
    const bool parameter =
        std::ranges::find(material_.parameters, name, &Parameter::name) != material_.parameters.end();
    surroundings_.diagnostics.report(
        {.code = Code::unused_name,
         .span = span,
         .message = parameter
                        ? fmt::format("the parameter `{}` has no effect: no height and no force depends on it", name)
                        : fmt::format("`{}` is never used", name),
         .help = "use it or remove it"});
  }
}

void StatementChecker::report(Code code, Span span, std::string message, Advice advice) {
  surroundings_.diagnostics.report(std::move(advice).about(code, span, std::move(message)));
}

}  // namespace wale
