#include "compiler/expression/units_in_parentheses.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/expression/check_expression.hpp"
#include "compiler/expression/check_name.hpp"

namespace wale {
namespace {

/// A unit in a product, and its power; below 0 it divides.
struct UnitPower {
  std::string_view name;
  int power;
};

/// Collects the units of a product, a quotient or a power of units alone. Whether it is one.
bool collect_units(const ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, int power, const Scope& scope,
                   std::vector<UnitPower>& units) {
  const Expr& node = tree.expr(expr);
  if (const auto* name = std::get_if<NameUse>(&node)) {
    if (!reading.names->units.contains(name->name) || reading.names->constants.contains(name->name) ||
        scope.find(name->name) != nullptr)
      return false;
    units.push_back({name->name, power});
    return true;
  }
  const auto* binary = std::get_if<Binary>(&node);
  if (binary == nullptr) return false;
  if (binary->op == BinaryOperator::power) {
    const auto* exponent = std::get_if<NumberLiteral>(&tree.expr(binary->right));
    constexpr int largest = 9;
    const bool is_small = exponent && exponent->suffix.count == 0 && exponent->value == std::floor(exponent->value) &&
                          exponent->value <= largest;
    return is_small &&
           collect_units(reading, tree, binary->left, power * static_cast<int>(exponent->value), scope, units);
  }
  if (binary->op != BinaryOperator::multiply && binary->op != BinaryOperator::divide) return false;
  const int of_right = binary->op == BinaryOperator::divide ? -power : power;
  return collect_units(reading, tree, binary->left, power, scope, units) &&
         collect_units(reading, tree, binary->right, of_right, scope, units);
}

/// The number that stands there, perhaps behind a sign; null if there is none.
const NumberLiteral* number_at(const SyntaxTree& tree, ExprId expr) {
  while (const auto* unary = std::get_if<Unary>(&tree.expr(expr))) expr = unary->operand;
  return std::get_if<NumberLiteral>(&tree.expr(expr));
}

/// "N s/m": first what multiplies.
std::string text_of(const std::vector<UnitPower>& units) {
  std::string text;
  const auto power = [](int size) { return size == 1 ? std::string() : fmt::format("^{}", size); };
  for (const UnitPower& unit : units)
    if (unit.power > 0) text += fmt::format("{}{}{}", text.empty() ? "" : " ", unit.name, power(unit.power));
  for (const UnitPower& unit : units)
    if (unit.power < 0) text += fmt::format("{}/{}{}", text.empty() ? "1" : "", unit.name, power(-unit.power));
  return text;
}

}  // namespace

bool begins_with_unit(const ExpressionReading& reading, const SyntaxTree& tree, const Binary& node) {
  if (node.op != BinaryOperator::multiply && node.op != BinaryOperator::divide) return false;
  if (!number_at(tree, node.left)) return false;
  ExprId first = node.right;
  while (const auto* binary = std::get_if<Binary>(&tree.expr(first))) first = binary->left;
  const auto* name = std::get_if<NameUse>(&tree.expr(first));
  return first != node.right && name && reading.names->units.contains(name->name);
}

std::optional<Value> report_units_in_parentheses(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr,
                                                 const Binary& node, const Scope& scope) {
  const NumberLiteral* literal = number_at(tree, node.left);
  if (literal == nullptr) return std::nullopt;
  std::vector<UnitPower> units;
  for (const SuffixFactor& part : tree.suffix(*literal))
    units.push_back({part.name.text, part.divides ? -part.exponent : part.exponent});
  if (!collect_units(reading, tree, node.right, node.op == BinaryOperator::divide ? -1 : 1, scope, units))
    return std::nullopt;
  const Span span = tree.span(expr), left = tree.span(node.left);
  std::string_view number = reading.surroundings.sources.text(left);
  if (literal->suffix.count > 0) number = number.substr(0, tree.suffix(*literal).front().name.span.begin - left.begin);
  while (!number.empty() && (number.back() == ' ' || number.back() == '/')) number.remove_suffix(1);
  const std::string meant = fmt::format("{} {}", number, text_of(units));
  return reading.calls.report(
      Code::unknown_name, span,
      fmt::format("the units of a number have no parentheses, as in `{}`", reading.surroundings.sources.text(span)), "",
      Advice(fmt::format("write `{}`", meant)));
}

}  // namespace wale
