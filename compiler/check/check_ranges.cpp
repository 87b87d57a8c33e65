// Ranges of parameters whose units do not agree with the default.
#include <fmt/format.h>

#include "compiler/check/check_statements.hpp"
#include "compiler/diagnostics/fix.hpp"
#include "compiler/text/readable.hpp"

namespace wale {

/// Warns of `50 % in 0 .. 100`, a range that reaches 10000 %.
void StatementChecker::warn_of_percent(const ParamStatement& node) {
  if (!node.range) return;
  const auto* value = std::get_if<NumberLiteral>(&tree().expr(node.value));
  const auto* high = std::get_if<NumberLiteral>(&tree().expr(node.range->high));
  if (!value || !high || value->suffix.count != 1 || high->suffix.count > 0 || !(high->value > 1)) return;
  if (tree().suffix(*value).front().name.text != "%") return;
  const Span span = tree().span(node.range->high);
  report(
      Code::beyond_soft_range, span,
      readable("the default of `{}` is in percent, and its range reaches {:.6g} %", node.name.text, 100 * high->value),
      Advice(fmt::format("write `{} %`", surroundings_.sources.text(span)))
          .fix(insert_after(span, " %", fmt::format("write `{} %`", surroundings_.sources.text(span)), false)));
}

/// The proposal to give each of these numbers that has none the unit: "write `3 mm`", or, of several, all of the
/// parameter: "write `3 mm in 1 mm .. 5 mm`".
Advice StatementChecker::with_units(const std::vector<ExprId>& numbers, const std::string& unit,
                                    const char* write) const {
  Fix all;
  std::string each, whole;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::string text(surroundings_.sources.text(tree().span(numbers[i])));
    const std::vector<Fix> fixes = append_unit(tree(), numbers[i], unit, surroundings_.sources);
    const std::string meant = fixes.empty() ? text : fmt::format("{} {}", text, unit);
    const bool is_default = numbers.size() == 3;
    whole += fmt::format("{}{}", i == 0 ? "" : is_default && i == 1 ? " in " : " .. ", meant);
    if (fixes.empty()) continue;
    all.edits.insert(all.edits.end(), fixes.front().edits.begin(), fixes.front().edits.end());
    each = meant;
  }
  if (all.edits.empty()) return fmt::format("give the number its unit, {}", unit);
  const std::string& meant = all.edits.size() == 1 ? each : whole;
  all.title = fmt::format("write `{}`", meant);
  return Advice(fmt::format("{} `{}`", write, meant)).fix(std::move(all));
}

/// Whether the default lacks the unit that the range has. That is one error, and not one for each end of the range.
bool StatementChecker::lacks_its_unit(const ParamStatement& node, const Value& value) {
  if (!node.range || value.type != Value::Type::number || !value.dimension.plain()) return false;
  Value low = checker_.check(tree(), node.range->low, scope_);
  if (low.failed()) return true;
  if (low.type != Value::Type::number) return false;
  ExprId measured = node.range->low;
  if (low.dimension.plain()) {
    // `3 in 1 .. 5 mm`: the unit behind the last number was meant for all of them.
    const Value high = checker_.check(tree(), node.range->high, scope_);
    if (high.failed() || high.type != Value::Type::number || high.dimension.plain()) return high.failed();
    low = high, measured = node.range->high;
  }
  const auto& names = declarations().names();
  const std::string unit = written_unit(node, low.dimension).first;
  const auto sides = names.side_by_side(low.dimension, value.dimension);
  Diagnostic diagnostic = with_units({node.value, node.range->low, node.range->high}, unit, "write")
                              .see(tree().span(measured), with_article(names.words(low.dimension)))
                              .fact("expected", names.words(low.dimension))
                              .fact("found", names.words(value.dimension))
                              .about(Code::wrong_dimension, value.span,
                                     fmt::format("`{}` is {}, but its default has no unit", node.name.text,
                                                 with_article(names.words(low.dimension))));
  diagnostic.expected = sides[0];
  diagnostic.found = sides[1];
  surroundings_.diagnostics.report(std::move(diagnostic));
  return true;
}

/// Whether both ends of the range agree with each other and not with the default. That is one error, at the default.
bool StatementChecker::disagrees_with_its_range(const ParamStatement& node, const Value& value) {
  if (!node.range || value.type != Value::Type::number) return false;
  const Value low = checker_.check(tree(), node.range->low, scope_);
  if (low.failed() || low.type != Value::Type::number || low.dimension == value.dimension || low.dimension.plain())
    return false;
  const Value high = checker_.check(tree(), node.range->high, scope_);
  if (high.failed() || high.type != Value::Type::number || high.dimension != low.dimension) return false;
  const auto& names = declarations().names();
  const auto sides = names.side_by_side(low.dimension, value.dimension);
  const Span range = {tree().source, tree().span(node.range->low).begin, tree().span(node.range->high).end};
  Diagnostic diagnostic =
      Advice(fmt::format("give the default in {}, or the range in {}", customary_unit(declarations(), low.dimension),
                         customary_unit(declarations(), value.dimension)))
          .see(range, with_article(names.words(low.dimension)))
          .fact("expected", names.words(low.dimension))
          .fact("found", names.words(value.dimension))
          .about(Code::wrong_dimension, value.span,
                 fmt::format("the default of `{}` is {}, its range is of {}", node.name.text,
                             with_article(names.words(value.dimension)), with_article(names.words(low.dimension))));
  diagnostic.label = names.unit_beside(low.dimension, value.dimension);
  diagnostic.expected = sides[0];
  diagnostic.found = sides[1];
  surroundings_.diagnostics.report(std::move(diagnostic));
  return true;
}

/// Whether an end of a range is a bare number where the default has a unit, which is reported. The mend is in the unit
/// that the author wrote, since `1 .. 5 N/mm` does not mean 1 N/m.
bool StatementChecker::range_lacks_its_unit(const ParamStatement& node, const Range& range,
                                            const Dimension& dimension) {
  if (dimension.plain()) return false;
  for (const ExprId end : {range.low, range.high}) {
    ExprId bare = end;
    while (const auto* unary = std::get_if<Unary>(&tree().expr(bare))) bare = unary->operand;
    const auto* literal = std::get_if<NumberLiteral>(&tree().expr(bare));
    if (!literal || literal->suffix.count > 0 || literal->value == 0) continue;
    const auto& names = declarations().names();
    const std::string unit = written_unit(node, dimension).first;
    const Span span = tree().span(end);
    const auto sides = names.side_by_side(dimension, Dimension{});
    Diagnostic diagnostic =
        with_units({range.low, range.high}, unit, "a plain number needs its unit: write")
            .fact("expected", names.words(dimension))
            .fact("found", names.words(Dimension{}))
            .about(Code::wrong_dimension, span,
                   fmt::format("expected {}, found {}", names.words(dimension), names.words(Dimension{})));
    diagnostic.expected = sides[0];
    diagnostic.found = sides[1];
    surroundings_.diagnostics.report(std::move(diagnostic));
    return true;
  }
  return false;
}

}  // namespace wale
