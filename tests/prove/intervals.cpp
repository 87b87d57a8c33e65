// The column of ranges in the instruction table against its column of meanings, value by value, and by hand where a
// range must be tight.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "compiler/prove/interval.hpp"
#include "runtime/machine/floating_point_mode.hpp"
#include "runtime/machine/meaning.hpp"
#include "tests/prove/values.hpp"

namespace wale::intervals_test {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float least_normal = std::numeric_limits<float>::min();

[[gnu::noinline]] float evaluate(Operation operation, float a, float b, float c) {
  // clang-format off
  switch (operation) {
#define INSTRUCTION(number, name, fields, results, cost, meaning, range, derivative) \
  case Operation::name: return Meaning<Operation::name>::of(a, b, c);
#define SPECIAL(number, name, fields, results, cost) \
  case Operation::name: break;
#include "wale/instruction.def"
  }
  // clang-format on
  return 0;
}

std::vector<Operation> plain_operations() {
  return {
  // clang-format off
#define INSTRUCTION(number, name, fields, results, cost, meaning, range, derivative) Operation::name,
#include "wale/instruction.def"
      // clang-format on
  };
}

TEST(Intervals, ContainEveryResultOfTheMachine) {
  prove_test::Values values(1995);
  for (const Operation operation : plain_operations()) {
    for (int round = 0; round < 60000; ++round) {
      const Interval a = values.interval(), b = values.interval(), c = values.interval();
      const Interval range = range_of(operation, a, b, c);
      ASSERT_LE(range.low, range.high);
      for (int i = 0; i < 12; ++i) {
        const float x = values.of(a), y = values.of(b), z = values.of(c);
        const float result = [&] {
          const FloatingPointMode mode;
          return evaluate(operation, x, y, z);
        }();
        ASSERT_TRUE(range.contains(result))
            << facts(operation).name << "(" << x << ", " << y << ", " << z << ") = " << result << " is not in "
            << range.low << " .. " << range.high << (range.maybe_nan ? " or nan" : "") << "; operands " << a.low
            << " .. " << a.high << (a.maybe_nan ? " or nan, " : ", ") << b.low << " .. " << b.high
            << (b.maybe_nan ? " or nan, " : ", ") << c.low << " .. " << c.high << (c.maybe_nan ? " or nan" : "");
      }
    }
  }
}

// Functions that are only nearly monotonic, in intervals a few floats wide around their extrema and elsewhere.
TEST(Intervals, ContainTheMachinesFunctionsInNarrowIntervals) {
  std::mt19937 random(7);
  for (const Operation operation : {Operation::sine, Operation::cosine, Operation::exp2, Operation::log2,
                                    Operation::normal, Operation::square_root, Operation::floor}) {
    for (int round = 0; round < 200000; ++round) {
      const float size = std::exp2(std::uniform_real_distribution<float>(-12, 12)(random));
      float low = random() % 2 == 0 ? size : -size;
      if (random() % 4 == 0) low = static_cast<float>(static_cast<int>(random() % 400) - 200) * 1.5707963f;
      const float step = std::max(std::abs(low), 1e-3f) * 0x1p-23f;
      const float high = low + step * static_cast<float>(random() % 1000);
      const Interval range = range_of(operation, Interval::between(low, high), {}, {});
      for (int i = 0; i < 8; ++i) {
        const float x = std::clamp(low + (high - low) * static_cast<float>(i) / 7, low, high);
        const float result = evaluate(operation, x, 0, 0);
        ASSERT_TRUE(range.contains(result)) << facts(operation).name << " of " << x << " is " << result;
      }
    }
  }
}

// Ranges by hand. Where the machine rounds to nearest, their ends are exact.
TEST(Intervals, AreTightWhereTheMachineRoundsToNearest) {
  const auto between = [](float low, float high) { return Interval::between(low, high); };
  using namespace ranges;
  EXPECT_EQ(sum(between(-1, 2), between(10, 20)), between(9, 22));
  EXPECT_EQ(difference(between(-1, 2), between(10, 20)), between(-21, -8));
  EXPECT_EQ(product(between(-3, 2), between(-5, 7)), between(-21, 15));
  EXPECT_EQ(quotient(between(1, 2), between(-4, -2)), between(-1, -0.25f));
  EXPECT_EQ(square(between(-3, 2)), between(0, 9));
  EXPECT_EQ(root(between(4, 9)), between(2, 3));
  EXPECT_EQ(whole(between(-1.5f, 2.5f)), between(-2, 2));
  EXPECT_EQ(limit(between(-7, 1), between(2, 3)), between(-3, 1));
  EXPECT_EQ(limit(between(5, 7), between(2, 3)), between(2, 3));
  EXPECT_EQ(sine(between(-100, 100)), between(-1, 1));
  EXPECT_EQ(cosine(between(-0.5f, 0.5f)).high, 1);
  EXPECT_NEAR(cosine(between(-0.5f, 0.5f)).low, std::cos(0.5), 4e-7);
  EXPECT_NEAR(sine(between(0.25f, 0.5f)).low, std::sin(0.25), 4e-7);
  EXPECT_NEAR(sine(between(0.25f, 0.5f)).high, std::sin(0.5), 4e-7);
  EXPECT_NEAR(arctangent(between(1, 2), between(-1, 1)).low, std::atan2(1, 1), 1e-6);
  EXPECT_NEAR(arctangent(between(1, 2), between(-1, 1)).high, std::atan2(1, -1), 2e-6);
}

TEST(Intervals, NotANumberFollowsTheMachinesComparisons) {
  using namespace ranges;
  const Interval a{1, 2, false}, b{-5, 5, false}, a_nan{1, 2, true}, b_nan{-5, 5, true};
  EXPECT_EQ(least(a, b), (Interval{-5, 2, false}));
  EXPECT_EQ(least(a, b_nan), (Interval{-5, 2, false})) << "not-a-number in b gives a";
  EXPECT_EQ(least({3, 9, false}, b_nan), (Interval{-5, 9, false}));
  EXPECT_EQ(least(a_nan, b), (Interval{-5, 2, true}));
  EXPECT_EQ(greatest({-9, -7, false}, b_nan), (Interval{-9, 5, false}));
  EXPECT_EQ(limit(a_nan, {3, 3, false}), (Interval{0, 2, false}));
  EXPECT_EQ(limit(a, {3, 3, true}), (Interval{0, 2, false}));
  EXPECT_EQ(choice({0, 0, true}, a, {8, 9, false}), (Interval{1, 9, false}));
  EXPECT_EQ(choice({1, 2, true}, a, {8, 9, false}), a) << "not-a-number is not zero";
  EXPECT_EQ(order(a, {3, 4, true}), (Interval{0, 1, false}));
  EXPECT_EQ(order({4, 5, true}, a), (Interval{0, 0, false}));
}

TEST(Intervals, FlagResultsThatMayBeNotANumber) {
  using namespace ranges;
  const Interval all = Interval::everything(false), zero{0, 0, false}, one{1, 1, false}, infinite{inf, inf, false};
  EXPECT_TRUE(sum(all, all).maybe_nan);
  EXPECT_FALSE(sum(infinite, infinite).maybe_nan);
  EXPECT_TRUE(product(zero, all).maybe_nan);
  EXPECT_FALSE(product(one, all).maybe_nan);
  EXPECT_EQ(quotient(one, {-1e-40f, 0, false}), Interval::everything(true)) << "a subnormal is zero";
  EXPECT_EQ(quotient(one, {0, 5, false}), Interval::everything(true));
  EXPECT_TRUE(quotient(infinite, infinite).maybe_nan);
  EXPECT_TRUE(root({-1, 4, false}).maybe_nan);
  EXPECT_TRUE(log2({-1, 4, false}).maybe_nan);
  EXPECT_EQ(log2({0, 4, false}).low, -inf);
  EXPECT_TRUE(sine(all).maybe_nan);
  EXPECT_FALSE(random().maybe_nan);
}

// Underflow: the exact result and the machine's zero are both inside.
TEST(Intervals, ReachZeroWhereResultsMayBeFlushed) {
  using namespace ranges;
  EXPECT_EQ(product({1e-30f, 1, false}, {1e-30f, 1, false}), (Interval{0, 1, false}));
  EXPECT_EQ(product({-1, -1e-30f, false}, {1e-30f, 1, false}), (Interval{-1, 0, false}));
  // (1 - 2^-24) times the smallest normal number would round to that number, but the machine flushes it to zero.
  const Interval near = product({least_normal, 1, false}, {1 - 0x1p-24f, 1, false});
  EXPECT_EQ(near.low, 0);
  EXPECT_TRUE(Interval::of(1e-40f).contains(0));
  EXPECT_TRUE(Interval::of(1e-40f).contains(1e-40f));
}

TEST(Intervals, AreShownAsTheyAreRead) {
  EXPECT_EQ(shown({-1, 2.5f, false}), "-1 .. 2.5");
  EXPECT_EQ(shown({3, 3, false}), "3");
  EXPECT_EQ(shown({-0.0f, inf, true}), "0 .. inf or nan");
}

}  // namespace
}  // namespace wale::intervals_test
