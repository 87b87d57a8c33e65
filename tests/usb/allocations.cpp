#include "tests/usb/allocations.hpp"

#include <cstdlib>
#include <new>

// These operators replace those of the whole test program, and count allocations. They are not inlined: otherwise the
// compiler sees malloc without free, or free without malloc, and warns.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++wale::test::allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }
