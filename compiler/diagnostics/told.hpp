#pragma once

#include "compiler/diagnostics/diagnostic.hpp"
#include "wale/result.hpp"

namespace wale {

/// A diagnostic as a value for programs, with the place in its file.
Error told(const Diagnostic& diagnostic, const SourceSet& sources);

}  // namespace wale
