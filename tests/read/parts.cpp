// What resists otherwise in a part of the patch, on a narrow one, or a slow hand, beside friction that remembers: closed
// forms, drawn at random.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "compiler/describe/describe.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/read/read.hpp"
#include "tests/standard/standard.hpp"

namespace wale::parts_test {
namespace {

ForceReading reading(const std::string& statements) {
  static const auto common = common_modules();
  return read(Bank(standard::material("material m { physical {\nactive 9 W\n" + statements + "\n} }", "m")),
              common->declarations);
}

double between(std::mt19937& random, double low, double high) {
  return std::round(1e3 * std::uniform_real_distribution<>(low, high)(random)) / 1e3;
}

TEST(Parts, AFrictionIsToldWhereItIsGreater) {
  std::mt19937 random(21);
  for (int i = 0; i < 8; ++i) {
    const double size = between(random, 0.3, 0.8), times = between(random, 1.5, 3), line = between(random, 20, 58);
    const char axis = i % 2 == 0 ? 'x' : 'y';
    const std::string force = fmt::format("force = sticky({} N) * (if {}{} > {} mm then {} else 1)", size,
                                          i % 4 < 2 ? "" : "-", axis, line, times);
    const ForceReading found = reading(force);
    EXPECT_NEAR(found.opposing.least_by_place, size, 0.03 * size) << force;
    EXPECT_NEAR(found.opposing.most_by_place, times * size, 0.03 * times * size) << force;
  }
}

TEST(Parts, AViscosityIsToldWhereASpotHasMore) {
  std::mt19937 random(22);
  for (int i = 0; i < 8; ++i) {
    const double size = between(random, 2, 6), times = between(random, 1.5, 3), radius = between(random, 24, 30);
    const std::string force =
        fmt::format("force = viscous({} N s/m) * (if length(hand - vector({} mm, {} mm)) < {} mm then {} else 1)", size,
                    between(random, -45, 45), between(random, -45, 45), radius, times);
    const ForceReading found = reading(force);
    EXPECT_NEAR(found.opposing.least_by_place, 0.2 * size, 0.01) << force;
    EXPECT_NEAR(found.opposing.most_by_place, 0.2 * size * times, 0.01 * size) << force;
  }
}

TEST(Parts, AFrictionAloneIsAlikeEverywhere) {
  for (const std::string patch : {"", "patch 10 mm, 150 mm\n", "patch 150 mm, 7 mm\n", "patch 6.4 mm, 90 mm\n"})
    for (const double size : {0.2, 0.5, 1.1}) {
      const ForceReading found = reading(patch + fmt::format("force = sticky({} N)", size));
      EXPECT_TRUE(found.opposing.explained) << patch << size;
      EXPECT_NEAR(found.opposing.friction, size, 0.03 * size) << patch << size;
      EXPECT_NEAR(found.opposing.friction_across, size, 0.03 * size) << patch << size;
      EXPECT_EQ(found.opposing.uneven(), 0) << patch << size;
    }
}

TEST(Parts, SlowHandsAreLookedAtBesideAFrictionThatRemembers) {
  std::mt19937 random(23);
  for (int i = 0; i < 6; ++i) {
    const double dry = between(random, 0.2, 0.6), slope = between(random, 6, 10), most = between(random, 0.4, 0.6);
    const double size = between(random, 0.3, 0.8), slow = between(random, 8, 15);
    const bool rises = i % 2 == 0;
    const std::string force =
        fmt::format("force a = sticky({} N)\nforce b = ", dry) +
        (rises ? fmt::format("-hold({} N s/m * velocity, {} N)", slope, most)
               : fmt::format("-{} N * exp(-length(velocity) / {} mm * 1 s) * normalise(velocity)", size, slow));
    const auto law = [&](double speed) {
      return dry + (rises ? std::min(slope * speed, most) : size * std::exp(-speed / (1e-3 * slow)));
    };
    const ForceReading found = reading(force);
    EXPECT_FALSE(found.opposing.explained && found.opposing.rise() == 0) << force;
    ASSERT_LT(found.opposing.by_speed.front().speed, 0.011) << force;
    for (const DragAt& each : found.opposing.by_speed)
      EXPECT_NEAR(each.newton, law(each.speed), 0.03 * law(each.speed)) << force << " at " << each.speed;
  }
}

TEST(Parts, WhatIsLeftOfASpringOfWhichAPartEndsIsTold) {
  std::mt19937 random(24);
  for (int i = 0; i < 8; ++i) {
    const double part = between(random, 40, 200), rest = between(random, 6, 40), ends = between(random, 6, 40);
    const std::string force =
        i % 2 == 0
            ? fmt::format("force = vector(-{} N/m * x - {} N/m * clamp(x, -{} mm, {} mm), 0 N)", rest, part, ends, ends)
            : fmt::format("force a = -{} N/m * hold(hand, {} mm)\nforce b = spring({} N/m)", part, ends, rest);
    const ForceReading found = reading(force);
    EXPECT_NEAR(found.stiffness, part + rest, 0.01 * (part + rest)) << force;
    EXPECT_NEAR(found.cut_spring(), 1e-3 * part * ends, 0.01 * 1e-3 * part * ends) << force;
    EXPECT_NEAR(found.still.beyond_cut, rest, 0.01 * rest) << force;
    EXPECT_FALSE(found.wall || !found.steps.empty()) << force;
  }
  const ForceReading alone = reading("force = -100 N/m * hold(hand, 30 mm)");
  EXPECT_NEAR(alone.cut_spring(), 3, 0.03);
  EXPECT_EQ(alone.still.beyond_cut, 0);
}

TEST(Parts, AVibrationInACornerIsNoWallAndPushesSomewhere) {
  for (const std::string beside : {"", "force b = sticky(0.3 N)\n"}) {
    const ForceReading found =
        reading(beside + "force a = vibrate(1 N, rate: 80 Hz) * (if x > 40 mm and y > 40 mm then 1 else 0)");
    EXPECT_FALSE(found.wall) << beside;
    EXPECT_NEAR(found.vibration.amplitude, 1, 0.03) << beside;
    EXPECT_EQ(found.vibration.least, 0) << beside;
    EXPECT_GT(found.other.rehearsed, 0.95) << beside;
  }
  // A wall beside a vibration stays one.
  const ForceReading wall = reading("force a = vibrate(0.3 N, rate: 80 Hz)\nforce b = firm(400 N/m, face: 20 mm)");
  ASSERT_TRUE(wall.wall);
  EXPECT_NEAR(wall.wall->stiffness, 400, 12);
}

}  // namespace
}  // namespace wale::parts_test
