#include "compiler/expression/plain_number_mend.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "compiler/diagnostics/fix.hpp"
#include "compiler/expression/check_expression.hpp"
#include "compiler/text/characters.hpp"

namespace wale {
namespace {

/// A factor of a product.
struct Factor {
  ExprId expr;
  bool divides;
};

void collect_factors(const SyntaxTree& tree, ExprId expr, bool divides, std::vector<Factor>& factors) {
  const auto* binary = std::get_if<Binary>(&tree.expr(expr));
  if (!binary || (binary->op != BinaryOperator::multiply && binary->op != BinaryOperator::divide))
    return factors.push_back({expr, divides});
  collect_factors(tree, binary->left, divides, factors);
  collect_factors(tree, binary->right, divides != (binary->op == BinaryOperator::divide), factors);
}

/// The dimension of a number with its unit, or of a name that is declared; nothing of others.
std::optional<Dimension> dimension_of_factor(const ExpressionReading& reading, const SyntaxTree& tree, ExprId expr,
                                             const Scope& scope) {
  if (const auto* name = std::get_if<NameUse>(&tree.expr(expr))) {
    const auto* binding = scope.find(name->name);
    return binding ? std::optional(binding->value.dimension) : std::nullopt;
  }
  const auto* literal = std::get_if<NumberLiteral>(&tree.expr(expr));
  if (!literal) return std::nullopt;
  Dimension whole;
  for (const SuffixFactor& part : tree.suffix(*literal)) {
    const Unit* unit = reading.names->units.find(part.name.text);
    if (!unit || part.exponent != 1) return std::nullopt;
    whole = part.divides ? whole / unit->dimension : whole * unit->dimension;
  }
  return whole;
}

/// Whether a number stands there without a unit, perhaps behind a minus.
bool is_bare_number(const SyntaxTree& tree, ExprId expr) {
  while (const auto* unary = std::get_if<Unary>(&tree.expr(expr))) expr = unary->operand;
  const auto* literal = std::get_if<NumberLiteral>(&tree.expr(expr));
  return literal && literal->suffix.count == 0;
}

}  // namespace

std::optional<Advice> quotient_mend(const ExpressionReading& reading, const SyntaxTree& tree, ExprId expr,
                                    const Scope& scope, const Dimension& found) {
  std::vector<Factor> factors;
  collect_factors(tree, expr, false, factors);
  const SourceSet& sources = reading.surroundings.sources;
  for (auto divisor = factors.rbegin(); divisor != factors.rend(); ++divisor) {
    if (divisor->divides) continue;
    const auto own = dimension_of_factor(reading, tree, divisor->expr, scope);
    if (!own || own->plain() || *own * *own != found) continue;
    for (auto other = factors.rbegin(); other != factors.rend(); ++other) {
      if (other == divisor || other->divides || std::holds_alternative<NumberLiteral>(tree.expr(other->expr))) continue;
      if (const auto its = dimension_of_factor(reading, tree, other->expr, scope); its && *its != *own) continue;
      const std::string_view left = sources.text(tree.span(other->expr)),
                             right = sources.text(tree.span(divisor->expr));
      Advice advice(fmt::format("divide by `{1}`: write `{0} / {1}`", as_factor(left), right));
      const Span before = tree.span(other->expr), behind = tree.span(divisor->expr);
      if (before.end >= behind.begin) return advice;
      const Span between = {before.source, before.end, behind.begin};
      const std::string_view sign = sources.text(between);
      if (sign.find_first_not_of(" *") != std::string_view::npos) return advice;
      return std::move(advice).fix(replace(between, " / ", fmt::format("divide by `{}`", right), false));
    }
  }
  return std::nullopt;
}

std::optional<Diagnostic> plain_beside_measured(const ExpressionReading& reading, const CallArguments& arguments) {
  const SyntaxTree& tree = arguments.tree;
  const SourceSet& sources = reading.surroundings.sources;
  const Actual* measured = nullptr;
  std::vector<ExprId> plain;
  for (std::size_t i = 0; i < arguments.actuals.size(); ++i) {
    const Actual& actual = arguments.actuals[i];
    if (!actual.given || arguments.dimensions[i] || actual.value.type != Value::Type::number) continue;
    if (!actual.value.dimension.plain()) {
      if (measured && measured->value.dimension != actual.value.dimension) return std::nullopt;
      if (!measured) measured = &actual;
      continue;
    }
    for (const Argument& argument : tree.arguments(arguments.call))
      if (tree.span(argument.value) == actual.span && is_bare_number(tree, argument.value))
        plain.push_back(argument.value);
  }
  if (!measured || plain.empty()) return std::nullopt;
  const DimensionNames& names = reading.dimension_names();
  const std::string unit = customary_unit(*reading.names, measured->value.dimension);
  std::vector<std::string> meant;
  for (const ExprId each : plain) meant.push_back(fmt::format("`{} {}`", sources.text(tree.span(each)), unit));
  const std::string words = names.words(measured->value.dimension);
  Diagnostic diagnostic =
      Advice(fmt::format("a plain number needs its unit: write {}", fmt::join(meant, " and ")))
          .see(measured->span, with_article(words))
          .fact("expected", words)
          .fact("found", names.words({}))
          .about(Code::wrong_dimension, tree.span(plain.front()),
                 fmt::format("`{}` is a plain number, and `{}` is {}", sources.text(tree.span(plain.front())),
                             sources.text(measured->span), with_article(words)));
  if (!unit.empty() && begins_name(unit.front())) {
    Fix fix{.title = fmt::format("write {}", fmt::join(meant, " and "))};
    for (const ExprId each : plain) {
      const Span span = tree.span(each);
      fix.edits.push_back({{span.source, span.end, span.end}, " " + unit});
    }
    diagnostic.fixes = {std::move(fix)};
  }
  return diagnostic;
}

std::string as_factor(std::string_view text) {
  int depth = 0;
  for (std::size_t i = 1; i < text.size(); ++i) {
    depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
    if (depth == 0 && (text[i] == '+' || text[i] == '-')) return fmt::format("({})", text);
  }
  return std::string(text);
}

}  // namespace wale
