#include "tests/usb/allocations.hpp"

#include <cstdlib>
#include <new>

// These replace the whole test program's, to see who allocates. Not inlined, or the compiler, knowing malloc and free
// by their names, thinks that one of each pair is missing.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++wale::test::allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }
