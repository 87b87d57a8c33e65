#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"

namespace wale {

/// A text after some fixes.
struct FixedText {
  std::string text;
  std::vector<Fix> applied;  ///< in the order of the text; their spans refer to the text before the fixes
};

/// Applies fixes to the text of one source, each completely or not at all. A fix that touches another source, or
/// overlaps with an earlier fix of the list, is left out; it may still apply to the result.
FixedText apply_fixes(std::string_view text, SourceId source, const std::vector<Fix>& fixes);

/// The first safe fix of each diagnostic.
std::vector<Fix> safe_fixes(const std::vector<Diagnostic>& diagnostics);

}  // namespace wale
