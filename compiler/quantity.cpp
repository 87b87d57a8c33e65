#include "compiler/quantity.hpp"

#include <fmt/format.h>

#include <cmath>

#include "compiler/expression/check_expression.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/parse/parse.hpp"

namespace wale {

QuantityReader::QuantityReader() : common_(common_modules()), names_(common_->declarations) {}

std::optional<std::vector<double>> QuantityReader::list(const std::string& option, const std::string& text,
                                                        const std::vector<Dimension>& dimensions, std::size_t needed,
                                                        const std::string& example) {
  const SourceId source = sources_.add(option, text);
  SyntaxTree tree;
  const auto expressions = parse_expressions(sources_, source, tree, diagnostics_);
  if (diagnostics_.has_errors()) return std::nullopt;
  const Span whole{source, 0, static_cast<std::uint32_t>(text.size())};
  if (expressions.size() != needed && expressions.size() != dimensions.size()) {
    diagnostics_.report(
        {.code = Code::missing_argument,
         .span = whole,
         .message =
             needed == dimensions.size()
                 ? fmt::format("{} value{} due here, not {}", needed, needed == 1 ? " is" : "s are", expressions.size())
                 : fmt::format("{} or {} values are due here, not {}", needed, dimensions.size(), expressions.size()),
         .help = fmt::format("write, for example, `{}`", example)});
    return std::nullopt;
  }
  Terms terms;
  std::vector<HeightTable> tables;
  ExpressionChecker checker({sources_, names_, diagnostics_}, terms, tables);
  Scope scope;
  std::vector<double> values;
  for (std::size_t i = 0; i < expressions.size(); ++i)
    if (const auto value = checker.constant(tree, expressions[i], scope, dimensions[i])) values.push_back(*value);
  if (diagnostics_.has_errors()) return std::nullopt;
  return values;
}

std::optional<Hand> QuantityReader::hand(const std::string& option, const std::string& text) {
  const Dimension length = names_.dimension("length"), velocity = names_.dimension("velocity");
  const auto values = list(option, text, {length, length, velocity, velocity}, 2, "10 mm, 5 mm");
  if (!values) return std::nullopt;
  Hand hand;
  hand.position = {static_cast<float>((*values)[0]), static_cast<float>((*values)[1])};
  if (values->size() == 4) hand.velocity = {static_cast<float>((*values)[2]), static_cast<float>((*values)[3])};
  return hand;
}

std::optional<double> QuantityReader::force(const std::string& option, const std::string& text) {
  const auto values = list(option, text, {names_.dimension("force")}, 1, "3 N");
  if (!values) return std::nullopt;
  if (values->front() > 0) return values->front();
  diagnostics_.report({.code = Code::value_out_of_range,
                       .span = {static_cast<SourceId>(sources_.size() - 1), 0, static_cast<std::uint32_t>(text.size())},
                       .message = "the largest force allowed is more than nothing",
                       .help = fmt::format("write, for example, `{} \"3 N\"`", option)});
  return std::nullopt;
}

std::optional<float> QuantityReader::parameter(const std::string& option, const Parameter& parameter,
                                               const std::string& text) {
  Dimension dimension;
  if (!parameter.si_unit.empty()) {
    const SourceId source = sources_.add("the unit of " + parameter.name, "1 " + parameter.si_unit);
    SyntaxTree tree;
    const auto expressions = parse_expressions(sources_, source, tree, diagnostics_);
    Terms terms;
    std::vector<HeightTable> tables;
    ExpressionChecker checker({sources_, names_, diagnostics_}, terms, tables);
    Scope scope;
    const Value unit = expressions.size() == 1 ? checker.check(tree, expressions[0], scope) : Value{};
    if (unit.failed()) return std::nullopt;
    dimension = unit.dimension;
  }
  // A unit that only the material's own file declares travels with the parameter.
  if (!names_.units.contains(parameter.unit))
    names_.units.add(parameter.unit, {.what = {parameter.unit_in_si, dimension}, .declared = {}});
  const std::string example =
      parameter.unit.empty() ? "0.5" : fmt::format("{:.4g} {}", parameter.value / parameter.unit_in_si, parameter.unit);
  const auto values = list(option, text, {dimension}, 1, example);
  if (!values) return std::nullopt;
  const float value = static_cast<float>(values->front());
  if (!(value >= parameter.low && value <= parameter.high)) {
    const std::string unit = parameter.unit.empty() ? "" : " " + parameter.unit;
    diagnostics_.report(
        {.code = Code::value_out_of_range,
         .span = {static_cast<SourceId>(sources_.size() - 1), 0, static_cast<std::uint32_t>(text.size())},
         .message = fmt::format("`{}` is out of its range", parameter.name),
         .help = fmt::format("give a value from {:.6g}{} to {:.6g}{}", parameter.low / parameter.unit_in_si, unit,
                             parameter.high / parameter.unit_in_si, unit)});
    return std::nullopt;
  }
  if (value < parameter.soft_low || value > parameter.soft_high) {
    const std::string unit = parameter.unit.empty() ? "" : " " + parameter.unit;
    diagnostics_.report(
        {.code = Code::beyond_soft_range,
         .span = {static_cast<SourceId>(sources_.size() - 1), 0, static_cast<std::uint32_t>(text.size())},
         .message = fmt::format("`{}` is outside its usual range here", parameter.name),
         .help = fmt::format("usual are values from {:.6g}{} to {:.6g}{}", parameter.soft_low / parameter.unit_in_si,
                             unit, parameter.soft_high / parameter.unit_in_si, unit)});
  }
  return value;
}

}  // namespace wale
