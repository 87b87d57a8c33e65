#pragma once

#include <string>
#include <utility>
#include <vector>

#include "library/store/library_store.hpp"

namespace wale {

/// The entries of a file, and what they rest on.
struct ReadFile {
  std::vector<Entry> entries;
  std::vector<std::pair<std::string, std::string>> rests_on;  ///< paths, the file's first, and the hashes of their bytes
  bool uses_names = false;  ///< other files of the library may change what it means
};

/// Reads one file. One that cannot be read is an entry with its trouble. Thread-safe.
ReadFile read_library_file(const LibraryFile& file, const FileRequest& request);

}  // namespace wale
