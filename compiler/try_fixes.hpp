#pragma once

#include <functional>

#include "compiler/diagnostics/diagnostic.hpp"

namespace wale {

/// Checks another text of the file that is checked.
using CheckAgain = std::function<Diagnostics(SourceSet& sources, SourceId source)>;

/// The diagnostics of a text with those fixes alone that mend: each is carried out by itself, and the text after it has
/// fewer errors than before and no new one in the lines that it changes. What cannot be read hides what has no meaning,
/// so an error that appears elsewhere was there before. A safe fix may uncover another mistake in its line, but leaves
/// no more errors there than before. Of many fixes the first 40 are tried, and the others are kept; so are those of warnings and all of a
/// text of more than 256 KiB.
Diagnostics with_fixes_that_mend(const SourceSet& sources, SourceId source, const Diagnostics& diagnostics,
                                 const CheckAgain& check);

/// The errors of a text by how far it is understood: what cannot be read (W01xx) hides what has no meaning (W02xx,
/// W03xx), and that hides what no program can be made of.
struct ErrorCount {
  std::size_t unread = 0, meaningless = 0, unmade = 0;

  explicit ErrorCount(const Diagnostics& diagnostics);

  /// Whether there are fewer errors, or as many, at the first stage where there are any.
  bool is_less_than(const ErrorCount& other) const;
  bool is_no_more_than(const ErrorCount& other) const;
};

}  // namespace wale
