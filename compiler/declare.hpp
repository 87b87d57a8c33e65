#pragma once

#include "compiler/check_expression.hpp"

namespace wale {

/// Enters everything that one file declares: dimensions and units first, then constants and functions, then the records
/// (percepts, maps, devices, levels, hands), whose figures are worked out here. Names declared twice, settings that a
/// declaration lacks or does not have, wrong dimensions: all are reported.
///
/// `tree` must outlive `declarations`, which point into it.
void declare(const SyntaxTree& tree, const SourceSet& sources, Declarations& declarations, Diagnostics& diagnostics);

}  // namespace wale
