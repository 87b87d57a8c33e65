// The largest force, its spread over time and what the compiler's limit does, against closed forms.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

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

/// Whether the compiler says that a material never pushes.
bool said_never_to_push(const std::string& physical) {
  compiling::Files files;
  SourceSet sources;
  Diagnostics diagnostics;
  const SourceId source = sources.add("test.wale", "wale 1\nmaterial m {\n  physical {\n" + physical + "\n  }\n}\n");
  if (!compile(sources, source, "", default_device, files, diagnostics)) throw std::runtime_error(physical);
  return std::ranges::any_of(diagnostics.all(), [](const Diagnostic& each) { return each.code == Code::never_pushes; });
}

/// A force that acts within a few encoder counts only, and its largest size.
struct Feature {
  std::string physical;
  double newton;
};

Feature some_feature(std::mt19937& dice, int kind) {
  const auto in = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(dice); };
  constexpr double count = 0.2286 / 4096;  // m, of Minsky's joystick
  const double newton = in(0.5, 6), half = 1e3 * count * in(0.5, 4), x = in(-55, 55), y = in(-55, 55);
  const std::string along = in(0, 1) < 0.5 ? "vector(f, 0 N)" : "vector(0 N, f)";
  const double angle = in(0, 6.283);
  const std::string u = fmt::format("    let u = {} * x + {} * y - {} mm\n", std::cos(angle), std::sin(angle), x);
  const std::string away = fmt::format("    let u = length(hand - vector({} mm, {} mm))\n", x, y);
  const std::string force = "    force = " + along;
  const std::string within = fmt::format("    let f = if abs(u) < {} mm then {} N else 0 N\n", half, newton);
  const std::string hill = fmt::format("    let f = {} N * exp(-(u / {} mm)^2)\n", newton, half);
  const std::string tent = fmt::format("    let f = {} N * max(0, 1 - abs(u) / {} mm)\n", newton, half);
  switch (kind % 6) {
    case 0: return {u + within + force, newton};
    case 1: return {u + hill + force, newton};
    case 2: return {u + tent + force, newton};
    case 3: return {away + within + force, newton};
    case 4: return {away + hill + force, newton};
    default: return {away + tent + force, newton};
  }
}

TEST(Limits, AFeatureOfAFewCountsIsAForce) {
  std::mt19937 dice(432);
  for (int i = 0; i < 120; ++i) {
    const Feature feature = some_feature(dice, i);
    SCOPED_TRACE(feature.physical);
    EXPECT_FALSE(said_never_to_push(feature.physical));
    const Description found = described(feature.physical);
    EXPECT_NEAR(found.force.max_newton, feature.newton, 0.06 * feature.newton);
    EXPECT_GE(found.bound.found.newton, found.force.max_newton);
    EXPECT_GE(found.bound.newton * (1 + 1e-6), found.bound.found.newton);
  }
}

TEST(Limits, AForceThatAParameterBringsIsNotMissing) {
  EXPECT_FALSE(said_never_to_push(
      "    param k = 0 N in 0 N .. 5 N \"size\"\n    force = vector(k * sin(2 pi * x / 5 mm), 0 N)"));
  EXPECT_FALSE(
      said_never_to_push("    param k = 0 N in 0 N .. 5 N \"size\"\n    param j = 0 in 0 .. 1 \"share\"\n"
                         "    force = vector(j * k * sin(2 pi * x / 5 mm), 0 N)"));
  EXPECT_FALSE(
      said_never_to_push("    param face = 90 mm in 20 mm .. 90 mm \"place\"\n    force = firm(500 N/m, face: face)"));
  EXPECT_TRUE(
      said_never_to_push("    param k = 500 N/m in 100 N/m .. 900 N/m \"stiffness\"\n    force = firm(k, face: 20 m)"));
  EXPECT_TRUE(said_never_to_push("    force = vector(0.001 mN * sin(2 pi * x / 3 mm), 0 N)"));
}

// No search tries all histories, so that "at most" would claim too much.
TEST(Limits, WhatDependsOnMoreThanTheMomentIsOnlyFound) {
  for (const char* physical :
       {"    force = sticky(0.5 N)", "    force = -0.2 kg * acceleration",
        "    active 2 W\n    force = vector(1 N * sin(2 pi * 0.004 Hz * time), 0 N)",
        "    state slow: length = 0 mm in -100 mm .. 100 mm\n    next slow = slow + 0.01 * (x - slow)\n    force = "
        "vector(-100 N/m * slow, 0 N)"}) {
    const Description found = described(physical);
    EXPECT_TRUE(found.force.may_be_larger) << physical;
    const std::string text = description_text(found);
    EXPECT_EQ(text.find("N at most with"), std::string::npos) << physical;
    EXPECT_NE(text.find("N is the largest force found with these parameters"), std::string::npos) << physical;
    EXPECT_LE(found.force.max_newton, found.bound.newton * (1 + 1e-6)) << physical;
  }
  for (const char* physical : {"    force = -100 N/m * hand", "    force = -2 N s/m * velocity"})
    EXPECT_NE(description_text(described(physical)).find("N at most with these parameters"), std::string::npos);
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
    EXPECT_GE(felt.over_seconds, 1) << wave;
    EXPECT_NEAR(felt.rms_newton, std::sqrt(0.5), 0.01) << wave;
    EXPECT_NEAR(felt.p99_newton, 1, 0.01) << wave;
  }
  EXPECT_EQ(measured("    force = vector(1 N * sin(2 pi * x / 4 mm), 0 N)").over_seconds, 0);
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
