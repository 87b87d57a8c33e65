#pragma once

#include <optional>
#include <string>

#include "compiler/diagnostics/diagnostic.hpp"

namespace wale {

/// Lines are broken at this column if they can be.
constexpr std::size_t format_columns = 100;

/// The file in the standard style of Wale. Comments, order and meaning stay the same; white space, `;`
/// and the spelling of `±` may change. Formatting a formatted file changes nothing. Empty if the file has errors, which
/// are reported.
std::optional<std::string> format(const SourceSet& sources, SourceId source, Diagnostics& diagnostics);

}  // namespace wale
