#pragma once

#include <memory>

#include "compiler/declarations/declarations.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/text/resolver.hpp"

namespace wale {

/// The embedded files that every file knows, parsed and declared once for all compilations. What is wrong with them is
/// in `problems`, which `load_modules` reports; whoever uses them without it says so.
std::shared_ptr<const CommonModules> common_modules();

/// Follows the imports of `tree` through `resolver`, and where that finds nothing among the embedded modules, each file
/// once, and declares everything. What a `like` means that no file declares or imports is looked for in the library. A
/// file that is itself one of the embedded common ones stands in their midst. The devices that a module `devices`
/// exports, where there is one, are known to the file without its importing them.
ModuleSet load_modules(SyntaxTree tree, SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics);
/// The same with something else for the embedded common ones.
ModuleSet load_modules(SyntaxTree tree, SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics,
                       std::shared_ptr<const CommonModules> common);

}  // namespace wale
