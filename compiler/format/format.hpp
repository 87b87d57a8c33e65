#pragma once

#include <optional>
#include <string>

#include "compiler/diagnostics/diagnostic.hpp"

namespace wale {

/// Lines are broken behind this column where they can be.
constexpr std::size_t format_columns = 100;

/// The file in Wale's one style. Comments, the order of everything and what the file means stay; white space, `;`, and
/// the spelling of `±` do not. Formatting twice is formatting once. None when the file has errors, which are reported.
std::optional<std::string> format(const SourceSet& sources, SourceId source, Diagnostics& diagnostics);

}  // namespace wale
