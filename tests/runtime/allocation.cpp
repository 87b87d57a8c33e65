#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "runtime/stage/player.hpp"
#include "tests/runtime/figures.hpp"
#include "tests/runtime/programs.hpp"
#include "wale/simulated.hpp"

namespace {
thread_local long allocations = 0, releases = 0;
}  // namespace

// These replace the whole test program's, to see who allocates. Not inlined, or the compiler, knowing malloc and free
// by their names, thinks that one of each pair is missing.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  ++releases;
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }

namespace wale {
namespace {

TEST(Allocation, IsNoticed) {
  const long before = allocations, released = releases;
  { const std::vector<int> some(100); }
  EXPECT_EQ(allocations, before + 1);
  EXPECT_EQ(releases, released + 1);
}

TEST(Allocation, ABeatNeitherAllocatesNorFreesEvenWhenABankArrives) {
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Circular{0.04, 1});
  Exchange<PlacedPatch> patches;
  Record record;
  Player player(joystick, patches, record, 2000);
  const Program program = corduroy(1.934f);
  for (long period = 0; period < 2000; ++period) {
    if (period % 7 == 0) patches.publish({Bank(program), glm::vec2(0)});
    const long before = allocations + releases;
    player.serve({.period = period, .elapsed = period == 0 ? 0 : 1, .skipped = 0, .lateness = 0});
    ASSERT_EQ(allocations + releases, before) << period;
  }
}

}  // namespace
}  // namespace wale
