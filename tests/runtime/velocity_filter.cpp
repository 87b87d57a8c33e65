#include "runtime/stage/velocity_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/runtime/figures.hpp"

namespace wale::velocity_filter_test {
namespace {

TEST(VelocityFilter, FirstSampleHasNoVelocity) {
  VelocityFilter filter(sandpaper());
  EXPECT_EQ(filter(1234, 0), 0);
}

TEST(VelocityFilter, ConstantVelocityIsRightWithinOneCountPerWindow) {
  for (const double speed : {0.013, 0.3, 1.0, 2.71, -7.9, 18.0}) {
    VelocityFilter filter(sandpaper());
    for (int tick = 0; tick < 500; ++tick) {
      const double velocity = filter(static_cast<int>(std::floor(speed * tick)), 1);
      if (tick >= 15) {
        ASSERT_NEAR(velocity, speed, 1.0 / 15 + 1e-12) << speed << " counts per tick, tick " << tick;
      }
    }
  }
}

TEST(VelocityFilter, WholeCountsPerTickAreExactFromTheSecondSample) {
  VelocityFilter filter(sandpaper());
  filter(0, 0);
  for (int tick = 1; tick < 50; ++tick) ASSERT_EQ(filter(-3 * tick, 1), -3);
}

TEST(VelocityFilter, AStepOfVelocityIsFollowedWithinTheNoiseBand) {
  VelocityFilter filter(sandpaper());
  for (int tick = 0; tick <= 100; ++tick) filter(0, 1);
  // 4 counts per tick from now on: a window that reaches back n ticks too far is off by 4 n / (n + 1) at the bend,
  // which exceeds one count at once. So from the second tick on only new samples count.
  EXPECT_EQ(filter(4, 1), 4);
  for (int tick = 2; tick < 30; ++tick) ASSERT_EQ(filter(4 * tick, 1), 4) << tick;
}

TEST(VelocityFilter, OneCountOfNoiseAtRestIsAtMostOneCountPerWindow) {
  VelocityFilter filter(sandpaper());
  std::mt19937 random(1);
  for (int tick = 0; tick < 5000; ++tick) {
    const double velocity = filter(static_cast<int>(random() % 2), 1);
    if (tick >= 15) {
      ASSERT_LE(std::abs(velocity), 1.0 / 15 + 1e-12);
    }
  }
}

TEST(VelocityFilter, ASineIsFollowedWithLittleDelay) {
  const double amplitude = 900, w = 2 * std::numbers::pi / 900;  // 50 mm at 1 Hz
  VelocityFilter filter(sandpaper());
  double squares = 0;
  for (int tick = 0; tick < 1800; ++tick) {
    const double velocity = filter(static_cast<int>(std::lround(amplitude * std::sin(w * tick))), 1);
    const double error = velocity - amplitude * w * std::cos(w * tick);
    if (tick >= 900) squares += error * error;
  }
  EXPECT_LT(std::sqrt(squares / 900), 0.03 * amplitude * w);
}

TEST(VelocityFilter, SkippedPeriodsStretchTheSlopeNotTheVelocity) {
  VelocityFilter filter(sandpaper());
  std::mt19937 random(2);
  int tick = 0;
  filter(0, 0);
  for (int i = 0; i < 1000; ++i) {
    const int periods = i % 50 == 0 ? 400 : 1 + static_cast<int>(random() % 4);
    tick += periods;
    ASSERT_EQ(filter(2 * tick, periods), 2);
  }
}

TEST(VelocityFilter, AWindowOfOneTickIsThePlainDifference) {
  DeviceProfile profile = sandpaper();
  profile.velocity_window = 0;
  VelocityFilter filter(profile);
  filter(5, 0);
  EXPECT_EQ(filter(9, 1), 4);
  EXPECT_EQ(filter(6, 1), -3);
}

}  // namespace
}  // namespace wale::velocity_filter_test
