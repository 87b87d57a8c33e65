#pragma once

#include <memory>

#include "compiler/declarations/declarations.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/text/resolver.hpp"

namespace wale {

/// The embedded files that every file knows, parsed and declared once for the process. Errors in them are in `problems`,
/// which `load_modules` reports. May be called by several threads at once.
std::shared_ptr<const CommonModules> common_modules();

/// Declares everything that a file may use: follows the imports of `tree` through `resolver`, and where that finds
/// nothing among the embedded modules, each file once. Materials that others are made from and that the file neither
/// declares nor imports are looked for in the library. The devices that a module `devices` exports, where there is one,
/// need no import, and after them those of `Resolver::devices`. A file that is itself one of the embedded common ones takes the place of that one.
ModuleSet load_modules(SyntaxTree tree, SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics);
/// The same with other files in the place of the embedded common ones.
ModuleSet load_modules(SyntaxTree tree, SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics,
                       std::shared_ptr<const CommonModules> common);

}  // namespace wale
