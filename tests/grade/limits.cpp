// The largest force, its spread over time and what the compiler's limit does, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "compiler/describe/describe.hpp"
#include "compiler/measure/measure.hpp"
#include "compiler/modules/load_modules.hpp"
#include "tests/grade/grading.hpp"

namespace wale::limits_test {
namespace {

Measured measured(const std::string& physical) { return measure(Bank(compiling::compiled(physical))); }

Description described(const std::string& physical) {
  return describe(Bank(compiling::compiled(physical)), common_modules()->declarations);
}

// Heights that add up to 1 are level inside the patch, and fade to 0 over its rim.
TEST(Limits, TheLargestForceIsAlsoLookedForInTheRim) {
  const Measured felt = measured(
      "    force = lateral(grating(x, period: 3 mm), amplitude: 2 N) + lateral(grating(x + 1.5 mm, period: 3 mm), "
      "amplitude: 2 N)");
  EXPECT_LT(felt.less_rim, 0.001f);
  EXPECT_GE(felt.max_newton, 0.42f);
}

// The largest force of a narrow hill of the force is found between the hands of the lattice.
TEST(Limits, TheLargestForceIsThatOfTheClosedForm) {
  EXPECT_NEAR(
      measured("    force = vector(3 N * exp(-((x - 17.3 mm) / 5 mm)^2 - ((y + 4.1 mm) / 5 mm)^2), 0 N)").max_newton, 3,
      0.003);
  EXPECT_NEAR(measured("    force = vector(-2 N * x / 10 mm * exp(-(x / 10 mm)^2), 0 N)").max_newton,
              2 * std::sqrt(0.5) * std::exp(-0.5), 0.001);
}

// A sine of 1 N has a root mean square of sqrt(1/2), over time as over place.
TEST(Limits, AForceThatChangesWithTimeIsMeasuredOverTime) {
  for (const char* wave : {"sin(2 pi * 30 Hz * time)", "sin(2 pi * phase(120 Hz))"}) {
    const Measured felt = measured("    active 2 W\n    force = vector(1 N * " + std::string(wave) + ", 0 N)");
    EXPECT_TRUE(felt.over_time) << wave;
    EXPECT_NEAR(felt.rms_newton, std::sqrt(0.5), 0.01) << wave;
    EXPECT_NEAR(felt.p99_newton, 1, 0.01) << wave;
  }
  EXPECT_FALSE(measured("    force = vector(1 N * sin(2 pi * x / 4 mm), 0 N)").over_time);
}

TEST(Limits, AProvedBoundBelowTheLimitShowsThatItDoesNotMatter) {
  EXPECT_FALSE(described("    let u = x / 10 mm\n    force = vector(-2 N * u * exp(-u^2), 0 N)").limit_matters);
  EXPECT_FALSE(described("    active 2 W\n    force = vector(1 N * sin(2 pi * 30 Hz * time), 0 N)").limit_matters);
  EXPECT_TRUE(described("    force = -800 N/m * hand").limit_matters);
}

TEST(Limits, AWallIsAsStiffAsItsSlope) {
  for (const double stiffness : {300.0, 500.0, 800.0}) {
    const Description wall = described("    force = firm(" + std::to_string(stiffness) + " N/m, face: 20 mm)");
    ASSERT_TRUE(wall.wall);
    EXPECT_LE(wall.wall->face.stiffness, wall.grade.stiffness);
    EXPECT_NEAR(wall.wall->face.stiffness, stiffness, 0.003 * stiffness);
  }
}

// Two sines half a period apart cancel but for rounding: none of it can be commanded.
TEST(Limits, WhatCancelsToRoundingHasNoDetails) {
  const Description none = described(
      "    force = vector(1 N * sin(2 pi * x / 3 mm), 0 N) + vector(1 N * sin(2 pi * (x + 1.5 mm) / 3 mm), 0 N)");
  EXPECT_EQ(none.grade.standing, Standing::passive);
  EXPECT_EQ(none.grade.required_damping, 0);
  EXPECT_TRUE(std::isinf(none.grade.finest_period));
  const std::string text = description_text(none);
  EXPECT_EQ(text.find("times that"), std::string::npos);
  EXPECT_EQ(text.find("steps of force"), std::string::npos);
}

}  // namespace
}  // namespace wale::limits_test
