#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"

namespace wale {

/// A text after some fixes.
struct FixedText {
  std::string text;
  std::vector<Fix> applied;  ///< in the order of the text; their spans are of the text before
};

/// Applies fixes to the text of one source, each whole or not at all. A fix that touches another source, or a place
/// that an earlier fix of the list changes, is left out: it may be right after the next look at the result.
FixedText apply_fixes(std::string_view text, SourceId source, const std::vector<Fix>& fixes);

/// The safe fixes of a file's diagnostics, of each diagnostic the first.
std::vector<Fix> safe_fixes(const std::vector<Diagnostic>& diagnostics);

}  // namespace wale
