#pragma once

#include <cstddef>
#include <string>

#include "wale/result.hpp"

namespace wale {

/// Opens a file for reading and returns its descriptor, which the caller closes. Only regular files are opened: a pipe,
/// a device, a socket or a folder is an error at once, and the call never waits. Error: W0501, with a sentence that
/// fits behind "cannot be read:"; W0107 for a path with a zero byte.
Result<int> open_regular_file(const std::string& path);

/// The bytes of a regular file of at most `largest` bytes; of a larger one none are read, and of one that grows no more
/// than these. Errors: as `open_regular_file`, and W0501 for a file that is larger.
Result<std::string> read_regular_file(const std::string& path, std::size_t largest);

}  // namespace wale
