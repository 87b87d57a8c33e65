#include "compiler/command/memory.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace wale::command {

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int largest_kept = 32 << 20, kept = 128 << 20;  // bytes: of one block, and altogether
  mallopt(M_MMAP_THRESHOLD, largest_kept);
  mallopt(M_TRIM_THRESHOLD, kept);
#endif
}

}  // namespace wale::command
