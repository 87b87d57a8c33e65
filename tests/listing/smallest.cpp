// Bounds from below on results: no result of operands within their bounds is nearer to zero, and the common cases are
// not called subnormal.

#include "compiler/cpp/smallest.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace wale::listing::smallest_test {
namespace {

constexpr float least_normal = 0x1p-126f;

/// A normal number or zero, often near the least normal number or near `other`.
float operand_from(std::mt19937& random, float other) {
  const float sign = random() % 2 == 0 ? 1.0f : -1.0f;
  const float fraction = 1.0f + static_cast<float>(random() % 8388608) * 0x1p-23f;
  switch (random() % 6) {
    case 0: return 0;
    case 1: return sign * std::ldexp(fraction, -126 + static_cast<int>(random() % 4));
    case 2: return sign * std::max(least_normal, std::nextafter(std::abs(other), random() % 2 == 0 ? 0.0f : 1.0f));
    case 3: return sign * std::ldexp(1.0f, static_cast<int>(random() % 200) - 100);
    default: return sign * std::ldexp(fraction, static_cast<int>(random() % 240) - 120);
  }
}

/// A bound that holds for the value, often its own size.
Smallest bound_of(float value, std::mt19937& random) {
  if (value == 0) return {.size = random() % 2 == 0 ? 1.0f : least_normal, .maybe_zero = true};
  const float size = random() % 2 == 0 ? std::abs(value) : std::max(least_normal, std::abs(value) * 0x1p-3f);
  return {.size = size, .maybe_zero = random() % 2 == 0};
}

double exactly(Operation operation, double a, double b) {
  switch (operation) {
    case Operation::add: return a + b;  // a double's rounding does not take it across a bound, which is a float
    case Operation::subtract: return a - b;
    case Operation::multiply: return a * b;
    default: return a / b;
  }
}

TEST(Smallest, NoResultIsNearerToZero) {
  std::mt19937 random(7);
  float before = 1;
  long tight = 0;
  for (int i = 0; i < 2'000'000; ++i) {
    const float a = operand_from(random, before), b = operand_from(random, a);
    before = b;
    for (const Operation operation : {Operation::add, Operation::subtract, Operation::multiply, Operation::divide}) {
      if (operation == Operation::divide && b == 0) continue;
      const Interval of_b = random() % 2 == 0 ? Interval::of(b) : Interval::between(-2 * std::abs(b), 3 * std::abs(b));
      const float bound =
          smallest_result(operation, {bound_of(a, random), Interval::of(a)}, {bound_of(b, random), of_b}, {});
      const double result = std::abs(exactly(operation, a, b));
      if (result == 0) continue;
      ASSERT_GE(result, double{bound}) << std::hexfloat << a << " and " << b;
      tight += result < 4 * double{bound};
    }
  }
  EXPECT_GT(tight, 10000);
}

TEST(Smallest, TellsWhereAResultMayBeSubnormal) {
  const SizedOperand any{{}, Interval::between(-1, 1)}, half{Smallest::of(0.5f), Interval::of(0.5f)},
      two{Smallest::of(2.0f), Interval::of(2.0f)};
  EXPECT_LT(smallest_result(Operation::multiply, any, any, {}), least_normal);
  EXPECT_LT(smallest_result(Operation::multiply, any, half, {}), least_normal);
  EXPECT_GE(smallest_result(Operation::multiply, any, two, {}), least_normal);
  EXPECT_GE(smallest_result(Operation::divide, any, half, {}), least_normal);
  EXPECT_LT(smallest_result(Operation::divide, any, two, {}), least_normal);
  EXPECT_LT(smallest_result(Operation::add, any, any, {}), least_normal);
  EXPECT_GE(smallest_result(Operation::subtract, any, half, {}), least_normal);
  const SizedOperand difference{{.size = smallest_result(Operation::subtract, any, half, {})},
                                Interval::between(-2, 2)};
  EXPECT_GE(smallest_result(Operation::multiply, difference, difference, {}), least_normal);
  EXPECT_FALSE(Smallest{}.within(Interval::between(0.25f, 3)).maybe_zero);
  EXPECT_EQ(Smallest{}.within(Interval::between(-3, -0.25f)).size, 0.25f);
}

}  // namespace
}  // namespace wale::listing::smallest_test
