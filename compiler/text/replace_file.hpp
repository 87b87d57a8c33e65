#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace wale {

/// Replaces the content of a file, whole or not at all: a reader meanwhile, or after a crash, finds the old text or
/// the new one. Its permissions stay; a link stays a link, and what it leads to is replaced.
///
/// The result says why it could not be: the file is missing, not a regular one, not writable, or its folder is not.
std::optional<std::string> replace_file(const std::string& path, std::string_view bytes);

}  // namespace wale
