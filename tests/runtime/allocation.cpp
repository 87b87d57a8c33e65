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

namespace wale::allocation_test {
namespace {

TEST(Allocation, IsNoticed) {
  const long before = allocations, released = releases;
  { const std::vector<int> some(100); }
  EXPECT_EQ(allocations, before + 1);
  EXPECT_EQ(releases, released + 1);
}

TEST(Allocation, ABeatNeitherAllocatesNorFreesEvenWhenABankArrives) {
  for (const Program& program : {corduroy(1.934f), bead(500)}) {
    SimulatedJoystick joystick(sandpaper(), normal_hand(), Circular{0.075, 1, {0.03, 0}});  // in and out of the patch
    Exchange<PlacedPatches> patches;
    Record record;
    Player player(joystick, patches, record, 2000);
    auto memory = std::make_shared<Memory>(program);
    long entered = 0, inside = 0;
    for (long period = 0; period < 2000; ++period) {
      if (period % 50 == 0) memory = std::make_shared<Memory>(program);
      if (period % 7 == 0) patches.publish(PlacedPatches({Bank(program), glm::vec2(0), memory}));
      const long before = allocations + releases;
      player.serve({.period = period, .elapsed = period == 0 ? 0 : 1, .skipped = 0, .lateness = 0});
      ASSERT_EQ(allocations + releases, before) << period;
      entered += record.ticks[period].inside && period > 0 && !record.ticks[period - 1].inside;
      inside += record.ticks[period].inside;
    }
    EXPECT_GT(entered, 0);
    EXPECT_GT(inside, 500);
  }
}

}  // namespace
}  // namespace wale::allocation_test
