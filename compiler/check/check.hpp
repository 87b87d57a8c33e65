#pragma once

#include "compiler/diagnostics/diagnostic.hpp"
#include "compiler/expression/checked.hpp"
#include "compiler/text/resolver.hpp"

namespace wale {

/// Gives every expression a dimension and every name its meaning.
///
/// Reports all errors to `diagnostics`; the result is fit for `solve` only when there are none.
CheckedModule check(ModuleSet modules, const SourceSet& sources, Resolver& resolver, Diagnostics& diagnostics);

}  // namespace wale
