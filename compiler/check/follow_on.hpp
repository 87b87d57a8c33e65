#pragma once

#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/parse/syntax_tree.hpp"

namespace wale {

/// Removes diagnostics that only follow from another error:
///
/// * an unknown name or unit (W0201, W0203) whose own declaration, above or in another file, has an error, or which
///   is in a line that could not be read and may declare it;
/// * a name or unit that is unknown in a file with an import that is not found (W0212), unless it is a misspelling of a
///   known one;
/// * a missing setting of a record (W0207) if part of the record could not be read;
/// * anything in the compiler's own files if the file that is being checked has an error: the compiler's files are
///   correct on their own.
///
/// A name that is unknown at several places of a file is reported once, with the other places as secondary spans. If
/// there was an error, at least one remains.
Diagnostics without_follow_ons(const Diagnostics& diagnostics, const std::vector<const SyntaxTree*>& trees,
                               const SourceSet& sources, SourceId checked);

}  // namespace wale
