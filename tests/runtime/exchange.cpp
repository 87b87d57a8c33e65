#include "runtime/stage/exchange.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>
#include <vector>

#include "runtime/stage/latest.hpp"

namespace wale::exchange_test {
namespace {

/// Counts the live instances, and those that were destroyed on the real-time thread.
struct Counted {
  static inline std::atomic<int> alive = 0;
  static inline thread_local bool may_free = true;
  static inline std::atomic<int> freed_elsewhere = 0;

  explicit Counted(int n) : numbers(64, n) { ++alive; }
  Counted(Counted&& other) noexcept : numbers(std::move(other.numbers)) { ++alive; }
  ~Counted() {
    --alive;
    if (!may_free) ++freed_elsewhere;
  }
  std::vector<int> numbers;
};

TEST(Exchange, HoldsNothingBeforeTheFirst) {
  Exchange<int> exchange;
  EXPECT_FALSE(exchange.take());
  EXPECT_EQ(exchange.held(), nullptr);
}

TEST(Exchange, TheNewestIsTakenOnce) {
  Exchange<int> exchange;
  exchange.publish(1);
  exchange.publish(2);
  EXPECT_TRUE(exchange.take());
  EXPECT_EQ(*exchange.held(), 2);
  EXPECT_FALSE(exchange.take());
  EXPECT_EQ(*exchange.held(), 2);
}

TEST(Exchange, FreesEachValueOnceOnTheControlSide) {
  {
    Exchange<Counted> exchange;
    exchange.publish(Counted(1));
    exchange.publish(Counted(2));
    EXPECT_EQ(Counted::alive, 1);
    exchange.take();
    exchange.publish(Counted(3));
    exchange.take();
    EXPECT_EQ(Counted::alive, 2);  // 2 was given back and waits to be collected
    exchange.collect();
    EXPECT_EQ(Counted::alive, 1);
    exchange.publish(Counted(4));
  }
  EXPECT_EQ(Counted::alive, 0);
}

TEST(Exchange, UnderStressValuesArriveWholeInOrderAndAreFreedByTheControlThread) {
  constexpr int last = 20000;
  {
    Exchange<Counted> exchange;
    std::thread real_time([&] {
      Counted::may_free = false;
      for (int newest = 0; newest < last;) {
        if (!exchange.take()) continue;
        const std::vector<int>& numbers = exchange.held()->numbers;
        EXPECT_GT(numbers.front(), newest);
        for (const int n : numbers) EXPECT_EQ(n, numbers.front());
        newest = numbers.front();
        for (int& n : exchange.held()->numbers) n += 0;  // the holder may write
      }
    });
    for (int n = 1; n <= last; ++n) exchange.publish(Counted(n));
    real_time.join();
  }
  EXPECT_EQ(Counted::freed_elsewhere, 0);
  EXPECT_EQ(Counted::alive, 0);
}

TEST(Latest, IsWholeAndNeverOlderThanOneSeenBefore) {
  using Value = std::array<int, 9>;
  Latest<Value> latest;
  std::atomic<bool> done = false;
  std::thread writer([&] {
    for (int n = 1; n <= 50000; ++n) {
      Value value;
      value.fill(n);
      latest.store(value);
    }
    done = true;
  });
  int newest = 0;
  while (!done) {
    const Value value = latest.load();
    for (const int n : value) ASSERT_EQ(n, value[0]);
    ASSERT_GE(value[0], newest);
    newest = value[0];
  }
  writer.join();
  EXPECT_EQ(latest.load()[8], 50000);
}

}  // namespace
}  // namespace wale::exchange_test
