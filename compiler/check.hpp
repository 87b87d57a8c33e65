#pragma once

#include "compiler/checked.hpp"
#include "compiler/diagnostic.hpp"
#include "compiler/resolver.hpp"

namespace wale {

/// A parsed file, the embedded files and everything they import, all declared.
struct ModuleSet {
  SourceId source = 0;                             ///< of the file itself
  std::vector<std::unique_ptr<SyntaxTree>> trees;  ///< each after those it refers to
  Declarations declarations;
};

/// Parses the embedded files and, through `resolver`, the imports of `tree`, each once, and enters all declarations.
ModuleSet load_modules(SyntaxTree tree, SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics);

/// Gives every expression a dimension and every name its meaning.
///
/// Reports all errors to `diagnostics`; the result is fit for `solve` only when there are none.
CheckedModule check(ModuleSet modules, const SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics);

}  // namespace wale
