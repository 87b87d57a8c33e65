#include "compiler/declarations/dimension.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace wale {

Dimension operator*(Dimension a, const Dimension& b) {
  for (std::size_t i = 0; i < Dimension::capacity; ++i) a.twelfths[i] += b.twelfths[i];
  return a;
}

Dimension operator/(Dimension a, const Dimension& b) {
  for (std::size_t i = 0; i < Dimension::capacity; ++i) a.twelfths[i] -= b.twelfths[i];
  return a;
}

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
  // N/m, N s/m and their like read better than their base units: one named unit times or over a base unit or two. Units
  // made of several come first, N s/m before kg/s, and nothing is told per kg, m/s^2 least of all.
  const auto single = [&](const Named& named) {
    return std::ranges::count(named.dimension.twelfths, 0) >= std::ptrdiff_t{Dimension::capacity} - 1;
  };
  for (const bool single_too : {false, true}) {
    for (const auto& named : units)
      for (std::size_t i = 0; i < base_units.size(); ++i) {
        Dimension base;
        base.twelfths[i] = Dimension::unit_exponent;
        if (named.dimension == base || base_units[i] == "kg" || (single(named) && !single_too)) continue;
        if (named.dimension / base == dimension) return fmt::format("{}/{}", named.name, base_units[i]);
        if (named.dimension * base == dimension) return fmt::format("{} {}", named.name, base_units[i]);
      }
    for (const auto& named : units)
      for (std::size_t over = 0; over < base_units.size(); ++over)
        for (std::size_t times = 0; times < base_units.size(); ++times) {
          Dimension ratio;
          ratio.twelfths[times] += Dimension::unit_exponent;
          ratio.twelfths[over] -= Dimension::unit_exponent;
          if (times != over && base_units[over] != "kg" && base_units[times] != "kg" &&
              (single_too || !single(named)) && named.dimension * ratio == dimension)
            return fmt::format("{} {}/{}", named.name, base_units[times], base_units[over]);
        }
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
  if (expected.plain() || found.plain() || !derived) return unit(found);  // "m m" and "N/m m" would say less
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
