#pragma once

#include <string>
#include <string_view>

#include "schema/result.hpp"

namespace wale {

/// Replaces the content of a file atomically: a concurrent reader, or one after a crash, finds either the old or the
/// new content. The permissions are kept. A symbolic link is kept, and the file that it points to is replaced.
///
/// Error: W0505 if the file is missing, not a regular file, or not writable, or if its folder is not writable.
Result<> replace_file(const std::string& path, std::string_view bytes);

}  // namespace wale
