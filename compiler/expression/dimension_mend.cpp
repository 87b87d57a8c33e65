#include "compiler/expression/dimension_mend.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "compiler/declarations/unit_names.hpp"
#include "compiler/diagnostics/fix.hpp"
#include "compiler/expression/check_expression.hpp"
#include "compiler/expression/check_name.hpp"
#include "compiler/expression/plain_number_mend.hpp"
#include "compiler/text/characters.hpp"
#include "compiler/text/readable.hpp"

namespace wale {

namespace {

/// One name in a product, and whether it divides.
struct ProductName {
  std::string name;
  Span span;
  bool divides;
};

/// Collects the names in a chain of products and quotients; other factors are skipped.
void collect_names(const SyntaxTree& tree, ExprId expr, bool divides, std::vector<ProductName>& names) {
  const Expr& node = tree.expr(expr);
  if (const auto* use = std::get_if<NameUse>(&node))
    names.push_back({std::string(use->name), tree.span(expr), divides});
  if (const auto* unary = std::get_if<Unary>(&node)) collect_names(tree, unary->operand, divides, names);
  if (const auto* binary = std::get_if<Binary>(&node)) {
    if (binary->op == BinaryOperator::multiply || binary->op == BinaryOperator::divide) {
      collect_names(tree, binary->left, divides, names);
      collect_names(tree, binary->right, divides != (binary->op == BinaryOperator::divide), names);
    }
  }
}

/// Whether it is a single base dimension to the power 1.
bool base(const Dimension& dimension) {
  int sum = 0;
  for (const int exponent : dimension.twelfths) {
    if (exponent < 0) return false;
    sum += exponent;
  }
  return sum == Dimension::unit_exponent;
}

/// The expression without its leading signs.
ExprId bare(const SyntaxTree& tree, ExprId expr) {
  while (const auto* unary = std::get_if<Unary>(&tree.expr(expr))) expr = unary->operand;
  return expr;
}

/// "one length too many", "one mass too few"; empty if no declared name fits the ratio.
std::string surplus(const DimensionNames& names, const Dimension& ratio) {
  // "One time too few" is clearer than "one frequency too many".
  if (const auto name = names.name(Dimension{} / ratio); name && base(Dimension{} / ratio))
    return fmt::format("one {} too few", *name);
  if (const auto name = names.name(ratio)) return fmt::format("one {} too many", *name);
  if (const auto name = names.name(Dimension{} / ratio)) return fmt::format("one {} too few", *name);
  return {};
}

/// A name that would fit if it were declared with another unit.
struct Culprit {
  std::string name;
  const Scope::Binding* binding = nullptr;
  Dimension needed;
};

/// The formula of the `let` of a material that is declared there.
const ExprId* formula_of(const SyntaxTree& tree, const Span& declared) {
  for (const auto& declaration : tree.declarations) {
    const auto* material = std::get_if<MaterialDecl>(&declaration);
    if (!material || declared.source != tree.source) continue;
    for (const PhysicalStatement& statement : material->physical)
      if (const auto* let = std::get_if<LetStatement>(&statement.what); let && let->name.span.begin == declared.begin)
        return &let->value;
  }
  return nullptr;
}

/// The factor of a product that would fit if its dimension were smaller by `ratio`. If it is a `let` whose formula has
/// such a factor, that one.
std::optional<Culprit> culprit_of(const DimensionNames& names, const SyntaxTree& tree,
                                  const std::vector<ProductName>& factors, const Scope& scope, const Dimension& ratio) {
  for (const ProductName& factor : factors) {
    const auto* binding = scope.find(factor.name);
    if (!binding) continue;
    const Dimension own = factor.divides ? Dimension{} / ratio : ratio, needed = binding->value.dimension / own;
    if (!names.name(needed) || needed.plain()) continue;
    if (const ExprId* formula = formula_of(tree, binding->declared)) {
      std::vector<ProductName> inside;
      collect_names(tree, *formula, false, inside);
      // A name is known only below its declaration, so this ends.
      std::erase_if(inside, [&](const ProductName& each) {
        const auto* other = scope.find(each.name);
        return !other || other->declared.begin >= binding->declared.begin;
      });
      if (auto deeper = culprit_of(names, tree, inside, scope, own)) return deeper;
    }
    return Culprit{factor.name, binding, needed};
  }
  return std::nullopt;
}

/// Advice on the factor that makes the dimension wrong by `ratio`, or on one to multiply or divide by.
Advice factor_mend(const ExpressionReading& reading, const SyntaxTree& tree, const std::vector<ProductName>& factors,
                   const Scope& scope, const Dimension& expected, const Dimension& ratio) {
  const DimensionNames& names = reading.dimension_names();
  const SourceSet& sources = reading.surroundings.sources;
  const Declarations& own = reading.surroundings.declarations;
  const std::string count = surplus(names, ratio);
  // In a product of three factors or more, a factor that equals the surplus is the most likely error; next comes a name
  // that would fit if it were declared with another unit.
  for (const auto& factor : factors) {
    const auto* binding = scope.find(factor.name);
    if (!binding || factor.divides || factors.size() < 3 || binding->value.dimension != ratio) continue;
    const unsigned line = sources.place(binding->declared).line;
    const std::string what = with_article(names.words(ratio));
    return Advice(fmt::format("{}{}divide by {}, or drop `* {}` ({}, line {})", count, count.empty() ? "" : "; ", what,
                              factor.name, what, line))
        .see(binding->declared, what);
  }
  if (const auto culprit = culprit_of(names, tree, factors, scope, ratio)) {
    const Dimension& is = culprit->binding->value.dimension;
    const Span& declared = culprit->binding->declared;
    return Advice(fmt::format("{}{}if `{}` (line {}) is meant as {}, give it in {}", count, count.empty() ? "" : ": ",
                              culprit->name, sources.place(declared).line, with_article(*names.name(culprit->needed)),
                              customary_unit(own, culprit->needed)))
        .see(declared, is.plain() ? names.words(is) : with_article(names.words(is)))
        .fact("meant", names.words(culprit->needed))
        .fact("declared", declared);
  }
  const auto inverse = names.name(Dimension{} / ratio);
  if (const auto name = names.name(ratio); name && !(inverse && base(Dimension{} / ratio)))
    return fmt::format("{}; divide by {}", count, with_article(*name));
  if (inverse) return fmt::format("{}; multiply by {}", count, with_article(*inverse));
  return fmt::format("write {}, in {}", with_article(names.words(expected)), customary_unit(own, expected));
}

/// `1/8 inch` is 1 / (8 inch): one eighth of an inch was meant where that has the dimension `expected`.
std::optional<Advice> fraction_mend(const ExpressionReading& reading, const SyntaxTree& tree, ExprId expr,
                                    const Dimension& expected, const Dimension& found) {
  const auto* quotient = std::get_if<Binary>(&tree.expr(expr));
  if (!quotient || quotient->op != BinaryOperator::divide || Dimension{} / found != expected) return std::nullopt;
  const auto* over = std::get_if<NumberLiteral>(&tree.expr(quotient->left));
  const auto* under = std::get_if<NumberLiteral>(&tree.expr(quotient->right));
  if (!over || !under || over->suffix.count > 0 || under->suffix.count == 0 || under->value == 0) return std::nullopt;
  const auto suffix = tree.suffix(*under);
  const Span unit = {tree.source, suffix.front().name.span.begin, tree.span(quotient->right).end};
  const SourceSet& sources = reading.surroundings.sources;
  const std::string meant = typeable("{:.6g} {}", over->value / under->value, sources.text(unit));
  return Advice(typeable("the unit belongs to the `{:.6g}` alone: write `{}`", under->value, meant))
      .fix(replace(tree.span(expr), meant, {}, false));
}

/// A period where a frequency was expected, or the reverse: the value that the number stands for.
std::optional<Advice> inverse_mend(const ExpressionReading& reading, const SyntaxTree& tree, ExprId expr,
                                   const Dimension& expected, const Dimension& found) {
  if (Dimension{} / found != expected) return std::nullopt;
  const Declarations& declarations = reading.surroundings.declarations;
  const auto* literal = std::get_if<NumberLiteral>(&tree.expr(expr));
  if (!literal || literal->value == 0) return std::nullopt;
  double size = literal->value;
  for (const SuffixFactor& part : tree.suffix(*literal)) {
    const Unit* unit = declarations.units.find(part.name.text);
    if (!unit) return std::nullopt;
    size *= std::pow(unit->factor, part.divides ? -part.exponent : part.exponent);
  }
  const std::string unit = customary_unit(declarations, expected);
  const Unit* written = declarations.units.find(unit);
  if (!written) return std::nullopt;
  const DimensionNames& names = reading.dimension_names();
  const std::string meant = typeable("{:.6g} {}", 1 / size / written->factor, unit);
  return Advice(fmt::format("{} of {} is {} of {}: write `{}`", with_article(names.words(found)),
                            reading.surroundings.sources.text(tree.span(expr)), with_article(names.words(expected)),
                            meant, meant))
      .fix(replace(tree.span(expr), meant, {}, false));
}

/// The dimensions of a mass and of a force, which are mistaken for each other: "200 g weigh 1.96 N".
std::optional<Advice> weight_mend(const ExpressionReading& reading, const SyntaxTree& tree, ExprId expr,
                                  const Dimension& expected, const Dimension& found) {
  const Declarations& declarations = reading.surroundings.declarations;
  if (found != declarations.dimension("mass") || expected != declarations.dimension("force")) return std::nullopt;
  constexpr double standard_gravity = 9.80665;  // m/s^2
  const auto* literal = std::get_if<NumberLiteral>(&tree.expr(expr));
  double mass = literal ? literal->value : 0;
  if (literal)
    for (const SuffixFactor& part : tree.suffix(*literal)) {
      const Unit* unit = declarations.units.find(part.name.text);
      if (!unit) return std::nullopt;
      mass *= std::pow(unit->factor, part.divides ? -part.exponent : part.exponent);
    }
  if (!(mass > 0)) return Advice(readable("a mass is no force: 1 kg weighs {:.3g} N", standard_gravity));
  const std::string meant = typeable("{:.3g} N", mass * standard_gravity);
  return Advice(fmt::format("a mass is no force: for the weight of {} write `{}`",
                            reading.surroundings.sources.text(tree.span(expr)), meant))
      .fix(replace(tree.span(expr), meant, {}, false));
}

/// `Ns` and `Nmm`: two units without the space between them; and `N.s`, with points for it.
std::optional<std::string> parted_units(std::string_view word, const Declarations& declarations) {
  if (word.find('.') != std::string_view::npos) {
    std::string units;
    for (std::size_t begin = 0; begin <= word.size();) {
      const std::size_t end = std::min(word.find('.', begin), word.size());
      const std::string_view unit = word.substr(begin, end - begin);
      if (!declarations.units.contains(unit)) return std::nullopt;
      units += fmt::format("{}{}", units.empty() ? "" : " ", unit);
      begin = end + 1;
    }
    return units;
  }
  for (std::size_t cut = 1; cut < word.size(); ++cut)
    if (declarations.units.contains(word.substr(0, cut)) && declarations.units.contains(word.substr(cut)))
      return fmt::format("{} {}", word.substr(0, cut), word.substr(cut));
  return std::nullopt;
}

/// `mW`: a prefix that the declared unit behind it is not used with.
std::optional<Advice> prefix_mend(std::string_view word, const Declarations& declarations) {
  struct Prefix {
    std::string_view symbol;
    double factor;
  };
  constexpr Prefix prefixes[] = {{"m", 1e-3}, {"k", 1e3}, {"u", 1e-6}, {"M", 1e6}, {"c", 1e-2}, {"n", 1e-9}};
  for (const Prefix& prefix : prefixes) {
    if (!word.starts_with(prefix.symbol) || word.size() == prefix.symbol.size()) continue;
    const std::string_view unit = word.substr(prefix.symbol.size());
    if (!declarations.units.contains(unit)) continue;
    return Advice(readable("write it in `{0}`: 1 {1} is {2:g} {0}", unit, word, prefix.factor));
  }
  return std::nullopt;
}

/// A unit that Wale does not declare, in one that it does.
struct ForeignUnit {
  std::string_view name;
  double size;
  std::string_view ours;
};
constexpr ForeignUnit foreign_units[] = {
    {"rpm", 1 / 60.0, "Hz"}, {"bpm", 1 / 60.0, "Hz"}, {"min", 60, "s"},      {"minute", 60, "s"},
    {"ft", 304.8, "mm"},     {"foot", 304.8, "mm"},   {"mil", 0.0254, "mm"}, {"pt", 0.352778, "mm"},
    {"lb", 453.592, "g"},    {"lbf", 4.44822, "N"},   {"oz", 28.3495, "g"},  {"kgf", 9.80665, "N"},
    {"kp", 9.80665, "N"},    {"dyn", 1e-5, "N"},      {"nm", 1e-6, "mm"},    {"turn", 360, "deg"},
    {"turns", 360, "deg"},   {"rev", 360, "deg"},     {"fps", 1, "Hz"},      {"psi", 6894.76, "Pa"}};

/// `3000 rpm`, and `0.5f` or `1e N`, whose letter belongs to the number.
std::optional<Advice> foreign_mend(const Word& word, const Declarations& declarations,
                                   const Surroundings& surroundings) {
  const std::string_view text = surroundings.sources[word.span.source].text;
  const bool touches =
      word.span.begin > 0 &&
      (std::isdigit(static_cast<unsigned char>(text[word.span.begin - 1])) != 0 || text[word.span.begin - 1] == '.');
  if (touches && (word.text == "e" || word.text == "E"))
    return Advice("an exponent has digits, as in `1e3`; without one leave out the `e`");
  if (touches && word.text.size() == 1 && std::string_view("fFlLdDuU").find(word.text) != std::string_view::npos)
    return Advice(fmt::format("numbers have no suffix: leave out the `{}`", word.text))
        .fix(replace(word.span, "", fmt::format("leave out the `{}`", word.text), false));
  const auto* found = std::ranges::find(foreign_units, word.text, &ForeignUnit::name);
  if (found == std::end(foreign_units) || !declarations.units.contains(found->ours)) return std::nullopt;
  return Advice(readable("write it in `{}`: 1 {} is {:.6g} {}", found->ours, word.text, found->size, found->ours));
}

/// Whether this keyword is before the name that is declared there.
bool is_declared_as(const SourceSet& sources, const Span& declared, std::string_view keyword) {
  std::string_view before = std::string_view(sources[declared.source].text).substr(0, declared.begin);
  while (!before.empty() && before.back() == ' ') before.remove_suffix(1);
  return before.ends_with(keyword);
}

}  // namespace

std::vector<Fix> append_unit(const SyntaxTree& tree, ExprId expr, const std::string& unit, const SourceSet& sources) {
  const auto* literal = std::get_if<NumberLiteral>(&tree.expr(bare(tree, expr)));
  // 1/m cannot follow a number, and a number with a unit such as % is not bare.
  if (!literal || literal->suffix.count > 0 || unit.empty() || !begins_name(unit.front())) return {};
  const Span span = tree.span(expr);
  return {insert_after(span, " " + unit, fmt::format("write `{} {}`", sources.text(span), unit), false)};
}

Advice unit_mend(const Word& word, const Declarations& declarations, const Surroundings& surroundings) {
  const bool in_file = &declarations == &surroundings.declarations;
  if (auto imported = in_file ? import_mend(surroundings, word.text, {"unit", "constant"}) : std::nullopt)
    return *std::move(imported);
  if (const auto symbol = symbol_of_unit(word.text); symbol && declarations.units.contains(*symbol))
    return Advice(fmt::format("write `{}`", *symbol))
        .fix(replace(word.span, *symbol, {}, false))
        .fact("meant", *symbol);
  if (auto foreign = foreign_mend(word, declarations, surroundings)) return *std::move(foreign);
  if (auto prefix = prefix_mend(word.text, declarations)) return *std::move(prefix);
  if (const auto parted = parted_units(word.text, declarations))
    return Advice(fmt::format("units are joined by a space: write `{}`", *parted))
        .fix(replace(word.span, *parted, {}, false))
        .fact("meant", *parted);
  // No safe fix: one letter may change a factor from a million to a thousandth, as in `MN` and `mN`.
  return did_you_mean(word.span, word.text, declarations.units.spellings(),
                      "declare it, as in `unit thou = 25.4 um`, or use one of schema/units.wale", false);
}

std::optional<Advice> height_mend(const ExpressionReading& reading, const SyntaxTree& tree, ExprId expr,
                                  const Scope& scope, const Dimension& expected) {
  if (expected != reading.names->dimension("force")) return std::nullopt;
  std::vector<ProductName> factors;
  collect_names(tree, expr, false, factors);
  for (const ProductName& factor : factors) {
    const auto* binding = scope.find(factor.name);
    if (binding && is_declared_as(reading.surroundings.sources, binding->declared, "height"))
      return Advice(
          fmt::format("a height is no force; to push the hand down its slopes write `lateral({}, amplitude: "
                      "1 N)`",
                      factor.name));
  }
  return std::nullopt;
}

Advice dimension_mend(const ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, const Scope& scope,
                      const Dimension& expected, const Dimension& found) {
  const Surroundings& surroundings = reading.surroundings;
  if (auto height = height_mend(reading, tree, expr, scope, expected)) return *std::move(height);
  std::string unit = customary_unit(surroundings.declarations, expected);
  const std::string text(surroundings.sources.text(tree.span(expr)));
  const auto* literal = std::get_if<NumberLiteral>(&tree.expr(bare(tree, expr)));
  const bool is_literal = literal != nullptr, is_call = std::holds_alternative<Call>(tree.expr(expr));
  if (found.plain()) {
    if (is_literal && literal->suffix.count > 0)  // `50 %`, `30 deg`
      return fmt::format("write {}, in {}", with_article(reading.dimension_names().words(expected)), unit);
    // What a hand holds has some hundred grams.
    constexpr double heaviest = 5;
    if (is_literal && unit == "kg" && literal->value >= heaviest) unit = "g";
    if (is_literal)
      return Advice(fmt::format("a plain number needs its unit: write `{} {}`", text, unit))
          .fix(append_unit(tree, expr, unit, surroundings.sources));
    const auto* const use = std::get_if<NameUse>(&tree.expr(bare(tree, expr)));
    const auto* const binding = use ? scope.find(text) : nullptr;
    if (binding && is_declared_as(surroundings.sources, binding->declared, "param"))
      return Advice(
                 fmt::format("declare it with a unit, as in `param {} = 3 {} in 1 {} .. 5 {}`", text, unit, unit, unit))
          .see(binding->declared, "a plain number");
    return is_call ? fmt::format("give it a unit, as in `{} * 1 {}`", text, unit)
                   : fmt::format("give it a unit, as in `({}) * 1 {}`", text, unit);
  }
  if (expected.plain()) {
    if (auto quotient = quotient_mend(reading, tree, expr, scope, found)) return *std::move(quotient);
    const std::string of_found = customary_unit(surroundings.declarations, found);
    const bool is_name = std::holds_alternative<NameUse>(tree.expr(expr));
    if (is_name || is_call)
      return fmt::format("divide it by a quantity of its own dimension, as in `{} / 2 {}`", text, of_found);
    return fmt::format("divide it by a quantity of its own dimension, such as `/ 1 {}`", of_found);
  }
  if (auto inverse = is_literal ? inverse_mend(reading, tree, expr, expected, found) : std::nullopt)
    return *std::move(inverse);
  if (auto weight = weight_mend(reading, tree, expr, expected, found)) return *std::move(weight);
  if (auto fraction = fraction_mend(reading, tree, expr, expected, found)) return *std::move(fraction);
  if (is_literal) return fmt::format("write {}, in {}", with_article(reading.dimension_names().words(expected)), unit);
  std::vector<ProductName> factors;
  collect_names(tree, expr, false, factors);
  return factor_mend(reading, tree, factors, scope, expected, found / expected);
}

void report_dimension(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, const Scope& scope,
                      const Dimension& found, const Dimension& expected) {
  report_dimension(reading, tree, expr, found, expected, dimension_mend(reading, tree, expr, scope, expected, found));
}

void report_dimension(ExpressionReading& reading, const SyntaxTree& tree, ExprId expr, const Dimension& found,
                      const Dimension& expected, Advice advice) {
  const DimensionNames& names = reading.dimension_names();
  const auto sides = names.side_by_side(expected, found);
  const std::string of_expected = names.words(expected), of_found = names.words(found);
  Diagnostic diagnostic =
      std::move(advice)
          .fact("expected", of_expected)
          .fact("found", of_found)
          .about(Code::wrong_dimension, tree.span(expr), fmt::format("expected {}, found {}", of_expected, of_found));
  diagnostic.label = names.unit_beside(expected, found);
  diagnostic.expected = sides[0];
  diagnostic.found = sides[1];
  reading.calls.say(std::move(diagnostic));
}

}  // namespace wale
