#pragma once

#include <string>
#include <string_view>

#include "compiler/diagnostics/diagnostic.hpp"

namespace wale {

/// "error" or "warning".
std::string_view severity_name(Severity severity);

/// A diagnostic as people read it: code, message, place, the line with carets (`^` under the primary span, `-` under
/// the others, which may be on other lines and in other files), and the notes in the order cause, rule, proposal.
/// `colour` adds ANSI colours.
std::string render_text(const Diagnostic& diagnostic, const SourceSet& sources, bool colour);

/// All diagnostics as a JSON array of objects; schema/LANGUAGE.md, "Reading a diagnostic", lists their fields.
std::string render_json(const Diagnostics& diagnostics, const SourceSet& sources);

}  // namespace wale
