#pragma once

#include <string>

#include "compiler/diagnostic.hpp"

namespace wale {

/// A diagnostic as people read it: code, message, place, the line with carets, expected and found, the mend.
/// `colour` adds ANSI colours.
std::string render_text(const Diagnostic& diagnostic, const SourceSet& sources, bool colour);

/// All diagnostics as a JSON array of objects: code, severity, file, line, column, end_line, end_column, message,
/// expected, found, help (absent when empty).
std::string render_json(const Diagnostics& diagnostics, const SourceSet& sources);

}  // namespace wale
