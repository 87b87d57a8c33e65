// A tick allocates nothing: every allocation of this test program is counted.

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <utility>

#include "tests/machine/random_program.hpp"
#include "tests/machine/running.hpp"
#include "wale/memory.hpp"

namespace {
thread_local long allocations = 0;
}

// Not inlined, since GCC would warn of a mismatch of malloc and delete.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size != 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace wale::real_time_test {
namespace {

static_assert(noexcept(tick(std::declval<Bank&>(), std::declval<const Hand&>())));
static_assert(noexcept(tick(std::declval<Bank&>(), std::declval<Memory&>(), std::declval<const Hand&>())));
static_assert(noexcept(std::declval<Memory&>().enter(std::declval<Bank&>(), std::declval<const Hand&>())));

TEST(RealTime, TickAllocatesNothing) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const long before = allocations;
    Bank bank(example::loaded(example::RandomProgram(seed).make()));
    const long loaded = allocations;
    ASSERT_GT(loaded, before) << "the counter counts";
    for (int i = 0; i < 1000; ++i) tick(bank, {{static_cast<float>(i) * 1e-4f, 0.01f}, {0.1f, 0}});
    ASSERT_EQ(allocations, loaded) << seed;
    Memory memory(bank.program());
    const long made = allocations;
    for (int i = 0; i < 1000; ++i) {
      const Hand hand{{static_cast<float>(i) * 1e-4f, 0.01f}, {0.1f, 0}};
      if (i % 100 == 0) memory.enter(bank, hand);
      tick(bank, memory, hand);
    }
    ASSERT_EQ(allocations, made) << seed;
  }
}

}  // namespace
}  // namespace wale::real_time_test
