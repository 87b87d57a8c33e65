// A beat of the real-time thread does not allocate, lock or throw. This test program replaces the functions for that by
// its own, which count and call the originals.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <new>
#include <stdexcept>

#include "runtime/record/record_writer.hpp"
#include "runtime/stage/player.hpp"
#include "tests/runtime/failing_memory.hpp"
#include "tests/runtime/figures.hpp"
#include "tests/runtime/placed.hpp"
#include "tests/runtime/programs.hpp"
#include "tests/temporary_folder.hpp"
#include "wale/simulated.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define WALE_SANITIZED 1  // a sanitizer replaces the same functions
#else
#define WALE_SANITIZED 0
#endif

namespace {
thread_local long allocations = 0, locks = 0, throws = 0;

long deeds() { return allocations + locks + throws; }
}  // namespace

#if WALE_SANITIZED
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (!wale::failing_memory::take_one()) throw std::bad_alloc();
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  ++allocations;
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept { operator delete(memory); }
#else
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) {
  ++allocations;
  if (!wale::failing_memory::take_one()) return nullptr;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  ++allocations;
  return __libc_realloc(memory, size);
}
void free(void* memory) {
  if (memory) ++allocations;
  __libc_free(memory);
}
int pthread_mutex_lock(pthread_mutex_t* mutex) {
  ++locks;
  static const auto real = reinterpret_cast<int (*)(pthread_mutex_t*)>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  return real(mutex);
}
[[noreturn]] void __cxa_throw(void* thrown, void* type, void (*destroy)(void*)) {
  ++throws;
  static const auto real = reinterpret_cast<void (*)(void*, void*, void (*)(void*))>(dlsym(RTLD_NEXT, "__cxa_throw"));
  real(thrown, type, destroy);
  std::abort();
}
}
#endif

namespace wale::real_time_test {
namespace {

TEST(RealTime, AllocationsLocksAndExceptionsAreCounted) {
  const long before = allocations;
  { const std::vector<int> some(100); }
  EXPECT_EQ(allocations, before + 2);
  if (WALE_SANITIZED) GTEST_SKIP() << "a sanitizer replaces the functions that count locks and exceptions";
  std::mutex mutex;
  const long locked = locks, thrown = throws;
  { const std::lock_guard lock(mutex); }
  try {
    throw std::runtime_error("noticed");
  } catch (const std::runtime_error&) {
  }
  EXPECT_EQ(locks, locked + 1);
  EXPECT_EQ(throws, thrown + 1);
}

/// With everything that a beat may do: reading the clock, motor heat, a delayed actuator, patches that stay, and
/// patches that were moved.
TEST(RealTime, ABeatNeitherAllocatesNorLocksNorThrowsEvenWhenABankArrives) {
  DeviceProfile profile = sandpaper();
  profile.continuous_newton = 0.4;
  profile.heating_seconds = 0.2;
  profile.delay_x = profile.delay_y = 0.0015;
  profile.damping_known = true;
  for (const Program& program : {corduroy(1.934f), bead(500)}) {
    SimulatedJoystick joystick(profile, normal_hand(), Circular{0.075, 1, {0.03, 0}});  // in and out of the patch
    Exchange<PlacedPatches> patches;
    Record record;
    Player player(joystick, patches, record, 2000, 1, true);
    auto memory = std::make_shared<Memory>(program);
    const PatchSize size{.width = 0.01f, .height = 0.01f};
    PlacedPatch small = patch_of(spring(40), 1, {0, 0.03f}, size);
    Arrangement all;
    all.put(small);
    all.make_base();
    std::uint32_t revision = 0;
    long entered = 0, inside = 0;
    for (long period = 0; period < 2000; ++period) {
      if (period % 50 == 0) memory = std::make_shared<Memory>(program);
      if (period % 7 == 0) {
        all.put(patch_of(program, 0, {0, 0}, std::nullopt, memory));
        small.outline.position = {0.0001f * static_cast<float>(period % 500), 0.03f};
        all.put(small);
        patches.publish(all.hand_over(++revision));
      }
      const long before = deeds();
      player.serve({.period = period, .elapsed = period == 0 ? 0 : 1, .skipped = 0, .lateness = 0});
      ASSERT_EQ(deeds(), before) << period;
      entered += record.ticks[period].inside && period > 0 && !record.ticks[period - 1].inside;
      inside += record.ticks[period].inside;
    }
    EXPECT_GT(entered, 0);
    EXPECT_GT(inside, 500);
    EXPECT_GT(player.guards().heat, 0);
    EXPECT_TRUE(player.costs());
  }
}

TEST(RealTime, ABeatThatIsRecordedNeitherAllocatesNorLocksNorThrows) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.wrec";
  constexpr long beats = 3 * static_cast<long>(recording_format::ticks_per_chunk);
  {
    SimulatedJoystick joystick(sandpaper(), normal_hand(), Circular{0.075, 1, {0.03, 0}});
    const Program program = bead(500);
    Exchange<PlacedPatches> patches;
    patches.publish(placed(program));
    const auto begun = RecordWriter::begin(file, {.device = sandpaper(), .most_newton = 5}, false);
    RecordWriter& writer = **begun;
    Record record;
    Player player(joystick, patches, record, 100, 5, true, &writer);
    for (long period = 0; period < beats; ++period) {
      const long before = deeds();
      player.serve({.period = period, .elapsed = period == 0 ? 0 : 1, .skipped = 0, .lateness = 0});
      ASSERT_EQ(deeds(), before) << period;
    }
    EXPECT_FALSE(writer.ended_early());
  }
  const auto recording = Recording::open(file);
  ASSERT_TRUE(recording) << in_words(recording.error());
  EXPECT_EQ(recording->ticks(), static_cast<std::size_t>(beats));
}

}  // namespace
}  // namespace wale::real_time_test
