#include "compiler/diagnostics/told.hpp"

#include <utility>

#include "schema/expectation.hpp"

namespace wale {
namespace {

/// Whether a code is about a name that nothing declares, so that another name may have been meant. (A quantity of
/// another dimension may have been meant too, but that is no name for `nearest`.)
bool is_about_a_name(Code code) {
  constexpr unsigned first_of_quantities = 300, first_of_tools = 600;  // schema/include/wale/codes.def
  const auto number = static_cast<unsigned>(code);
  return number < first_of_quantities || number >= first_of_tools;
}

}  // namespace

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
              .expected = in_one_line(diagnostic.expected),
              .found = in_one_line(diagnostic.found)};
  if (error.mend.empty()) error.mend = "`wale explain " + std::string(code_name(error.code)) + "` says more";
  error = with_expectation(std::move(error));
  if (!is_about_a_name(diagnostic.code)) return error;
  for (const Fact& fact : diagnostic.facts)
    if (const auto* name = std::get_if<std::string>(&fact.value); name != nullptr && fact.name == "meant")
      error.nearest.push_back(*name);
  return error;
}

}  // namespace wale
