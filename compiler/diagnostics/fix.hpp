#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"

namespace wale {

// Functions that make a fix in one line. A fix is safe if no other meaning is possible; then `wale check --fix` writes
// it into the file without asking. The default title is "write `TEXT`".

/// Replaces the text of the span.
Fix replace(Span span, std::string text, std::string title = {}, bool safe = true);
/// Inserts a text before the first character of the span.
Fix insert_before(Span span, std::string text, std::string title = {}, bool safe = true);
/// Inserts a text after the last character of the span.
Fix insert_after(Span span, std::string text, std::string title = {}, bool safe = true);

/// "Did you mean": the fix that replaces a misspelt word by the nearest candidate; none if no candidate is near.
///
/// It is safe only if the nearest candidate is unique and differs by one slip: a letter added, dropped or replaced, two
/// neighbours exchanged, or capitals. If a slip may change the meaning much, as between the units `MN` and `mN`, pass
/// `may_be_safe = false`.
std::vector<Fix> respell(Span span, std::string_view word, const std::vector<std::string>& candidates,
                         bool may_be_safe = true);

}  // namespace wale
