#pragma once

#include "compiler/declarations/declarations.hpp"
#include "compiler/diagnostics/diagnostic.hpp"

namespace wale {

/// Enters all declarations of a file. Dimensions and units are evaluated at once. Constants and functions are entered
/// as syntax and evaluated where they are used. Errors are reported to `diagnostics`.
void declare(const SyntaxTree& tree, const SourceSet& sources, Declarations& declarations, Diagnostics& diagnostics);

/// Enters the materials and the exported declarations of an imported file.
void import_names(const Declarations& from, const Import& import, Declarations& into, const SourceSet& sources,
                  Diagnostics& diagnostics);

}  // namespace wale
