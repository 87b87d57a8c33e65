#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "wale/result.hpp"

namespace wale {

/// A text of the thesis in its lines, which end with a carriage return, a newline or both. Errors: `too_long` beyond 4 MB;
/// `invalid_encoding` for bytes that are not UTF-8; `damaged_file` for control characters, with the line.
Result<std::vector<std::string>> lines_of_thesis_text(std::string_view text, const std::string& name);

/// Without white space in front and behind.
std::string_view without_blanks(std::string_view text);

/// Whether a name can stand in such a text: one line, with something to see, and valid UTF-8.
bool is_thesis_name(std::string_view name);

}  // namespace wale
