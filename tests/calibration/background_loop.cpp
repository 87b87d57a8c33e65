// The thread beside a run: it works until the run is over, and what it throws ends the run with its reason.

#include "calibration/feel/background_loop.hpp"

#include <gtest/gtest.h>
#include <pthread.h>
#include <signal.h>

#include <atomic>
#include <future>
#include <stdexcept>
#include <string>
#include <utility>

namespace wale {
namespace {

TEST(BackgroundLoop, WorksUntilItIsFinishedAndNoLonger) {
  std::atomic<int> steps = 0;
  std::promise<void> third;
  BackgroundLoop loop(
      [&] {
        if (++steps == 3) third.set_value();
      },
      [] { FAIL() << "nothing failed"; });
  third.get_future().wait();
  loop.finish();
  const int at_the_end = steps;
  EXPECT_GE(at_the_end, 3);
  loop.finish();
  EXPECT_EQ(steps, at_the_end);
}

TEST(BackgroundLoop, HasAStackToCompileOnAndOneForHandlersOfSignals) {
  std::promise<void> measured;
  bool is_first = true;
  std::size_t bytes = 0;
  stack_t handlers{};
  BackgroundLoop loop(
      [&] {
        if (!std::exchange(is_first, false)) return;
        pthread_attr_t attributes;
        void* lowest = nullptr;
        pthread_getattr_np(pthread_self(), &attributes);
        pthread_attr_getstack(&attributes, &lowest, &bytes);
        pthread_attr_destroy(&attributes);
        sigaltstack(nullptr, &handlers);
        measured.set_value();
      },
      [] { FAIL() << "nothing failed"; });
  measured.get_future().wait();
  loop.finish();
  EXPECT_GE(bytes, command::deep_stack);
  EXPECT_EQ(handlers.ss_flags & SS_DISABLE, 0);
  EXPECT_GE(handlers.ss_size, std::size_t{32} * 1024);
}

TEST(BackgroundLoop, WhatItThrowsAsksForTheEndOnceAndIsThrownByFinish) {
  std::atomic<int> steps = 0, failures = 0;
  std::promise<void> asked_to_end;
  BackgroundLoop loop(
      [&] {
        if (++steps == 3) throw std::runtime_error("no more files can be watched");
      },
      [&] {
        ++failures;
        asked_to_end.set_value();
      });
  asked_to_end.get_future().wait();  // before `finish`, so a run that waits for nothing else ends
  std::string thrown;
  try {
    loop.finish();
  } catch (const std::runtime_error& error) {
    thrown = error.what();
  }
  EXPECT_EQ(thrown, "no more files can be watched");
  EXPECT_EQ(steps, 3);
  EXPECT_EQ(failures, 1);
  EXPECT_NO_THROW(loop.finish());
}

TEST(BackgroundLoop, AFailureThatNobodyAsksForEndsNothing) {
  std::promise<void> failed;
  {
    BackgroundLoop loop([]() { throw 7; }, [&] { failed.set_value(); });
    failed.get_future().wait();
  }
}

}  // namespace
}  // namespace wale
