// The machine's float functions against the C library in double, over many arguments.

#include "runtime/machine/arithmetic.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "runtime/machine/floating_point_mode.hpp"

namespace wale::arithmetic_test {
namespace {

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Evenly spaced, log-spaced to both signs, and random arguments in low .. high.
std::vector<float> arguments(float low, float high) {
  std::vector<float> all = {low, high, 0.0f, -0.0f, 1.0f, -1.0f};
  for (int i = 0; i <= 1000000; ++i) all.push_back(low + (high - low) * static_cast<float>(i) * 1e-6f);
  for (float a = 1e-30f; a < high; a *= 1.0003f) {
    all.push_back(a);
    all.push_back(-a);
  }
  std::mt19937 random(7);
  std::uniform_real_distribution<float> anywhere(low, high);
  for (int i = 0; i < 1000000; ++i) all.push_back(anywhere(random));
  std::erase_if(all, [&](float a) { return !(a >= low && a <= high); });
  return all;
}

/// The largest `error(f(a), truth(a))` over the arguments a in low .. high.
double worst(float low, float high, float (*f)(float), double (*truth)(double),
             const std::function<double(double, double)>& error) {
  const FloatingPointMode mode;
  double most = 0;
  float at = 0;
  for (const float a : arguments(low, high)) {
    const double e = error(f(a), truth(a));
    if (!(e <= most)) most = e, at = a;
  }
  ::testing::Test::RecordProperty("worst", std::to_string(most) + " at " + std::to_string(at));
  std::printf("    worst error %.3g at %.9g\n", most, at);
  return most;
}

double absolute_error(double value, double truth) { return std::abs(value - truth); }
double relative_error(double value, double truth) { return std::abs(value - truth) / std::abs(truth); }

TEST(Arithmetic, SineAndCosine) {
  const auto sine = static_cast<double (*)(double)>(std::sin);
  const auto cosine = static_cast<double (*)(double)>(std::cos);
  EXPECT_LT(worst(-1e4f, 1e4f, sine_of, sine, absolute_error), 1.5e-7);
  EXPECT_LT(worst(-1e4f, 1e4f, cosine_of, cosine, absolute_error), 1.5e-7);
  EXPECT_LT(worst(-10.0f, 10.0f, sine_of, sine, absolute_error), 1.5e-7);
  EXPECT_LT(worst(-10.0f, 10.0f, cosine_of, cosine, absolute_error), 1.5e-7);
  EXPECT_EQ(sine_of(0.0f), 0.0f);
  EXPECT_EQ(cosine_of(0.0f), 1.0f);
}

TEST(Arithmetic, SineAndCosineBeyondTheirRangeStayBounded) {
  for (float a = 1e4f; a < inf; a *= 1.001f) {
    for (const float b : {a, -a}) {
      ASSERT_LE(std::abs(sine_of(b)), 1.0f) << b;
      ASSERT_LE(std::abs(cosine_of(b)), 1.0f) << b;
    }
  }
  for (const float a : {inf, -inf, nan}) {
    EXPECT_TRUE(std::isnan(sine_of(a)));
    EXPECT_TRUE(std::isnan(cosine_of(a)));
  }
}

TEST(Arithmetic, Exp2) {
  const auto exp2 = static_cast<double (*)(double)>(std::exp2);
  EXPECT_LT(worst(-126.0f, 127.99999f, exp2_of, exp2, relative_error), 2e-7);
  EXPECT_LT(worst(-1.0f, 1.0f, exp2_of, exp2, relative_error), 2e-7);
  for (int n = -126; n < 128; ++n) EXPECT_EQ(exp2_of(static_cast<float>(n)), std::ldexp(1.0f, n));
  EXPECT_EQ(exp2_of(128.0f), inf);
  EXPECT_EQ(exp2_of(1e30f), inf);
  EXPECT_EQ(exp2_of(inf), inf);
  EXPECT_EQ(exp2_of(-126.001f), 0.0f);
  EXPECT_EQ(exp2_of(-1e30f), 0.0f);
  EXPECT_EQ(exp2_of(-inf), 0.0f);
  EXPECT_TRUE(std::isnan(exp2_of(nan)));
}

TEST(Arithmetic, Log2) {
  const auto log2 = static_cast<double (*)(double)>(std::log2);
  EXPECT_LT(worst(1.17549435e-38f, 1e-20f, log2_of, log2, relative_error), 2e-7);
  EXPECT_LT(worst(1e-20f, 1.0f, log2_of, log2, relative_error), 2e-7);
  EXPECT_LT(worst(0.5f, 2.0f, log2_of, log2, relative_error), 2e-7);
  EXPECT_LT(worst(1.0f, 3.4e38f, log2_of, log2, relative_error), 2e-7);
  for (int n = -126; n < 128; ++n) EXPECT_EQ(log2_of(std::ldexp(1.0f, n)), static_cast<float>(n));
  EXPECT_EQ(log2_of(0.0f), -inf);
  EXPECT_EQ(log2_of(-0.0f), -inf);
  EXPECT_EQ(log2_of(1e-40f), -inf);
  EXPECT_EQ(log2_of(inf), inf);
  EXPECT_TRUE(std::isnan(log2_of(-1.0f)));
  EXPECT_TRUE(std::isnan(log2_of(-inf)));
  EXPECT_TRUE(std::isnan(log2_of(nan)));
}

TEST(Arithmetic, Normal) {
  const auto normal = [](double a) { return 0.5 * std::erfc(-a / std::sqrt(2.0)); };
  EXPECT_LT(worst(-20.0f, 20.0f, normal_of, normal, absolute_error), 2e-7);
  EXPECT_LT(worst(-1.0f, 1.0f, normal_of, normal, absolute_error), 2e-7);
  EXPECT_EQ(normal_of(0.0f), 0.5f);
  EXPECT_EQ(normal_of(inf), 1.0f);
  EXPECT_EQ(normal_of(-inf), 0.0f);
  EXPECT_EQ(normal_of(3e38f), 1.0f);
  EXPECT_EQ(normal_of(-3e38f), 0.0f);
  EXPECT_TRUE(std::isnan(normal_of(nan)));
  for (float a = 0; a < 8; a += 0.01f) EXPECT_NEAR(normal_of(-a), 1.0 - normal_of(a), 6e-8);
}

// All directions, at magnitudes from 2^-100 to 2^100, and both sides of the axes and the diagonals.
TEST(Arithmetic, Arctangent) {
  const FloatingPointMode mode;
  double most = 0, most_relative = 0;
  const auto look = [&](float a, float b) {
    const double truth = std::atan2(static_cast<double>(a), static_cast<double>(b));
    const double error = std::abs(arctangent_of(a, b) - truth);
    most = std::max(most, error);
    if (std::abs(truth) > 1e-30) most_relative = std::max(most_relative, error / std::abs(truth));
  };
  std::mt19937 random(3);
  std::uniform_real_distribution<float> anywhere(-1, 1), power(-100, 100);
  for (int i = 0; i < 3000000; ++i) look(anywhere(random), anywhere(random));
  for (int i = 0; i < 1000000; ++i) {
    const float size = std::exp2(power(random));
    look(anywhere(random) * size, anywhere(random) * size);
  }
  for (float t = 1e-20f; t < 1e20f; t *= 1.001f) {
    for (const float a : {t, -t}) {
      for (const float b : {1.0f, -1.0f}) look(a, b);
    }
  }
  for (int ulps = -50; ulps <= 50; ++ulps) {
    look(std::bit_cast<float>(std::bit_cast<std::uint32_t>(0.7f) + static_cast<std::uint32_t>(ulps)), 0.7f);
  }
  std::printf("    worst error %.3g absolute, %.3g relative\n", most, most_relative);
  EXPECT_LT(most, 3e-7);
  EXPECT_LT(most_relative, 2e-7);
}

TEST(Arithmetic, ArctangentAtItsEdges) {
  const float pi = 3.14159274f, quarter = 0.785398185f;
  EXPECT_EQ(arctangent_of(0, 0), 0.0f);
  for (const float zero : {0.0f, -0.0f}) {
    EXPECT_EQ(arctangent_of(zero, 2), 0.0f);
    EXPECT_EQ(arctangent_of(zero, -2), pi);
    EXPECT_EQ(arctangent_of(zero, -zero), 0.0f);
    EXPECT_EQ(arctangent_of(3, zero), pi / 2);
    EXPECT_EQ(arctangent_of(-3, zero), -pi / 2);
  }
  EXPECT_FLOAT_EQ(arctangent_of(inf, inf), quarter);
  EXPECT_FLOAT_EQ(arctangent_of(inf, -inf), 3 * quarter);
  EXPECT_FLOAT_EQ(arctangent_of(-inf, -inf), -3 * quarter);
  EXPECT_FLOAT_EQ(arctangent_of(inf, -1e30f), pi / 2);
  EXPECT_EQ(arctangent_of(1, inf), 0.0f);
  EXPECT_EQ(arctangent_of(1, -inf), pi);
  for (const float other : {0.0f, 1.0f, -2.0f, inf, -inf, nan}) {
    EXPECT_TRUE(std::isnan(arctangent_of(nan, other))) << other;
    EXPECT_TRUE(std::isnan(arctangent_of(other, nan))) << other;
  }
}

TEST(Arithmetic, FloorAndAbsoluteAndSquareRootAreExact) {
  for (const float a : arguments(-2e7f, 2e7f)) {
    ASSERT_EQ(floor_of(a), std::floor(a)) << a;
    ASSERT_EQ(absolute(a), std::fabs(a)) << a;
    ASSERT_EQ(square_root_of(absolute(a)), std::sqrt(std::fabs(a))) << a;
  }
  for (const float a : {inf, -inf, 3e38f, -3e38f, 8388607.5f, -8388607.5f, 0.49999997f, -0.49999997f}) {
    EXPECT_EQ(floor_of(a), std::floor(a)) << a;
  }
  EXPECT_TRUE(std::isnan(floor_of(nan)));
  EXPECT_TRUE(std::isnan(absolute(nan)));
  EXPECT_TRUE(std::isnan(square_root_of(-1.0f)));
  EXPECT_TRUE(std::isnan(square_root_of(nan)));
  EXPECT_EQ(square_root_of(inf), inf);
}

TEST(Arithmetic, LimitHoldsForEveryArgument) {
  EXPECT_EQ(limited(3.0f, 2.0f), 2.0f);
  EXPECT_EQ(limited(-3.0f, 2.0f), -2.0f);
  EXPECT_EQ(limited(1.5f, 2.0f), 1.5f);
  EXPECT_EQ(limited(inf, 2.0f), 2.0f);
  EXPECT_EQ(limited(-inf, 2.0f), -2.0f);
  EXPECT_EQ(limited(nan, 2.0f), 0.0f);
  EXPECT_EQ(limited(1.0f, nan), 0.0f);
  EXPECT_EQ(limited(1.0f, -2.0f), 0.0f);
  EXPECT_EQ(limited(1.0f, 0.0f), 0.0f);
  EXPECT_EQ(limited(nan, nan), 0.0f);
}

TEST(Arithmetic, ModeComesBack) {
  volatile float small = 1e-38f;
  {
    const FloatingPointMode mode;
#if defined(__SSE__) || defined(__aarch64__)
    volatile float half = small * 0.5f;
    EXPECT_EQ(half, 0.0f);
#endif
  }
  volatile float half = small * 0.5f;
  EXPECT_GT(half, 0.0f);
}

}  // namespace
}  // namespace wale::arithmetic_test
