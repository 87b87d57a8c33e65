#pragma once

#include "compiler/declarations/declarations.hpp"
#include "compiler/diagnostics/diagnostic.hpp"

namespace wale {

/// Enters what a file declares. Dimensions and units are worked out at once; constants and functions are entered as
/// they stand and read where they are used.
void declare(const SyntaxTree& tree, const SourceSet& sources, Declarations& declarations, Diagnostics& diagnostics);

/// Enters what an imported file hands on: its materials, and whatever else stands behind `export`.
void import_names(const Declarations& from, const Import& import, Declarations& into, const SourceSet& sources,
                  Diagnostics& diagnostics);

}  // namespace wale
