#include "compiler/diagnostics/told.hpp"

namespace wale {

Error told(const Diagnostic& diagnostic, const SourceSet& sources) {
  const Span& span = diagnostic.span;
  const LineColumn at = sources.place(span);
  Error error{.code = diagnostic.code,
              .sentence = diagnostic.message,
              .mend = diagnostic.help,
              .place = {.name = sources[span.source].name,
                        .number = at.line,
                        .text = std::string(sources.line(span)),
                        .column = at.column,
                        .length = span.end - span.begin},
              .expected = diagnostic.expected,
              .found = diagnostic.found};
  if (error.mend.empty()) error.mend = "`wale explain " + std::string(code_name(error.code)) + "` says more";
  for (const Fact& fact : diagnostic.facts)
    if (const auto* name = std::get_if<std::string>(&fact.value); name != nullptr && fact.name == "meant")
      error.nearest.push_back(*name);
  return error;
}

}  // namespace wale
