#pragma once

#include <memory>

#include "compiler/declarations/declarations.hpp"
#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/text/resolver.hpp"

namespace wale {

/// The embedded files that every file knows, parsed and declared once per process. `load_modules` reports the errors in
/// `problems`. Thread-safe.
std::shared_ptr<const CommonModules> common_modules();

/// Declares everything that a file may use. Imports of `tree` are resolved by `resolver`, or else among the embedded
/// modules; each file is loaded once. Materials that the file uses but neither declares nor imports are looked up in
/// the library. The exported devices of a module `devices`, if there is one, and of the files of `Resolver::devices`
/// need no import. A file that is itself one of the embedded common files replaces that one. Errors are reported to
/// `diagnostics`.
ModuleSet load_modules(SyntaxTree tree, SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics);
/// The same with other common files instead of the embedded ones.
ModuleSet load_modules(SyntaxTree tree, SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics,
                       std::shared_ptr<const CommonModules> common);

}  // namespace wale
