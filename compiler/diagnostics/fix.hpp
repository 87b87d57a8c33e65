#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"

namespace wale {

// Mends in one line. A mend is safe when nobody could have meant anything else: `wale check --fix` writes it into the
// file unasked. Without a title, the title is "write `TEXT`".

/// Puts a text in the place of what stands there.
Fix replace(Span span, std::string text, std::string title = {}, bool safe = true);
/// Puts a text before the first character of the span.
Fix insert_before(Span span, std::string text, std::string title = {}, bool safe = true);
/// Puts a text behind the last character of the span.
Fix insert_after(Span span, std::string text, std::string title = {}, bool safe = true);

/// "Did you mean": the mend that puts the nearest candidate in the place of a misspelt word, or none when no candidate
/// is near.
///
/// It is safe only if the nearest is unique and one slip away: a letter added, dropped or replaced, two neighbours
/// exchanged, or capitals. Where a slip changes the meaning by far, as between the units `MN` and `mN`, hand in
/// `may_be_safe = false`.
std::vector<Fix> respell(Span span, std::string_view word, const std::vector<std::string>& candidates,
                         bool may_be_safe = true);

}  // namespace wale
