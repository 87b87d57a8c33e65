#pragma once

#include <memory>

#include "compiler/declarations/declarations.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/text/resolver.hpp"

namespace wale {

/// The embedded files that every file knows, parsed and declared once for all compilations.
std::shared_ptr<const CommonModules> common_modules();

/// Follows the imports of `tree` through `resolver`, and where that finds nothing among the embedded modules, each file
/// once, and declares everything. A file that is itself one of the embedded common ones stands in their midst. The
/// devices that a module `devices` exports, where there is one, are known to the file without its importing them.
ModuleSet load_modules(SyntaxTree tree, SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics);

}  // namespace wale
