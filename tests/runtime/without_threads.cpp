// Runs for which the system gives no thread.
#include <dlfcn.h>
#include <gtest/gtest.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <thread>

#include "tests/runtime/figures.hpp"
#include "tests/runtime/programs.hpp"
#include "wale/loop.hpp"
#include "wale/simulated.hpp"
#include "wale/stage.hpp"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they replace this function themselves

namespace {
std::atomic<int> threads_given = -1;  // so many before one is refused; below 0: all
}

/// The system's function, which refuses a thread when the test wants it.
extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*begin)(void*), void* data) {
  if (threads_given >= 0 && threads_given-- == 0) return EAGAIN;
  using Function = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "pthread_create"));
  return real(thread, attributes, begin, data);
}

namespace wale::without_threads_test {
namespace {

TEST(WithoutThreads, ARunIsRefusedOrItsEndTellsWhy) {
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Lateral{0.04, 1});
  Stage stage(joystick);
  ASSERT_TRUE(stage.add(push(1)));
  for (const int given : {0, 1}) {  // for banks; for the ticks
    threads_given = given;
    EXPECT_EQ(stage.run({.seconds = 1}).error().code, Code::short_of_resources) << given;
    EXPECT_FALSE(stage.is_running()) << given;
  }
  for (const int given : {0, 1}) {  // for banks; for the run
    threads_given = given;
    EXPECT_EQ(stage.start().error().code, Code::short_of_resources) << given;
    EXPECT_EQ(stage.stop().error().code, Code::wrong_moment) << given;
  }
  threads_given = 2;  // none for the ticks, which the run itself asks for
  ASSERT_TRUE(stage.start());
  for (int i = 0; i < 20000 && stage.is_running(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_FALSE(stage.is_running());
  EXPECT_EQ(stage.start().error().code, Code::wrong_moment) << "its error was not asked for";
  EXPECT_EQ(stage.stop().error().code, Code::short_of_resources);
  for (const int given : {0, 1}) {  // for banks; for changes
    threads_given = given;
    EXPECT_EQ(Loop::begin(stage).error().code, Code::short_of_resources) << given;
  }
  ASSERT_TRUE(stage.start()) << "and it can run again";
  const auto stopped = stage.stop();
  EXPECT_TRUE(stopped);
}

TEST(WithoutThreads, AStageMayBeDestroyedAfterItsRunFailed) {
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Lateral{0.04, 1});
  Stage stage(joystick);
  ASSERT_TRUE(stage.add(push(1)));
  threads_given = 2;
  ASSERT_TRUE(stage.start());
}

}  // namespace
}  // namespace wale::without_threads_test

#endif
