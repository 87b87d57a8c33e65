#pragma once

#include <optional>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/parse/syntax_tree.hpp"

namespace wale {

/// Reads one file of Wale (schema/LANGUAGE.md has the grammar).
///
/// Reports every error and continues at the next statement. Unreadable parts are left out of the tree, or are
/// `Erroneous` there. Text of any bytes is safe; time and memory are linear in its size.
SyntaxTree parse(const SourceSet& sources, SourceId source, Diagnostics& diagnostics);

/// Reads a list of expressions separated by commas, as on a command line: "10 mm, 5 mm". The expressions are added to
/// `tree`, which then has no declarations. The result is their indices, or empty after errors, which are reported.
std::vector<ExprId> parse_expressions(const SourceSet& sources, SourceId source, SyntaxTree& tree,
                                      Diagnostics& diagnostics);

}  // namespace wale
