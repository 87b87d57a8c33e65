// Reading: few periods of a sine are a wave; nothing is read that is more than the force itself; what motion makes swing is
// no resistance.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "compiler/modules/load_modules.hpp"
#include "compiler/read/read.hpp"
#include "compiler/read/tolerances.hpp"
#include "tests/standard/standard.hpp"

namespace wale::small_patches_test {
namespace {

ForceReading reading(const std::string& statements) {
  static const auto common = common_modules();
  return read(Bank(standard::material("material m { physical {\n" + statements + "\n} }", "m")), common->declarations);
}

TEST(ReadingSmallPatches, FewPeriodsOfASineAreAWave) {
  struct Case {
    const char* patch;
    double across, period;  // mm: of the patch along the wave
  };
  // Two to three periods over each patch, whose rim is a quarter of a small one on either side.
  for (const auto& [patch, across, period] :
       {Case{"10 mm, 10 mm", 10, 5}, Case{"14 mm, 14 mm", 14, 5}, Case{"14 mm, 14 mm", 14, 4.7},
        Case{"20 mm, 20 mm", 20, 10}, Case{"20 mm, 20 mm", 20, 7}, Case{"25 mm, 25 mm", 25, 8},
        Case{"30 mm, 30 mm", 30, 10}, Case{"10 mm, 60 mm", 10, 4}, Case{"60 mm, 10 mm", 60, 20}})
    for (const double phase : {0.0, 0.3}) {
      const std::string statements =
          fmt::format("patch {}\nforce = vector(1 N * sin(2 pi * (x / {} mm + {})), 0 N)", patch, period, phase);
      const ForceReading found = reading(statements);
      EXPECT_NEAR(found.relief().amplitude, 1, 0.03) << statements;
      EXPECT_NEAR(found.relief().period, 1e-3 * period, 0.02e-3 * period) << statements;
      EXPECT_TRUE(found.steps.empty()) << statements;
      EXPECT_FALSE(found.wall) << statements;
      EXPECT_LT(std::abs(found.stiffness), least_stiffness) << statements;
    }
}

TEST(ReadingSmallPatches, ASpringBesideFewPeriodsIsTold) {
  const ForceReading found =
      reading("patch 30 mm, 30 mm\nforce = vector(1 N * sin(2 pi * x / 13 mm) - 60 N/m * x, -60 N/m * y)");
  EXPECT_NEAR(found.relief().period, 13e-3, 0.3e-3);
  EXPECT_NEAR(found.stiffness, 60, 2);
}

// 1 N and -1 N beyond two lines, and nothing else in any place.
TEST(ReadingSmallPatches, TwoParallelStepsLeaveNothing) {
  for (const char* law :
       {"if x > 10 mm then -1 N else if x < -20 mm then 1 N else 0 N", "if x > 10 mm then -2 N else if x < -20 mm then "
        "1 N else 0 N", "(if x > 12.34 mm then -1 N else 0 N) + (if x > -31.7 mm then -1 N else 0 N)"}) {
    const ForceReading found = reading(fmt::format("force = vector({}, 0 N)", law));
    EXPECT_EQ(found.steps.size(), 2u) << law;
    EXPECT_EQ(found.relief().small_feature(), 0) << law;
  }
}

TEST(ReadingSmallPatches, WhatMotionMakesSwingIsNoResistance) {
  for (const char* law :
       {"active 1 W\nforce = vector((if length(velocity) > 20 mm/s then 0.5 N else 0 N) * sin(2 pi * phase(80 Hz)), 0 N)",
        "active 1 W\nforce = vector(length(velocity) * 2 N s/m * sin(2 pi * phase(80 Hz)), 0 N)",
        "state n : length = x in -200 mm .. 200 mm\nnext n = 10 mm * round(x / 10 mm)\n"
        "force = vector(-200 N/m * (x - n), 0 N)"}) {
    const ForceReading found = reading(law);
    EXPECT_EQ(found.opposing.damping, 0) << law;
    EXPECT_EQ(found.opposing.friction, 0) << law;
  }
  // A resistance beside a small swing is one.
  const ForceReading both = reading(
      "active 1 W\nforce = -3 N s/m * velocity + vector(length(velocity) * 1 N s/m * sin(2 pi * phase(80 Hz)), 0 N)");
  EXPECT_NEAR(both.opposing.damping, 3, 0.15);
}

}  // namespace
}  // namespace wale::small_patches_test
