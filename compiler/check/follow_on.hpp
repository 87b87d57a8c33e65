#pragma once

#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/parse/syntax_tree.hpp"

namespace wale {

/// The diagnostics without those that only echo another:
///
/// * an unknown name or unit (W0201, W0203) whose own declaration, above or in another file, has an error, or which
///   stands in a line that could not be read and may declare it;
/// * a setting that a record lacks (W0207) when part of the record could not be read;
/// * anything in the compiler's own files when the file that is being checked has an error: they are right by
///   themselves.
///
/// A name that is unknown at several places of a file is told once, with the others as secondary spans. Whatever is
/// left out, an error remains if there was one.
Diagnostics without_follow_ons(const Diagnostics& diagnostics, const std::vector<const SyntaxTree*>& trees,
                               const SourceSet& sources, SourceId checked);

}  // namespace wale
