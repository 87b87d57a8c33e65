#include "compiler/declarations/dimension.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace wale {

std::optional<Dimension> power(Dimension a, int numerator, int denominator) {
  for (auto& exponent : a.twelfths) {
    const long scaled = long{exponent} * numerator;
    const long result = denominator == 0 ? 0 : scaled / denominator;
    if (denominator == 0 || result * denominator != scaled || std::abs(result) > 32000) return std::nullopt;
    exponent = static_cast<std::int16_t>(result);
  }
  return a;
}

std::string with_article(const std::string& word) { return (word.find_first_of("aeiou") == 0 ? "an " : "a ") + word; }

namespace {

/// "m", "m^2", "s^-1", "m^(1/2)"; empty for exponent 0.
std::string factor(const std::string& unit, int twelfths) {
  if (twelfths == 0) return {};
  if (twelfths == Dimension::unit_exponent) return unit;
  if (twelfths % Dimension::unit_exponent == 0) return fmt::format("{}^{}", unit, twelfths / Dimension::unit_exponent);
  int numerator = twelfths, denominator = Dimension::unit_exponent;
  for (const int prime : {2, 2, 3})
    if (numerator % prime == 0 && denominator % prime == 0) numerator /= prime, denominator /= prime;
  return fmt::format("{}^({}/{})", unit, numerator, denominator);
}

/// The order in which people write base units: kg m s, whatever the order of declaration.
std::vector<std::size_t> writing_order(const std::vector<std::string>& base_units) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < base_units.size(); ++i) order.push_back(i);
  std::stable_partition(order.begin(), order.end(), [&](std::size_t i) { return base_units[i] == "kg"; });
  return order;
}

/// Whether at most one base dimension has an exponent.
bool is_single(const Dimension& dimension) {
  return std::ranges::count(dimension.twelfths, 0) >= std::ptrdiff_t{Dimension::capacity} - 1;
}

/// The base units by which a dimension must be multiplied and divided to get another one; at most one each.
struct BaseSteps {
  std::optional<std::size_t> times, over;
};

/// Empty if more are needed, or none.
std::optional<BaseSteps> steps_between(const Dimension& from, const Dimension& to) {
  BaseSteps steps;
  for (std::size_t i = 0; i < Dimension::capacity; ++i) {
    const int change = to.twelfths[i] - from.twelfths[i];
    if (change == 0) continue;
    auto& step = change > 0 ? steps.times : steps.over;
    if (step || std::abs(change) != Dimension::unit_exponent) return std::nullopt;
    step = i;
  }
  if (!steps.times && !steps.over) return std::nullopt;
  return steps;
}

}  // namespace

std::optional<std::string> DimensionNames::name(const Dimension& dimension) const {
  const auto found = std::ranges::find(dimensions, dimension, &Named::dimension);
  if (found == dimensions.end()) return std::nullopt;
  return found->name;
}

std::string DimensionNames::words(const Dimension& dimension) const {
  if (dimension.plain()) return "a plain number";
  if (auto named = name(dimension)) return *named;
  return unit(dimension);
}

std::string DimensionNames::factors(const Dimension& dimension) const {
  std::string text;
  for (const std::size_t i : writing_order(base_units))
    if (const auto f = factor(base_units[i], dimension.twelfths[i]); !f.empty()) text += (text.empty() ? "" : " ") + f;
  return text.empty() ? "1" : text;
}

std::string DimensionNames::unit(const Dimension& dimension) const {
  if (dimension.plain()) return {};
  if (const auto found = std::ranges::find(units, dimension, &Named::dimension); found != units.end())
    return found->name;
  // N/m, N s/m and the like are easier to read than their base units: a named unit, multiplied or divided by one or two
  // base units. Units of several base dimensions come first, N s/m before kg/s. Nothing is written per kg, so that
  // m/s^2 does not become N/kg.
  const auto may_be_told = [&](std::optional<std::size_t> base) { return !base || base_units[*base] != "kg"; };
  const auto is_base = [](const Dimension& unit, std::size_t i) {
    return is_single(unit) && unit.twelfths[i] == Dimension::unit_exponent;
  };
  // The power of one base unit, 1/m, is plain by itself.
  for (const bool single_too : {false, true})
    for (const bool both : {false, true})
      for (const auto& named : units) {
        if (is_single(dimension)) continue;
        if (!single_too && is_single(named.dimension)) continue;
        const auto steps = steps_between(named.dimension, dimension);
        if (!steps || (steps->times && steps->over) != both || !may_be_told(steps->times) || !may_be_told(steps->over))
          continue;
        if (both) return fmt::format("{} {}/{}", named.name, base_units[*steps->times], base_units[*steps->over]);
        if (is_base(named.dimension, steps->times ? *steps->times : *steps->over)) continue;  // m^2 is not "m m"
        if (steps->times) return fmt::format("{} {}", named.name, base_units[*steps->times]);
        return fmt::format("{}/{}", named.name, base_units[*steps->over]);
      }
  std::string above, below;
  for (const std::size_t i : writing_order(base_units)) {
    const int exponent = dimension.twelfths[i];
    auto& side = exponent > 0 ? above : below;
    if (const auto f = factor(base_units[i], std::abs(exponent)); !f.empty())
      side += (exponent > 0 ? (above.empty() ? "" : " ") : "/") + f;
  }
  return (above.empty() ? "1" : above) + below;
}

std::string DimensionNames::unit_beside(const Dimension& expected, const Dimension& found) const {
  const std::string known = unit(expected);
  const bool derived =
      std::ranges::find(base_units, known) == base_units.end() && known.find_first_of(" /") == std::string::npos;
  if (expected.plain() || found.plain() || !derived) return unit(found);  // "m m" and "N/m m" would be less clear
  for (std::size_t i = 0; i < base_units.size(); ++i) {
    Dimension base;
    base.twelfths[i] = Dimension::unit_exponent;
    if (found == expected * base && expected != base) return fmt::format("{} {}", known, base_units[i]);
    if (found == expected / base && found != base) return fmt::format("{}/{}", known, base_units[i]);
  }
  return unit(found);
}

std::array<std::string, 2> DimensionNames::side_by_side(const Dimension& expected, const Dimension& found) const {
  const std::array<const Dimension*, 2> both{&expected, &found};
  std::array<std::string, 2> text;
  std::array<std::string, 2> names{unit(expected), unit_beside(expected, found)};
  for (auto& name : names)
    if (name.empty()) name = "number";
  const std::size_t name_width = std::max(names[0].size(), names[1].size());
  for (int side = 0; side < 2; ++side) text[side] = fmt::format("{:<{}}  =", names[side], name_width);
  for (const std::size_t i : writing_order(base_units)) {
    const std::string a = factor(base_units[i], expected.twelfths[i]), b = factor(base_units[i], found.twelfths[i]);
    const std::size_t width = std::max(a.size(), b.size());
    if (width == 0) continue;
    text[0] += fmt::format(" {:<{}}", a, width);
    text[1] += fmt::format(" {:<{}}", b, width);
  }
  for (int side = 0; side < 2; ++side) {
    if (both[side]->plain()) text[side] = "a plain number";
    if (names[side] == factors(*both[side])) text[side] = names[side];  // m is m and needs no equation
    text[side].erase(text[side].find_last_not_of(' ') + 1);
  }
  return text;
}

}  // namespace wale
