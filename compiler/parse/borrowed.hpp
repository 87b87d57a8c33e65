#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace wale {

/// The word of Wale for a declaration that begins with a word of another language: "let" for `const`, "function" for
/// `def`. Empty for other words.
std::optional<std::string> borrowed_declaration(std::string_view word);

}  // namespace wale
