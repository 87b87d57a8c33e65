// The C interface from C++17, which Wale's own headers are too new for.
#include <wale.h>

#include <memory>
#include <string_view>
#include <type_traits>

#include "tests/c/check.h"
#include "tests/c/readme.h"

namespace {

template <auto release>
struct Released {
  template <class Handle>
  void operator()(Handle* handle) const {
    release(handle);
  }
};
using Library = std::unique_ptr<WaleLibrary, Released<wale_library_free>>;
using Error = std::unique_ptr<WaleError, Released<wale_error_free>>;

void handles_fit_smart_pointers() {
  WaleLibrary* made = nullptr;
  CHECK(wale_library_create(nullptr, &made, nullptr) == 0);
  const Library library(made);
  WaleProgram* program = nullptr;
  WaleError* wrong = nullptr;
  const std::string_view name = "corduory, and more";
  CHECK(wale_library_find(library.get(), {name.data(), 8}, nullptr, &program, &wrong) == WALE_CODE_unknown_name);
  const Error error(wrong);
  CHECK(program == nullptr);
  CHECK(is_text(wale_error_nearest(error.get(), 0), "corduroy"));
}

static_assert(std::is_standard_layout_v<WaleNow> && std::is_trivial_v<WaleNow>);

}  // namespace

int main() {
  readme_task();
  handles_fit_smart_pointers();
  CHECK(wale_handles() == 0);
  return failures != 0;
}
