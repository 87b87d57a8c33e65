#include "compiler/declarations/unit_names.hpp"

#include <algorithm>

namespace wale {
namespace {

struct UnitName {
  std::string_view name, symbol;
};

/// Names in the singular.
constexpr UnitName names[] = {
    {"meter", "m"},    {"metre", "m"},   {"gram", "g"},   {"gramme", "g"},  {"newton", "N"},    {"second", "s"},
    {"sec", "s"},      {"hertz", "Hz"},  {"joule", "J"},  {"watt", "W"},    {"pascal", "Pa"},   {"radian", "rad"},
    {"degree", "deg"}, {"percent", "%"}, {"pixel", "px"}, {"micron", "um"}, {"inches", "inch"}, {"count", "counts"},
    {"msec", "ms"},    {"usec", "us"},   {"kilo", "kg"},  {"kgs", "kg"},
};

struct Prefix {
  std::string_view name, symbol;
};
constexpr Prefix prefixes[] = {{"", ""}, {"kilo", "k"}, {"centi", "c"}, {"milli", "m"}, {"micro", "u"}};

/// The prefixed symbols that schema/units.wale declares.
constexpr std::string_view prefixed[] = {"km", "cm", "mm", "um", "kg", "mg", "ms", "us", "kHz", "mN", "kN", "mJ"};

}  // namespace

std::optional<std::string> symbol_of_unit(std::string_view name) {
  std::string word(name);
  for (char& c : word)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  for (const bool plural : {false, true}) {
    if (plural && !word.ends_with('s')) break;
    const std::string singular = plural ? word.substr(0, word.size() - 1) : word;
    for (const Prefix& prefix : prefixes)
      for (const UnitName& unit : names) {
        if (singular != std::string(prefix.name) + std::string(unit.name)) continue;
        std::string symbol = std::string(prefix.symbol) + std::string(unit.symbol);
        if (prefix.symbol.empty() || std::ranges::find(prefixed, symbol) != std::end(prefixed)) return symbol;
      }
  }
  return std::nullopt;
}

}  // namespace wale
