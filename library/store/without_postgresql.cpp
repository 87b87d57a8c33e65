#include "library/store/stores.hpp"

namespace wale {

Result<std::unique_ptr<LibraryStore>> open_shared_store(const std::string& address, bool, const std::string&) {
  return Error{.code = Code::missing_library,
               .sentence = "this Wale was built without PostgreSQL's library, which reaches a shared index",
               .mend = "install libpq-dev and build Wale again",
               .place = {.name = without_password(address)}};
}

}  // namespace wale
