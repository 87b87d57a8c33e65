#pragma once

#include <map>
#include <memory>
#include <vector>

#include "compiler/declarations.hpp"
#include "compiler/diagnostic.hpp"
#include "compiler/resolver.hpp"

namespace wale {

/// A parsed file, what every file knows, and all that it imports, everything declared.
///
/// Declarations point into it, so it neither moves its parts nor is it copied.
struct ModuleSet {
  SourceId source = 0;  ///< of the file itself
  std::shared_ptr<const CommonModules> common;
  std::vector<std::shared_ptr<const Module>> modules;  ///< each after those it imports; the file itself is the last,
                                                       ///< unless it is one of the common ones
  std::map<const Import*, std::shared_ptr<const Module>> imports;  ///< of all modules: what each import brought
  /// The names that the file itself may use.
  const Declarations& declarations() const {
    return modules.empty() ? common->declarations : modules.back()->declarations;
  }
};

/// The embedded files that every file knows, parsed and declared once for all compilations.
std::shared_ptr<const CommonModules> common_modules();

/// Follows the imports of `tree` through `resolver`, and where that finds nothing among the embedded modules, each file
/// once, and declares everything. A file that is itself one of the embedded common ones stands in their midst.
ModuleSet load_modules(SyntaxTree tree, SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics);

}  // namespace wale
