#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "wale/result.hpp"

namespace wale {

/// Whether a shared library may pass on, and anybody change and use for any purpose, what has this licence; `id` as SPDX
/// spells it. Of several, `A OR B`, one must be such, and of `A AND B` all.
bool may_be_shared(std::string_view id);

/// The nearest licence of those, for a misspelt one; nothing if none is near.
std::optional<std::string> nearest_licence(std::string_view id);

/// The licence that the `wale.project` of a folder states for all files below, `licence "CC0-1.0"`; empty if it states
/// none or there is no such file. Errors: W0501 if the file cannot be read, W0801 for a line that is neither that nor
/// a comment, with its number.
Result<std::string> licence_of_library(const std::string& folder);

}  // namespace wale
