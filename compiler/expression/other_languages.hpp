#pragma once

#include <optional>
#include <string_view>

namespace wale {

/// What Wale has for a function of another language or of everyday speech: "`a^2`" for `pow`. Empty if the word is none
/// that people bring along.
std::optional<std::string_view> instead_of_function(std::string_view name);

/// The same for a value: "`pi`" for `Math.PI`.
std::optional<std::string_view> instead_of_value(std::string_view name);

}  // namespace wale
