#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace wale {

/// The symbol of a unit that is spelled out or abbreviated differently: "mm" for `millimetres`, "s" for `sec`. Capitals
/// do not matter. Whether a unit with this symbol is declared is not checked; schema/units.wale declares them all.
std::optional<std::string> symbol_of_unit(std::string_view name);

}  // namespace wale
