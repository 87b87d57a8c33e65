#pragma once

#include <optional>

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/parse/syntax_tree.hpp"

namespace wale {

/// Reads one file of Wale (schema/LANGUAGE.md has the grammar).
///
/// Reports every error it finds and goes on at the next statement; what it could not read is left out of the tree or
/// stands there as `Erroneous`. Text of any bytes is safe to hand in; time and memory are linear in its size.
SyntaxTree parse(const SourceSet& sources, SourceId source, Diagnostics& diagnostics);

/// Reads a list of expressions separated by commas, as a command line gives it: "10 mm, 5 mm".
/// The tree has no declarations; the result names its expressions, or is empty when there were errors.
std::vector<ExprId> parse_expressions(const SourceSet& sources, SourceId source, SyntaxTree& tree,
                                      Diagnostics& diagnostics);

}  // namespace wale
