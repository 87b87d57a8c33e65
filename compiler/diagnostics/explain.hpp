#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "wale/result.hpp"

namespace wale {

/// All codes, in the order of their numbers.
std::vector<Code> all_codes();

/// The code called "W0301", "w301" or "301". Error: `Code::unknown_name`, with the nearest code as its mend.
Result<Code> code_named(std::string_view name);

/// The explanation as Markdown. A block `wale-error` is an example that yields the code, and a block `wale` is the same
/// example mended.
std::string_view explanation(Code code);

/// The explanation for a terminal: code, severity and title, what it means, and an example before and after.
std::string explanation_text(Code code);

/// All codes with their severities and titles, a line each.
std::string codes_text();

}  // namespace wale
