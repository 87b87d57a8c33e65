#include "compiler/expression/check_expression.hpp"

// The bounds of states: written, or those of a dimension.

namespace wale {
namespace {

std::optional<StateBounds> read_bounds(ExpressionReading& reading, const SyntaxTree& tree, const Range& written,
                                       Scope& scope, const Dimension& dimension) {
  const auto low = constant_number(reading, tree, written.low, scope, dimension);
  const auto high = constant_number(reading, tree, written.high, scope, dimension);
  if (!low || !high) return std::nullopt;
  if (*low <= *high) return StateBounds{*low, *high};
  reading.calls.report(Code::value_out_of_range, tree.span(written.low), "the range runs from high to low", "",
                       "swap its ends");
  return std::nullopt;
}

}  // namespace

std::optional<StateBounds> state_bounds(ExpressionReading& reading, const Dimension& dimension,
                                        std::string_view declared) {
  const Declarations& known = *reading.names;
  std::optional<StateBounds> found;
  const auto take = [&](const DimensionBounds& bounds) {
    Scope outside;
    if (bounds.range) found = read_bounds(reading, *bounds.tree, *bounds.range, outside, dimension);
  };
  if (!declared.empty())
    if (const auto* bounds = known.dimension_bounds.find(declared)) take(*bounds);
  if (!found)
    known.dimensions.each([&](const std::string& name, const Dimension& other) {
      if (!found && other == dimension) take(*known.dimension_bounds.find(name));
    });
  return found;
}

std::optional<StateBounds> ExpressionChecker::bounds(const SyntaxTree& tree, const Range& written, Scope& scope,
                                                     const Dimension& dimension) {
  return read_bounds(reading_, tree, written, scope, dimension);
}

std::optional<StateBounds> ExpressionChecker::bounds_of(const Dimension& dimension, std::string_view declared) {
  return state_bounds(reading_, dimension, declared);
}

}  // namespace wale
