// What goes by place beside something that hides it: closed forms, drawn at random.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <string>

#include "compiler/describe/describe.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/read/read.hpp"
#include "tests/standard/standard.hpp"

namespace wale::by_place_test {
namespace {

Bank bank_of(const std::string& statements) {
  return Bank(standard::material("material m { physical {\nactive 9 W\n" + statements + "\n} }", "m"));
}
ForceReading reading(const std::string& statements) {
  static const auto common = common_modules();
  return read(bank_of(statements), common->declarations);
}

double between(std::mt19937& random, double low, double high) {
  return std::round(1e3 * std::uniform_real_distribution<>(low, high)(random)) / 1e3;
}

std::string wall_along(double angle, double stiffness, double face) {
  const double x = std::cos(angle), y = std::sin(angle);
  return fmt::format("-{} N/m * max(0 mm, {:.9f} * x + {:.9f} * y - {} mm) * vector({:.9f}, {:.9f})", stiffness, x, y,
                     face, x, y);
}

TEST(ByPlace, AnIncompletePeriodIsNoPush) {
  std::mt19937 random(5);
  for (int i = 0; i < 8; ++i) {
    const double period = between(random, 2, 12), phase = between(random, 0, 6.28), size = between(random, 0.3, 2);
    const std::string force = fmt::format("height h = sin(2 * pi * x / {} mm + {})\nforce = lateral(h, amplitude: {} N)",
                                          period, phase, size);
    const ForceReading found = reading(force);
    EXPECT_NEAR(found.relief().amplitude, size, 2e-3 * size) << force;
    EXPECT_LE(found.relief().amplitude, found.still.largest) << force;
    EXPECT_EQ(found.constant, glm::dvec2(0)) << force;
  }
}

TEST(ByPlace, WhatJumpsHasNoWidth) {
  std::mt19937 random(7);
  for (int i = 0; i < 8; ++i) {
    const double angle = i % 2 == 0 ? 0 : between(random, 0, 6.28), line = between(random, -45, 45);
    const double x = between(random, -2, 2), y = between(random, -2, 2);
    const std::string force = fmt::format(
        "force = if {:.9f} * x + {:.9f} * y > {} mm then vector({} N, {} N) else vector(0 N, 0 N)", std::cos(angle),
        std::sin(angle), line, x, y);
    const ForceReading found = reading(force);
    ASSERT_EQ(found.steps.size(), 1u) << force;
    const StaticStep& step = found.steps.front();
    const double same = std::copysign(1, std::cos(angle) * step.way.x + std::sin(angle) * step.way.y);
    EXPECT_EQ(step.width, 0) << force;
    EXPECT_NEAR(same * step.offset, 1e-3 * line, 2e-6) << force;
    EXPECT_NEAR(same * step.change.x, x, 1e-3) << force;
    EXPECT_NEAR(same * step.change.y, y, 1e-3) << force;
  }
  // A step over a millimetre is none that jumps.
  const ForceReading wide = reading("force = vector(1 N * smoothstep((x - 5 mm) / 2 mm), 0 N)");
  ASSERT_EQ(wide.steps.size(), 1u);
  EXPECT_GT(wide.steps.front().width, 0.2e-3);
}

TEST(ByPlace, AWallIsAsStiffInPrintAsItIsRead) {
  static const auto common = common_modules();
  for (const std::string beside :
       {"vector(-600 N/m * stretch(x, 1.2 N / 600 N/m), 0 N)", "vibrate(1.5 N, rate: 52 Hz) + heavy(0.14 kg)",
        "sticky(0.4 N)", "vibrate(0.2 N, rate: 200 Hz)"}) {
    const Description told = describe(bank_of("force = firm(1468 N/m, face: 44 mm) + " + beside), common->declarations);
    ASSERT_TRUE(told.wall) << beside;
    EXPECT_NEAR(told.wall->face.stiffness, 1468, 15) << beside;
  }
}

// A row of detents with a stop.
TEST(ByPlace, AWallBesideASlowWaveIsAWall) {
  std::mt19937 random(17);
  for (int i = 0; i < 12; ++i) {
    const double angle = between(random, 0, 6.28), stiffness = between(random, 100, 600), face = between(random, 15, 60);
    const double period = between(random, 8, 20), size = between(random, 0.2, 1);
    const std::string force =
        "force = " + wall_along(angle, stiffness, face) +
        fmt::format(" + vector({} N * sin(2 * pi * {} / {} mm), 0 N)", size, i % 2 == 0 ? "x" : "y", period);
    const ForceReading found = reading(force);
    ASSERT_TRUE(found.wall) << force;
    EXPECT_NEAR(found.wall->stiffness, stiffness, 0.02 * stiffness) << force;
    EXPECT_NEAR(glm::length(found.wall->place), 1e-3 * face, 1e-3) << force;
    EXPECT_NEAR(found.relief().amplitude, size, 0.03 * size) << force;
    EXPECT_NEAR(found.relief().period, 1e-3 * period, 2e-5 * period) << force;
    EXPECT_NEAR(found.stiffness, 0, 2) << force;
  }
}

TEST(ByPlace, APushBesideAStiffWallIsAPush) {
  for (const auto [stiffness, push] : {std::pair(600, 0.3), {900, 0.3}, {600, 0.05}, {750, -0.2}}) {
    const std::string force = fmt::format(
        "force = vector(0.3 N * sin(2 * pi * x / 3 mm), 0 N) + vector({} N, 0 N) + firm({} N/m, face: 20 mm)", push,
        stiffness);
    const ForceReading found = reading(force);
    EXPECT_NEAR(found.relief().amplitude, 0.3, 0.01) << force;
    EXPECT_NEAR(found.constant.x, push, 0.01) << force;
  }
}

TEST(ByPlace, ARoundWallMayBeginWithAJump) {
  for (const auto [radius, from, stiffness] : {std::tuple(40, 1.5, 700), {35, 0.8, 300}, {50, 1.0, 200}}) {
    const std::string force = fmt::format(
        "force = (if length(hand) > {0} mm then (-({1} N + {2} N/m * (length(hand) - {0} mm))) * normalise(hand) "
        "else vector(0 N, 0 N)) limit 9 N",
        radius, from, stiffness);
    const ForceReading found = reading(force);
    ASSERT_TRUE(found.wall) << force;
    EXPECT_NEAR(found.wall->radius, 1e-3 * radius, 2e-4) << force;
    EXPECT_NEAR(found.wall->stiffness, stiffness, 0.02 * stiffness) << force;
    EXPECT_NEAR(found.wall->preload, from, 0.03 * from) << force;
    EXPECT_EQ(found.relief().amplitude, 0) << force;
  }
}

TEST(ByPlace, WhatStandsAtThePatchsEdgeIsReadWhole) {
  for (const double face : {72.0, 72.5, 73.0, 73.7, 74.0})
    for (const int stiffness : {200, 600}) {
      const std::string force = fmt::format("force = firm({} N/m, face: {} mm)", stiffness, face);
      const ForceReading found = reading(force);
      ASSERT_TRUE(found.wall) << force;
      EXPECT_NEAR(found.wall->stiffness, stiffness, 0.01 * stiffness) << force;
      EXPECT_NEAR(found.wall->place.x, 1e-3 * face, 1e-4) << force;
      EXPECT_NEAR(found.wall->preload, 0, 0.01) << force;
      EXPECT_EQ(found.relief().amplitude, 0) << force;
    }
  for (const double line : {70.0, 72.0, 73.0, 74.0}) {
    const std::string force = fmt::format("force = (if y < -{} mm then vector(0 N, 0.6 N) else vector(0 N, 0 N))", line);
    const ForceReading found = reading(force);
    ASSERT_EQ(found.steps.size(), 1u) << force;
    EXPECT_NEAR(glm::length(found.steps.front().change), 0.6, 0.01) << force;
    EXPECT_NEAR(std::abs(found.steps.front().offset), 1e-3 * line, 1e-4) << force;
    EXPECT_EQ(found.relief().amplitude, 0) << force;
  }
  const ForceReading corner = reading("force = " + wall_along(0.7853982, 300, 90));
  ASSERT_TRUE(corner.wall);
  EXPECT_NEAR(corner.wall->stiffness, 300, 3);
  EXPECT_EQ(corner.relief().amplitude, 0);
}

TEST(ByPlace, ASmallStepBesideAWallIsAStep) {
  std::mt19937 random(9);
  for (int i = 0; i < 8; ++i) {
    const double angle = between(random, 0, 6.28), stiffness = between(random, 300, 1400), face = between(random, 15, 35);
    const double line = between(random, -40, 10), size = between(random, 0.3, 1.6);
    const std::string force = "force = " + wall_along(angle, stiffness, face) +
                              fmt::format(" + (if x > {} mm then vector({} N, 0 N) else vector(0 N, 0 N))", line, size);
    const ForceReading found = reading(force);
    ASSERT_TRUE(found.wall) << force;
    EXPECT_NEAR(found.wall->stiffness, stiffness, 0.01 * stiffness) << force;
    ASSERT_EQ(found.steps.size(), 1u) << force;
    EXPECT_NEAR(glm::length(found.steps.front().change), size, 0.01 * size) << force;
    EXPECT_EQ(found.relief().amplitude, 0) << force;
    EXPECT_NEAR(found.stiffness, 0, 2) << force;
  }
}

TEST(ByPlace, ALimitedSpringIsOneBesideAWallAWaveOrAStep) {
  std::mt19937 random(13);
  for (int i = 0; i < 9; ++i) {
    const double stiffness = between(random, 60, 200), limit = between(random, 0.6, 2);
    const double wall = between(random, 400, 1200), face = between(random, 17, 45);
    const std::string beside =
        i % 3 == 0   ? wall_along(between(random, 0, 6.28), wall, face)
        : i % 3 == 1 ? fmt::format("vector(0.5 N * sin(2 * pi * x / {} mm), 0 N)", between(random, 4, 30))
                     : fmt::format("(if x > {} mm then vector({} N, 0 N) else vector(0 N, 0 N))",
                                   between(random, -40, 40), between(random, 0.4, 1.5));
    const std::string force = fmt::format("force s0 = spring({} N/m) limit {} N\nforce s1 = ", stiffness, limit) + beside;
    const ForceReading found = reading(force);
    EXPECT_NEAR(found.stiffness, stiffness, 0.02 * stiffness) << force;
    EXPECT_NEAR(found.cut_spring(), limit, 0.01) << force;
    EXPECT_NEAR(found.relief().amplitude, i % 3 == 1 ? 0.5 : 0, 0.01) << force;
    EXPECT_EQ(found.wall.has_value(), i % 3 == 0) << force;
    if (found.wall) {
      EXPECT_NEAR(found.wall->stiffness, wall, 0.01 * wall) << force;
    }
    EXPECT_EQ(found.steps.size(), i % 3 == 2 ? 1u : 0u) << force;
  }
}

TEST(ByPlace, TwoWallsThatFaceOneWayAreTwo) {
  const ForceReading found =
      reading("force = " + wall_along(0, 226.1, 32.929) + " + (" + wall_along(0, 659.88, 47.371) + ")");
  ASSERT_TRUE(found.wall);
  ASSERT_EQ(found.more_walls.size(), 1u);
  EXPECT_NEAR(found.wall->stiffness, 659.88, 1);
  EXPECT_NEAR(found.more_walls.front().stiffness, 226.1, 1);
  EXPECT_TRUE(found.steps.empty());
  EXPECT_EQ(found.relief().amplitude, 0);
}

}  // namespace
}  // namespace wale::by_place_test
