#include "library/store/stores.hpp"

namespace wale {

Result<std::unique_ptr<LibraryStore>> open_sqlite_store(const std::string& path, bool) {
  return Error{.code = Code::missing_library,
               .sentence = "this Wale was built without SQLite, which keeps an index",
               .mend = "install libsqlite3-dev and build Wale again",
               .place = {.name = path}};
}

}  // namespace wale
