#pragma once

#include <string>
#include <string_view>

#include "compiler/diagnostics/diagnostic.hpp"

namespace wale {

/// "error" or "warning".
std::string_view severity_name(Severity severity);

/// A diagnostic as text: code, message, place, the line with carets (`^` under the primary span, `-` under the others,
/// which may be in other lines and files), and the notes in the order cause, rule, proposal. `colour` adds ANSI
/// colours.
std::string render_text(const Diagnostic& diagnostic, const SourceSet& sources, bool colour);

/// All diagnostics as a JSON array of objects. Their fields are listed in schema/LANGUAGE.md, "Reading a diagnostic".
std::string render_json(const Diagnostics& diagnostics, const SourceSet& sources);

}  // namespace wale
