#pragma once

#include <string>
#include <string_view>

#include "schema/result.hpp"

namespace wale {

/// Replaces the content of a file, whole or not at all: a reader meanwhile, or after a crash, finds the old text or
/// the new one. Its permissions stay; a link stays a link, and what it leads to is replaced.
///
/// Error: W0505 where the file is missing, not a regular one, or not writable, or its folder is not writable.
Result<> replace_file(const std::string& path, std::string_view bytes);

}  // namespace wale
