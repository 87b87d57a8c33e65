#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace wale {

/// The symbol of a unit that someone wrote out or abbreviated in another way: "mm" for `millimetres`, "s" for `sec`.
/// Capitals do not count. Where the symbol is declared is not asked; schema/units.wale has them all.
std::optional<std::string> symbol_of_unit(std::string_view name);

}  // namespace wale
