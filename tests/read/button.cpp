// What the button does in motion and in time, and what differs from place to place.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "compiler/compare/compare.hpp"
#include "compiler/describe/describe.hpp"
#include "compiler/describe/held_figures.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/read/cues.hpp"
#include "compiler/read/tolerances.hpp"
#include "tests/standard/standard.hpp"

namespace wale::button_test {
namespace {

Bank with_force(const std::string& statements) {
  return Bank(standard::material("\nmaterial m { physical {\n" + statements + "\n} }", "m"));
}
const Declarations& declared() {
  static const auto common = common_modules();
  return common->declarations;
}
ForceReading found_in(const std::string& statements) { return read(with_force(statements), declared()); }
std::string text_of(const std::string& statements) {
  return description_text(describe(with_force(statements), declared()));
}
Verdict verdict(const std::string& one, const std::string& other) {
  const Comparer comparer(declared(), "sandpaper");
  return comparer.compare(cues_of(with_force(one), declared()), cues_of(with_force(other), declared())).verdict;
}

TEST(ReadingTheButton, WhatItChangesInMotionIsRead) {
  std::mt19937 random(5);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  for (int i = 0; i < 24; ++i) {
    const double open = i % 2 == 0 ? 0 : between(0.5, 4), held = between(5, 9), mass = between(0.02, 0.09);
    const double friction = between(0.2, 2), size = between(0.3, 3), rate = between(20, 200);
    const std::string texts[] = {
        fmt::format("force = if button then viscous({} N s/m) else viscous({} N s/m)", held, open),
        fmt::format("force = (if button then 1 else 0) * sticky({} N) + viscous({} N s/m)", friction, open),
        fmt::format("force = (if button then 1 else 0) * heavy({} kg) + viscous({} N s/m)", mass, open),
        fmt::format("active 90 W\nforce = (if button then 1 else 0) * vibrate({} N, rate: {} Hz) + viscous({} N s/m)",
                    size, rate, open)};
    const std::string& text = texts[i / 2 % 4];
    const ForceReading found = found_in(text);
    ASSERT_TRUE(found.held) << text;
    EXPECT_NEAR(found.opposing.damping, open, std::max(least_damping, 0.03 * open)) << text;
    EXPECT_NEAR(found.opposing.friction, 0, least_force) << text;
    EXPECT_LT(std::abs(found.inertia.greatest), least_mass) << text;
    EXPECT_LT(found.vibration.amplitude, least_force) << text;
    const bool viscous = i / 2 % 4 == 0, sticky = i / 2 % 4 == 1, heavy = i / 2 % 4 == 2, vibrates = i / 2 % 4 == 3;
    EXPECT_NEAR(found.held->opposing.friction, sticky ? friction : 0, std::max(least_force, 0.03 * friction)) << text;
    EXPECT_NEAR(found.held->opposing.damping, viscous ? held : open, 0.03 * held) << text;
    EXPECT_NEAR(found.held->inertia.greatest, heavy ? mass : 0, std::max(least_mass, 0.03 * mass)) << text;
    EXPECT_NEAR(found.held->vibration.amplitude, vibrates ? size : 0, std::max(least_force, 0.03 * size)) << text;
    if (vibrates) {
      EXPECT_NEAR(found.held->vibration.frequency, rate, 0.02 * rate) << text;
    }
  }
}

TEST(ReadingTheButton, DescribeSaysWhatItChanges) {
  EXPECT_NE(text_of("force = if button then viscous(3 N s/m) else viscous(6 N s/m)")
                .find("while the button is held: viscosity 3 N s/m instead of 6 N s/m"),
            std::string::npos);
  EXPECT_NE(text_of("active 1 W\nforce = if button then vibrate(1 N, rate: 100 Hz) else vector(0 N, 0 N)")
                .find("while the button is held: vibration 1 N at 100 Hz instead of none"),
            std::string::npos);
  // The same with the button and without.
  EXPECT_EQ(text_of("force = if button then viscous(6 N s/m) else 2 * viscous(3 N s/m)").find("while the button"),
            std::string::npos);
  EXPECT_FALSE(found_in("force = viscous(6 N s/m)").held);
}

TEST(ReadingTheButton, DragIsComparedOverTheSameWays) {
  std::mt19937 random(6);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  for (int i = 0; i < 8; ++i) {
    const double open = between(0.3, 4), held = between(0.5, 5);
    const std::string always[] = {"vector(-{} N s/m * max(0 m/s, velocity.x), 0 N)",
                                  "vector(0 N, -{} N s/m * velocity.y)"};
    const std::string adds[] = {"viscous({} N s/m)", "vector(-{} N s/m * velocity.x, 0 N)"};
    const std::string text = fmt::format("force = {} + (if button then {} else vector(0 N, 0 N))",
                                         fmt::format(fmt::runtime(always[i % 2]), open),
                                         fmt::format(fmt::runtime(adds[i / 2 % 2]), held));
    const ForceReading found = found_in(text);
    EXPECT_NEAR(found.held_drag(0.2), 0.2 * held, 0.03 * 0.2 * held) << text;
    for (const HeldFigure& each : held_figures(found)) {
      const double speed = each.name == std::string("viscosity") ? 1 : each.name == std::string("drag at 50 mm/s") ? 0.05 : 0.2;
      EXPECT_NEAR(each.held - each.open, speed * held, 0.03 * speed * held) << text << each.name;
    }
  }
}

TEST(ReadingTheButton, WhatComesLateOrByClicksIsFound) {
  const std::string late = "force = if button and time > 3 s then vector(2 N, 0 N) else vector(0 N, 0 N)";
  EXPECT_NEAR(found_in(late).other.button, 2, 0.01);
  EXPECT_NEAR(found_in(late).other.push().x, 2, 0.01);
  EXPECT_NEAR(found_in("state held : time = 0 s in 0 s .. 100 s\nnext held = if button then held + dt else 0 s\n"
                       "force = if held > 3 s then vector(2 N, 0 N) else vector(0 N, 0 N)")
                  .other.button,
              2, 0.01);
  EXPECT_NEAR(found_in("state n = 0 in 0 .. 100\nstate down = 0 in 0 .. 1\n"
                       "next n = if button and down < 0.5 then n + 1 else n\nnext down = if button then 1 else 0\n"
                       "force = if n > 2.5 then vector(2 N, 0 N) else vector(0 N, 0 N)")
                  .other.remembered,
              2, 0.01);
}

TEST(ReadingTheButton, APressTellsProgramsApart) {
  const char* nothing = "force = vector(0 N, 0 N)";
  EXPECT_EQ(verdict("force = if button then viscous(3 N s/m) else viscous(6 N s/m)", "force = viscous(6 N s/m)"),
            Verdict::apart);
  EXPECT_EQ(verdict("force = if button then viscous(5 N s/m) else vector(0 N, 0 N)", nothing), Verdict::apart);
  EXPECT_EQ(verdict("force = if button then sticky(0.7 N) else vector(0 N, 0 N)", nothing), Verdict::apart);
  EXPECT_EQ(verdict("force = if button then sticky(0.7 N) else vector(0 N, 0 N)",
                    "force = (if button then 1 else 0) * sticky(0.7 N)"),
            Verdict::alike);
}

TEST(ReadingMotion, AVibrationInAPartOfThePatchIsNoneElsewhere) {
  const std::string shaking = "active 2 W\nforce = vector(1 N * sin(2 pi * phase(100 Hz)), 0 N)";
  const std::string part =
      "active 2 W\nforce = vector((if x > 10 mm then 1 N else 0 N) * sin(2 pi * phase(100 Hz)), 0 N)";
  ASSERT_TRUE(found_in(part).vibration.least);
  EXPECT_EQ(*found_in(part).vibration.least, 0);
  EXPECT_FALSE(found_in(shaking).vibration.least);
  EXPECT_NE(text_of(part).find("the vibration differs from place to place: from none to 1 N"), std::string::npos);
  EXPECT_EQ(verdict(part, shaking), Verdict::apart);
  // A wave that travels swings alike everywhere.
  EXPECT_FALSE(
      found_in("active 2 W\nforce = vector(1 N * sin(2 pi * (x / 20 mm - 30 Hz * time)), 0 N)").vibration.least);
}

TEST(ReadingMotion, WhatShakesAMovingHandOnlyIsFound) {
  EXPECT_NEAR(found_in("active 2 W\nforce = vector((if length(velocity) > 50 mm/s then 1 N else 0 N)"
                       " * sin(2 pi * phase(100 Hz)), 0 N)")
                  .other.moving,
              1, 0.03);
  // Drag at one spot, in less than a hundredth of the patch.
  EXPECT_NEAR(
      found_in("force = viscous(6 N s/m) * (if length(hand - vector(30 mm, 30 mm)) < 5 mm then 1 else 0)").other.moving,
      1.5, 0.01);
}

TEST(ReadingMotion, ADragOfSlowHandsIsTold) {
  const char* text =
      "let v = length(velocity)\nforce = if v < 30 mm/s and v > 0 mm/s then -0.5 N * velocity / v else vector(0 N, 0 "
      "N)";
  EXPECT_NEAR(found_in(text).opposing.creeping(), 0.5, 0.02);
  EXPECT_EQ(verdict(text, "force = vector(0 N, 0 N)"), Verdict::apart);
}

}  // namespace
}  // namespace wale::button_test
