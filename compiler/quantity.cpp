#include "compiler/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "compiler/expression/check_expression.hpp"
#include "compiler/parse/parse.hpp"
#include "compiler/text/characters.hpp"
#include "compiler/text/readable.hpp"
#include "compiler/typed_number.hpp"

namespace wale {
namespace {

/// The value that an option expects, in the words of its errors.
struct Expected {
  std::string what;     ///< "a force"
  std::string example;  ///< `--max-force "3 N"`
};

Error unexpected(Code code, const std::string& option, const std::string& text, const Expected& expected,
                 const std::string& because = {}, const std::string& mend = {}) {
  return {.code = code,
          .sentence = fmt::format("expected {}, {}{}{}", expected.what, found_typed(text), because.empty() ? "" : ": ",
                                  because),
          .mend = fmt::format("for example, `{}`{}{}", expected.example, mend.empty() ? "" : "; ", mend),
          .place = {.name = option, .text = text}};
}

/// The first error in a text. Messages about names and characters are for files, and are left out here.
Error unexpected(const Diagnostics& diagnostics, const std::string& option, const std::string& text,
                 const Expected& expected) {
  const Diagnostic& first = diagnostics.all().front();
  const bool is_of_quantities = first.code == Code::wrong_dimension || first.code == Code::mismatched_dimensions ||
                                first.code == Code::unknown_unit || first.code == Code::number_out_of_range;
  return is_of_quantities ? unexpected(first.code, option, text, expected, first.message, first.help)
                          : unexpected(Code::malformed_value, option, text, expected);
}

/// Reads quantities separated by commas: one for each dimension, or only the first `needed`.
Result<std::vector<double>> read_list(const Declarations& known, const std::string& option, const std::string& text,
                                      const std::vector<Dimension>& dimensions, std::size_t needed,
                                      const Expected& expected) {
  if (text.find_first_not_of(" \t") == std::string::npos)
    return unexpected(Code::malformed_value, option, text, expected);
  SourceSet sources;
  Diagnostics diagnostics;
  SyntaxTree tree;
  const auto expressions = parse_expressions(sources, sources.add(option, text), tree, diagnostics);
  if (diagnostics.has_errors()) return unexpected(diagnostics, option, text, expected);
  if (expressions.size() != needed && expressions.size() != dimensions.size())
    return unexpected(
        Code::missing_argument, option, text, expected,
        expressions.size() == 1 ? "this is 1 value" : fmt::format("these are {} values", expressions.size()));
  Terms terms;
  std::vector<HeightTable> tables;
  ExpressionChecker checker({sources, known, diagnostics}, terms, tables);
  Scope scope;
  std::vector<double> values;
  for (std::size_t i = 0; i < expressions.size(); ++i)
    if (const auto value = checker.constant(tree, expressions[i], scope, dimensions[i])) values.push_back(*value);
  if (diagnostics.has_errors()) return unexpected(diagnostics, option, text, expected);
  return values;
}

/// One quantity above 0.
Result<double> read_above_0(const Declarations& known, const std::string& option, const std::string& text,
                            const char* dimension, const Expected& expected) {
  const auto values = read_list(known, option, text, {known.dimension(dimension)}, 1, expected);
  if (!values) return values.error();
  if (values->front() > 0) return values->front();
  return unexpected(Code::value_out_of_range, option, text, expected);
}

/// The dimension of a parameter; empty if its SI unit is not a unit of the language.
std::optional<Dimension> dimension_of(const Declarations& known, const Parameter& parameter) {
  if (parameter.si_unit.empty()) return Dimension{};
  SourceSet sources;
  Diagnostics diagnostics;
  SyntaxTree tree;
  const auto expressions =
      parse_expressions(sources, sources.add("a unit", "1 " + parameter.si_unit), tree, diagnostics);
  Terms terms;
  std::vector<HeightTable> tables;
  ExpressionChecker checker({sources, known, diagnostics}, terms, tables);
  Scope scope;
  const Value unit = expressions.size() == 1 ? checker.check(tree, expressions[0], scope) : Value{};
  return unit.failed() ? std::nullopt : std::optional(unit.dimension);
}

/// "from 1 mm to 5 mm": bounds in SI as text in the parameter's own unit.
std::string range_text(const Parameter& parameter, double low, double high) {
  const std::string unit = parameter.unit.empty() ? "" : " " + parameter.unit;
  return readable("from {:.6g}{} to {:.6g}{}", low / parameter.unit_in_si, unit, high / parameter.unit_in_si, unit);
}

/// The values of a parameter, and the option with its default.
Expected expected_of(const std::string& option, const Parameter& parameter) {
  const std::string unit = parameter.unit.empty() ? "" : " " + parameter.unit;
  return {"a value " + range_text(parameter, parameter.low, parameter.high),
          typeable("{} \"{}={:.4g}{}\"", option, parameter.name, parameter.value / parameter.unit_in_si, unit)};
}

}  // namespace

Result<Hand> read_hand(const Declarations& known, const std::string& option, const std::string& text) {
  const Dimension length = known.dimension("length"), velocity = known.dimension("velocity");
  const auto values =
      read_list(known, option, text, {length, length, velocity, velocity}, 2,
                {"a position of x and y, with or without a velocity of x and y", option + " \"10 mm, 5 mm\""});
  if (!values) return values.error();
  Hand hand;
  hand.position = {static_cast<float>((*values)[0]), static_cast<float>((*values)[1])};
  if (values->size() == 4) hand.velocity = {static_cast<float>((*values)[2]), static_cast<float>((*values)[3])};
  return hand;
}

Result<double> read_force(const Declarations& known, const std::string& option, const std::string& text) {
  return read_above_0(known, option, text, "force", {"a force above 0 N", option + " \"3 N\""});
}

Result<double> read_length(const Declarations& known, const std::string& option, const std::string& text) {
  return read_above_0(known, option, text, "length", {"a length above 0 mm", option + " \"40 mm\""});
}

Result<HeightsBetween> read_heights_between(const Declarations& known, const std::string& option, const std::string& text) {
  const Expected expected{"two heights, the smaller one first", option + " \"0 mm, 1 mm\", or " + option + " \"0, 1\""};
  const Dimension length = known.dimension("length");
  const auto lengths = read_list(known, option, text, {length, length}, 2, expected);
  const auto plain = lengths ? lengths : read_list(known, option, text, {Dimension{}, Dimension{}}, 2, expected);
  if (!plain) return lengths.error();
  if ((*plain)[0] < (*plain)[1]) return HeightsBetween{(*plain)[0], (*plain)[1], lengths.has_value()};
  return unexpected(Code::value_out_of_range, option, text, expected);
}

Result<double> read_parameter_anyway(const Declarations& known, const std::string& option, const Parameter& parameter,
                                     const std::string& text) {
  const std::string where = option + " " + parameter.name;
  const auto dimension = dimension_of(known, parameter);
  if (!dimension)
    return Error{.code = Code::unknown_unit,
                 .sentence = fmt::format("nothing declares the unit `{}` of `{}`", parameter.si_unit, parameter.name),
                 .place = {.name = where, .text = text}};
  // The parameter's own unit may be declared only in the material's file, so it is added here.
  Declarations names(known);
  if (!names.units.contains(parameter.unit))
    names.units.add(parameter.unit, {.what = {parameter.unit_in_si, *dimension}, .declared = {}});
  const auto values = read_list(names, where, text, {*dimension}, 1, expected_of(option, parameter));
  if (values) return values->front();
  Error error = values.error();
  if (const auto plain = read_number(option, text, {}); plain && !parameter.unit.empty() && error.mend.find(parameter.unit) == std::string::npos)
    error.mend = typeable("give its unit: {} \"{}={:.6g} {}\"", option, parameter.name, *plain, parameter.unit);
  const bool is_word = std::ranges::all_of(text, [](char c) { return continues_name(c); }) && !text.empty();
  if (is_word && begins_name(text.front()) && known.percept_named(parameter.name).percept)
    error.mend += "; names of levels work in a file only, as in `" + parameter.name + " " + text + "`";
  return error;
}

Result<ParameterValue> read_parameter(const Declarations& known, const std::string& option, const Parameter& parameter,
                                      const std::string& text) {
  const std::string where = option + " " + parameter.name;
  const auto value = read_parameter_anyway(known, option, parameter, text);
  if (!value) return value.error();
  ParameterValue read{.value = static_cast<float>(*value), .unusual = {}};
  if (!(read.value >= parameter.low && read.value <= parameter.high))
    return unexpected(Code::value_out_of_range, where, text, expected_of(option, parameter));
  if (read.value < parameter.soft_low || read.value > parameter.soft_high)
    read.unusual = Error{.code = Code::beyond_soft_range,
                         .sentence = fmt::format("`{}` is outside its usual range here", parameter.name),
                         .mend = "usual values are " + range_text(parameter, parameter.soft_low, parameter.soft_high),
                         .place = {.name = where, .text = text}};
  return read;
}

}  // namespace wale
