// Walls and springs that their author limits are told by the law below the limit; closed forms.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "compiler/modules/load_modules.hpp"
#include "compiler/read/read.hpp"
#include "tests/standard/standard.hpp"

namespace wale::limits_test {
namespace {

constexpr double exact = 0.03, a_quarter_mm = 2.5e-4;

ForceReading reading(const std::string& force) {
  static const auto common = common_modules();
  const Bank bank(standard::material("material m { physical {\nactive 9 W\nforce = " + force + "\n} }", "m"));
  return read(bank, common->declarations);
}

double between(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<>(low, high)(random);
}

TEST(Limits, OfARoundWallLeaveItRound) {
  std::mt19937 random(11);
  for (int i = 0; i < 8; ++i) {
    const double radius = between(random, 15, 50), stiffness = between(random, 300, 800);
    const double limit = between(random, 1, 5), x = i % 2 * between(random, -8, 8), y = i % 2 * between(random, -8, 8);
    const std::string off = fmt::format("(hand - vector({} mm, {} mm))", x, y);
    const std::string force = fmt::format(
        "(if length({0}) > {1} mm then -{2} N/m * (length({0}) - {1} mm) * normalise({0}) else vector(0 N, 0 N)) limit "
        "{3} N",
        off, radius, stiffness, limit);
    const ForceReading found = reading(force);
    ASSERT_TRUE(found.wall) << force;
    EXPECT_NEAR(found.wall->radius, 1e-3 * radius, exact * 1e-3 * radius) << force;
    EXPECT_NEAR(found.wall->centre.x, 1e-3 * x, a_quarter_mm) << force;
    EXPECT_NEAR(found.wall->centre.y, 1e-3 * y, a_quarter_mm) << force;
    EXPECT_NEAR(found.wall->stiffness, stiffness, exact * stiffness) << force;
    EXPECT_EQ(found.relief().amplitude, 0) << force;
  }
}

TEST(Limits, OfSpringsAndWallsAreNoBumps) {
  std::mt19937 random(12);
  for (int i = 0; i < 8; ++i) {
    const double x = between(random, 100, 400), y = x * between(random, 0.2, 0.8), limit = between(random, 1, 5);
    const std::string spring = fmt::format("-vector({} N/m * x, {} N/m * y) limit {} N", x, y, limit);
    const ForceReading found = reading(spring);
    EXPECT_NEAR(found.stiffness, x, exact * x) << spring;
    EXPECT_NEAR(found.stiffness_across, y, exact * y) << spring;
    EXPECT_NEAR(found.cut_spring(), limit, exact * limit) << spring;
    EXPECT_FALSE(found.wall) << spring;
    EXPECT_TRUE(found.steps.empty()) << spring;
    EXPECT_EQ(found.relief().amplitude, 0) << spring;

    const double place = between(random, -30, 40);
    const std::string wall = fmt::format("firm({} N/m, face: {} mm) limit {} N", x, place, limit);
    const ForceReading behind = reading(wall);
    ASSERT_TRUE(behind.wall) << wall;
    EXPECT_NEAR(behind.wall->stiffness, x, exact * x) << wall;
    EXPECT_NEAR(behind.wall->place.x, 1e-3 * place, a_quarter_mm) << wall;
    EXPECT_NEAR(behind.wall_push, limit, exact * limit) << wall;
    EXPECT_TRUE(behind.steps.empty() && behind.more_walls.empty()) << wall;
    EXPECT_EQ(behind.relief().amplitude, 0) << wall;
  }
}

TEST(Limits, OfSpringsAlongAnAxisAreNoSteps) {
  std::mt19937 random(21);
  for (int i = 0; i < 10; ++i) {
    const double stiffness = std::exp(between(random, std::log(60.0), std::log(600.0)));
    const double limit = between(random, 0.15, 0.7) * stiffness * 0.07, off = i % 3 == 2 ? between(random, -10, 10) : 0;
    const double angle = i % 4 == 3 ? between(random, 0.2, 1.3) : 0;
    const std::string u = fmt::format("(x * {} + y * {} - {} mm)", std::cos(angle), std::sin(angle), off);
    const std::string way = fmt::format("vector({}, {})", std::cos(angle), std::sin(angle));
    const std::string spellings[] = {
        fmt::format("{} * clamp(-{} N/m * {}, -{} N, {} N)", way, stiffness, u, limit, limit),
        fmt::format("-{} N/m * clamp({}, -{} m, {} m) * {}", stiffness, u, limit / stiffness, limit / stiffness, way),
        fmt::format("{} * max(min(-{} N/m * {}, {} N), -{} N)", way, stiffness, u, limit, limit)};
    for (const std::string& spring : spellings) {
      for (const std::string beside : {"", " + lateral(sin(2 pi * x / 3 mm), amplitude: 0.5 N)", " + viscous(2 N s/m)"}) {
        const ForceReading found = reading(spring + beside);
        EXPECT_NEAR(found.stiffness, stiffness, exact * stiffness) << spring << beside;
        EXPECT_NEAR(found.stiffness_across, 0, exact * stiffness) << spring << beside;
        EXPECT_NEAR(found.cut_spring(), limit, exact * limit) << spring << beside;
        EXPECT_TRUE(found.steps.empty() && !found.wall) << spring << beside;
        EXPECT_NEAR(found.relief().amplitude, beside.find("lateral") != beside.npos ? 0.5 : 0, 0.02) << spring << beside;
      }
    }
  }
}

TEST(Limits, OfAWaveIsItsShape) {
  for (const double period : {3.0, 12.0, 40.0, 160.0}) {
    const std::string wave = fmt::format("vector(clamp(1.5 N * sin(2 pi * x / {} mm), -1 N, 1 N), 0 N)", period);
    const ForceReading found = reading(wave);
    EXPECT_EQ(found.cut_spring(), 0) << wave;
    if (period < 50) {
      EXPECT_NEAR(found.relief().amplitude, 1, 0.03) << wave;
      EXPECT_NEAR(found.relief().period, 1e-3 * period, 1e-5 * period) << wave;
    }
  }
}

TEST(Obstacles, ThatJumpLeaveNoSmallFeature) {
  std::mt19937 random(13);
  for (int i = 0; i < 8; ++i) {
    const double place = between(random, -30, 30), jump = between(random, 0.5, 3), stiffness = between(random, 80, 800);
    const std::string force =
        fmt::format("vector(if x > {0} mm then -{1} N - {2} N/m * (x - {0} mm) else 0 N, 0 N)", place, jump, stiffness);
    const ForceReading found = reading(force);
    ASSERT_TRUE(found.wall) << force;
    EXPECT_NEAR(found.wall->place.x, 1e-3 * place, a_quarter_mm) << force;
    EXPECT_EQ(found.relief().small_feature(), 0) << force;
    EXPECT_EQ(found.relief().amplitude, 0) << force;
  }
}

TEST(Obstacles, AWallAloneHidesNoConstantPush) {
  std::mt19937 random(14);
  for (int i = 0; i < 8; ++i) {
    const double x = between(random, -0.3, 0.3), y = between(random, 0.1, 0.3);
    const std::string force = fmt::format("firm({} N/m, face: {} mm) + vector({} N, {} N)", between(random, 300, 900),
                                          between(random, 0, 40), x, y);
    const ForceReading found = reading(force);
    EXPECT_NEAR(found.constant.x, x, 0.01) << force;
    EXPECT_NEAR(found.constant.y, y, 0.01) << force;
    EXPECT_TRUE(found.wall && found.relief().amplitude == 0) << force;
  }
}

TEST(Obstacles, AStepIsToldWhereverItIs) {
  std::mt19937 random(15);
  for (const double place : {14.0, 13.0, 44.0, -18.4, between(random, -45, 45), between(random, -45, 45)})
    for (const std::string beside : {"", "sticky(0.5 N) + "}) {
      const double push = std::copysign(between(random, 0.3, 2), between(random, -1, 1));
      const std::string force = beside + fmt::format("vector(if x > {} mm then {} N else 0 N, 0 N)", place, push);
      const ForceReading found = reading(force);
      ASSERT_EQ(found.steps.size(), 1u) << force;
      EXPECT_NEAR(found.steps.front().change.x * found.steps.front().way.x, push, exact * std::abs(push)) << force;
      EXPECT_NEAR(found.steps.front().offset * found.steps.front().way.x, 1e-3 * place, a_quarter_mm) << force;
    }
}

/// A law with a limit of its own, beside other forces.
ForceReading beside(const std::string& limited, const std::string& other) {
  static const auto common = common_modules();
  const Bank bank(standard::material(
      "material m { physical {\nactive 9 W\nforce law = " + limited + "\nforce other = " + other + "\n} }", "m"));
  return read(bank, common->declarations);
}

TEST(Limits, OfOneOfSeveralForcesLeaveItsLawAndTheOthers) {
  std::mt19937 random(13);
  for (int i = 0; i < 6; ++i) {
    const double stiffness = between(random, 150, 600), limit = between(random, 1, 4), face = between(random, -20, 40);
    const double size = between(random, 0.4, 1.5), period = between(random, 1, 5), damping = between(random, 1, 4);
    const std::string wall = fmt::format("firm({} N/m, face: {} mm) limit {} N", stiffness, face, limit);
    const std::string spring = fmt::format("spring({} N/m) limit {} N", stiffness, limit);
    for (const bool drags : {false, true}) {
      const std::string other = drags ? fmt::format("viscous({} N s/m)", damping)
                                      : fmt::format("lateral(cos(2 pi * x / {} mm), amplitude: {} N)", period, size);
      const ForceReading behind = beside(wall, other), drawn = beside(spring, other);
      ASSERT_TRUE(behind.wall) << wall << other;
      EXPECT_NEAR(behind.wall->stiffness, stiffness, exact * stiffness) << wall << other;
      EXPECT_NEAR(behind.wall->place.x, 1e-3 * face, a_quarter_mm) << wall << other;
      EXPECT_TRUE(behind.steps.empty() && behind.more_walls.empty()) << wall << other;
      EXPECT_NEAR(drawn.stiffness, stiffness, exact * stiffness) << spring << other;
      EXPECT_NEAR(drawn.cut_spring(), limit, exact * limit) << spring << other;
      EXPECT_FALSE(drawn.wall) << spring << other;
      for (const ForceReading* found : {&behind, &drawn}) {
        EXPECT_NEAR(found->relief().amplitude, drags ? 0 : size, exact * size) << spring << wall << other;
        EXPECT_NEAR(found->relief().period, drags ? 0 : 1e-3 * period, 2e-5 * period) << spring << wall << other;
      }
      EXPECT_NEAR(drawn.opposing.damping, drags ? damping : 0, exact * damping) << spring << other;
    }
  }
}

TEST(Limits, OfATextureBesideASpringLeaveItAsItIsFelt) {
  // What is cut off is no law that goes on.
  const ForceReading found = beside("vector(3 N * sin(2 pi * x / 6 mm), 0 N) limit 1.5 N", "spring(20 N/m)");
  EXPECT_NEAR(found.relief().amplitude, 1.5, exact * 1.5);
  EXPECT_NEAR(found.stiffness, 20, exact * 20);
}

}  // namespace
}  // namespace wale::limits_test
