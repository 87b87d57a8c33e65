#include "runtime/stage/acceleration_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/runtime/figures.hpp"

namespace wale::acceleration_filter_test {
namespace {

// The profile's velocity window is 15 ticks, so acceleration windows are 8 to 30 ticks.

TEST(AccelerationFilter, IsZeroUntilItsShortestWindowIsFull) {
  AccelerationFilter filter(sandpaper());
  for (int tick = 0; tick < 8; ++tick) ASSERT_EQ(filter(tick * tick, 1), 0) << tick;
  EXPECT_NEAR(filter(64, 1), 2, 1e-9);
}

TEST(AccelerationFilter, AParabolaOfWholeCountsIsExact) {
  for (const int a : {1, -3, 10}) {
    AccelerationFilter filter(sandpaper());
    for (int tick = 0; tick < 200; ++tick) {
      const double acceleration = filter(1000 - 7 * tick + a * tick * tick, 1);
      if (tick >= 8) {
        ASSERT_NEAR(acceleration, 2 * a, 1e-6) << tick;
      }
    }
  }
}

// Rounding to counts is uniform noise with a standard deviation of 1 / sqrt(12). The second derivative of a parabola
// through n = 31 samples has sqrt(720 / n^5) of that. The window may be a few ticks shorter.
TEST(AccelerationFilter, ConstantAccelerationIsRightWithinTheNoiseOfAFullWindow) {
  for (const double acceleration : {0.0137, -0.05, 0.31}) {
    AccelerationFilter filter(sandpaper());
    double squares = 0;
    for (int tick = 0; tick < 2000; ++tick) {
      const double counts = 0.123 + 0.7 * tick + 0.5 * acceleration * tick * tick;
      const double error = filter(static_cast<int>(std::lround(counts)), 1) - acceleration;
      if (tick >= 30) squares += error * error;
    }
    EXPECT_LT(std::sqrt(squares / 1970), 1.5 * std::sqrt(720 / std::pow(31, 5) / 12)) << acceleration;
  }
}

TEST(AccelerationFilter, IsSmallForAHandAtRest) {
  AccelerationFilter filter(sandpaper());
  for (int tick = 0; tick < 100; ++tick) ASSERT_EQ(filter(17, 1), 0);
  std::mt19937 random(1);
  double squares = 0, most = 0;
  for (int tick = 0; tick < 5000; ++tick) {
    const double acceleration = filter(17 + static_cast<int>(random() % 2), 1);
    squares += acceleration * acceleration;
    most = std::max(most, std::abs(acceleration));
  }
  EXPECT_LT(std::sqrt(squares / 5000), 1.2 * 0.5 * std::sqrt(720 / std::pow(31, 5)));
  EXPECT_LT(most, 0.02) << "a plain second difference would be 2";
}

// The delay is half the window, 15 ticks of the 900 of a period, so the error is at most 2 pi 15 / 900 of the
// amplitude.
TEST(AccelerationFilter, ASineIsFollowedWithHalfAWindowOfDelay) {
  const double amplitude = 900, w = 2 * std::numbers::pi / 900;  // 50 mm at 1 Hz
  AccelerationFilter filter(sandpaper());
  double squares = 0, late = 0;
  for (int tick = 0; tick < 2700; ++tick) {
    const double acceleration = filter(static_cast<int>(std::lround(amplitude * std::sin(w * tick))), 1);
    const auto truth = [&](double delay) { return -amplitude * w * w * std::sin(w * (tick - delay)); };
    if (tick < 900) continue;
    squares += (acceleration - truth(0)) * (acceleration - truth(0));
    late += (acceleration - truth(15)) * (acceleration - truth(15));
  }
  EXPECT_LT(std::sqrt(squares / 1800), 0.11 * amplitude * w * w);
  EXPECT_LT(std::sqrt(late / 1800), 0.045 * amplitude * w * w);
}

// The hand rests and then accelerates at 2 counts per tick^2, 90 m/s^2. The window shortens within the shortest window.
TEST(AccelerationFilter, AStepIsFollowedWithinTheShortestWindow) {
  AccelerationFilter filter(sandpaper());
  for (int tick = 0; tick < 100; ++tick) filter(0, 1);
  double last = 0;
  for (int tick = 1; tick <= 40; ++tick) {
    const double acceleration = filter(tick * tick, 1);
    ASSERT_GE(acceleration, last - 0.1) << tick;
    ASSERT_LE(acceleration, 2.5) << tick;
    if (tick >= 10) {
      ASSERT_NEAR(acceleration, 2, 0.1) << tick;
    }
    last = acceleration;
  }
}

TEST(AccelerationFilter, SkippedPeriodsStretchTheParabola) {
  AccelerationFilter filter(sandpaper());
  std::mt19937 random(2);
  int tick = 0;
  filter(0, 0);
  for (int i = 0; i < 1000; ++i) {
    const int periods = i % 50 == 49 ? 400 : 1 + static_cast<int>(random() % 4);
    tick += periods;
    ASSERT_NEAR(filter(3 * tick, periods), 0, 1e-6) << i;
  }
  AccelerationFilter curved(sandpaper());
  tick = 0;
  for (int i = 0; i < 300; ++i) {
    const int periods = 1 + static_cast<int>(random() % 4);
    tick += periods;
    const double acceleration = curved(2 * tick * tick, i == 0 ? 0 : periods);
    if (tick > 20) {
      ASSERT_NEAR(acceleration, 4, 1e-6) << i;
    }
  }
}

TEST(AccelerationFilter, AGapBeyondTheLongestWindowBeginsAgain) {
  AccelerationFilter filter(sandpaper());
  for (int tick = 0; tick < 50; ++tick) filter(tick * tick, 1);
  EXPECT_EQ(filter(100'000, 400), 0);
  for (int tick = 1; tick < 8; ++tick) ASSERT_EQ(filter(100'000 + tick * tick, 1), 0) << tick;
  EXPECT_NEAR(filter(100'064, 1), 2, 1e-9);
}

TEST(AccelerationFilter, WithoutAWindowItIsThePlainSecondDifference) {
  DeviceProfile profile = sandpaper();
  profile.velocity_window = 0;
  AccelerationFilter filter(profile);
  filter(5, 0);
  filter(9, 1);
  EXPECT_NEAR(filter(6, 1), (6 - 9) - (9 - 5), 1e-12);
  EXPECT_NEAR(filter(6, 1), (6 - 6) - (6 - 9), 1e-12);
}

TEST(PlainDifferences, AreThoseOfTheCounts) {
  PlainDifferences differences;
  EXPECT_EQ(differences(5, 0).velocity, 0);
  EXPECT_EQ(differences(9, 1).velocity, 4);
  const auto third = differences(6, 1);
  EXPECT_EQ(third.velocity, -3);
  EXPECT_EQ(third.acceleration, -7);
}

// The second divided difference of a parabola is its curvature at any spacing of the samples.
TEST(PlainDifferences, SkippedPeriodsCount) {
  PlainDifferences differences;
  int tick = 0;
  for (int i = 0; i < 50; ++i) {
    const int periods = 1 + i * 7 % 5;
    tick += periods;
    const auto [velocity, acceleration] = differences(3 * tick * tick, i == 0 ? 0 : periods);
    if (i > 0) {
      ASSERT_NEAR(velocity, 3 * (2 * tick - periods), 1e-9);
    }
    if (i > 1) {
      ASSERT_NEAR(acceleration, 6, 1e-9);
    }
  }
}

}  // namespace
}  // namespace wale::acceleration_filter_test
