#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"

namespace wale {

/// All codes, in the order of their numbers.
std::vector<Code> all_codes();

/// The code that someone names: "W0301", "w301" or "301".
std::optional<Code> code_named(std::string_view name);

/// The explanation as it is written: markdown, with a block `wale-error` that yields the code and a block `wale` that
/// is the mended one.
std::string_view explanation(Code code);

/// The explanation for a terminal: code, severity and title, what it means, and an example before and after.
std::string explanation_text(Code code);

/// All codes with their severities and titles, a line each.
std::string codes_text();

/// Why there is nothing to explain under that name, and which code may have been meant.
std::string unknown_code_text(std::string_view name);

}  // namespace wale
