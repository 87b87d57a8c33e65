#pragma once

#include <memory>
#include <string>

#include "library/store/library_store.hpp"

namespace wale {

/// The two kinds of stores; `LibraryStore::open` says what they do. Each has a file that takes its place, and says so, in a
/// Wale that was built without its database.
Result<std::unique_ptr<LibraryStore>> open_sqlite_store(const std::string& path, bool makes);
Result<std::unique_ptr<LibraryStore>> open_shared_store(const std::string& address, bool makes, const std::string& cache);

}  // namespace wale
