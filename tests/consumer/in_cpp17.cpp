#include <wale.h>

#include "expect.hpp"

static_assert(__cplusplus < 202002L, "Wale::c asks for no standard of C++");

int main() {
  WaleLibrary* library = nullptr;
  WaleProgram* program = nullptr;
  EXPECT(wale_library_create(nullptr, &library, nullptr) == 0);
  EXPECT(wale_library_find(library, WALE_TEXT("corduroy"), nullptr, &program, nullptr) == 0);
  wale_program_free(program);
  wale_library_free(library);
}
