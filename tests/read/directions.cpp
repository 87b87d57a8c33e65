// Walls that the device's limit cuts off, what resists along one axis, and what neither a wall nor a texture explains.

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "compiler/modules/load_modules.hpp"
#include "compiler/read/cues.hpp"
#include "tests/standard/standard.hpp"

namespace wale::read_test {
namespace {

ForceReading found_in(const std::string& statements) {
  static const auto common = common_modules();
  return read(Bank(standard::material("material m { physical {\n" + statements + "\n} }", "m")), common->declarations);
}

void expect_wall(const ForceReading& found, double face, double stiffness, const std::string& of) {
  ASSERT_TRUE(found.wall) << of;
  EXPECT_NEAR(found.wall->stiffness, stiffness, 0.01 * stiffness) << of;
  EXPECT_NEAR(glm::dot(found.wall->place, found.wall->inward), face, 0.2e-3) << of;
  EXPECT_GT(found.wall->inward.x, 0.99999) << of;
}

TEST(ReadingDirections, AWallThatTheDeviceCutsOffIsThatWall) {
  const std::string ribs = " + lateral(grating(x, period: 3 mm), amplitude: 1 N)";
  for (const std::string beside : {"", " + spring(30 N/m)", " + vector(1 N, 0 N)", " - 2 N s/m * velocity"}) {
    const ForceReading plain = found_in("force = firm(500 N/m)" + beside);
    expect_wall(plain, 20e-3, 500, beside);
    EXPECT_EQ(plain.relief().amplitude, 0) << beside;
    const ForceReading ribbed = found_in("force = firm(500 N/m)" + ribs + beside);
    expect_wall(ribbed, 20e-3, 500, beside);
    EXPECT_NEAR(ribbed.relief().amplitude, 1, 0.03) << beside;
    EXPECT_NEAR(ribbed.relief().period, 3e-3, 0.03e-3) << beside;
  }
  expect_wall(found_in("force = firm(500 N/m, face: 70 mm)"), 70e-3, 500, "near the rim");
  const ForceReading pushing =
      found_in("force = if x > 20 mm then vector(-2 N - 500 N/m * (x - 20 mm), 0 N) else vector(0 N, 0 N)");
  expect_wall(pushing, 20e-3, 500, "with a preload");
  EXPECT_NEAR(pushing.wall->preload, 2, 0.05);
}

/// A wall that fills most of the patch takes all that the device gives; what resists shows in front of it.
TEST(ReadingDirections, AWallAtTheDevicesLimitHidesNoResistance) {
  for (const std::string wall : {"firm(910 N/m, face: -40 mm)", "-1800 N/m * (hand - vector(-46 mm, -51 mm))"}) {
    const ForceReading rubbing = found_in("force = " + wall + " + sticky(0.3 N)");
    EXPECT_NEAR(rubbing.opposing.friction, 0.3, 0.006) << wall;
    EXPECT_FALSE(rubbing.opposing.frictions().directed()) << wall;
    EXPECT_NEAR(found_in("force = " + wall + " - 2 N s/m * velocity").opposing.damping, 2, 0.02) << wall;
    EXPECT_NEAR(found_in("force = " + wall + " - 0.2 kg * acceleration").inertia.greatest, 0.2, 0.002) << wall;
  }
}

TEST(ReadingDirections, EveryWallIsAWall) {
  const ForceReading both =
      found_in("force = vector(-400 N/m * max(0 mm, x - 30 mm) + 700 N/m * max(0 mm, -40 mm - x), 0 N)");
  ASSERT_TRUE(both.wall);
  EXPECT_NEAR(both.wall->stiffness, 700, 7);
  EXPECT_NEAR(both.wall->place.x, -0.04, 0.2e-3);
  ASSERT_EQ(both.more_walls.size(), 1u);
  EXPECT_NEAR(both.more_walls[0].stiffness, 400, 4);
  EXPECT_NEAR(both.more_walls[0].place.x, 0.03, 0.2e-3);
  EXPECT_EQ(both.relief().amplitude, 0);
  const ForceReading round =
      found_in("let far = max(length(hand), 1 um)\nforce = -300 N/m * max(0 mm, far - 30 mm) * hand / far");
  ASSERT_TRUE(round.wall);
  EXPECT_NEAR(round.wall->stiffness, 300, 3);
  EXPECT_NEAR(round.wall->radius, 0.03, 0.2e-3);
  EXPECT_EQ(wall_place(*round.wall), "beyond 30 mm from (0, 0) mm, all round");
}

TEST(ReadingDirections, AStepBesideASpringAndRibsIsAStep) {
  const ForceReading found = found_in(
      "force a = -30 N/m * hand\nforce s = vector(if x > 10 mm then 1 N else 0 N, 0 N)\n"
      "force r = lateral(grating(y, period: 2.5 mm), amplitude: 0.8 N)");
  ASSERT_EQ(found.steps.size(), 1u);
  EXPECT_NEAR(glm::length(found.steps[0].change), 1, 0.02);
  EXPECT_NEAR(found.steps[0].offset, 0.01, 0.5e-3);
  EXPECT_NEAR(found.stiffness, 30, 0.5);
  EXPECT_NEAR(found.relief().amplitude, 0.8, 0.03);
  EXPECT_NEAR(found.relief().period, 2.5e-3, 0.03e-3);
  const ForceReading stairs = found_in("force = vector(1 N * floor(x / 13.7 mm), 0 N)");
  EXPECT_TRUE(stairs.steps.empty()) << "many equal ones are a sawtooth on a slope";
  EXPECT_NEAR(stairs.relief().period, 13.7e-3, 0.2e-3);
  EXPECT_NEAR(stairs.stiffness, -1 / 13.7e-3, 2);
}

TEST(ReadingDirections, ASpringThatRestsElsewhereIsASpringAndAPush) {
  const ForceReading found = found_in("force = spring(100 N/m, rest: vector(40 mm, 0 mm))");
  EXPECT_NEAR(found.stiffness, 100, 1);
  EXPECT_NEAR(found.constant.x, 4, 0.05);
  EXPECT_NEAR(found.constant.y, 0, 0.01);
  EXPECT_FALSE(found.wall);
}

TEST(ReadingDirections, WhatResistsAlongOneAxisHasItsPrincipalValues) {
  const Principal spring = found_in("force = vector(-50 N/m * x, -120 N/m * y)").stiffnesses();
  EXPECT_NEAR(spring.greatest, 120, 1);
  EXPECT_NEAR(spring.across, 50, 1);
  EXPECT_NEAR(std::abs(spring.axis.y), 1, 1e-3);
  const Principal viscous = found_in("force = vector(-3 N s/m * velocity.x, 0 N)").opposing.dampings();
  EXPECT_NEAR(viscous.greatest, 3, 0.03);
  EXPECT_NEAR(viscous.across, 0, 0.03);
  EXPECT_NEAR(std::abs(viscous.axis.x), 1, 1e-3);
  const Principal mass = found_in("force = vector(-0.05 kg * acceleration.x, 0 N)").inertia;
  EXPECT_NEAR(mass.greatest, 0.05, 5e-4);
  EXPECT_NEAR(mass.across, 0, 5e-4);
  const OpposingForce sliding = found_in("force = vector(-1 N * sign(velocity.x), 0 N)").opposing;
  EXPECT_NEAR(sliding.friction, 1, 0.01);
  EXPECT_NEAR(sliding.friction_across, 0, 0.01);
  EXPECT_NEAR(sliding.damping, 0, 0.05);
}

// Four lines over a friction that differs from place to place have unlike means by chance.
TEST(ReadingDirections, AFrictionThatDiffersByPlaceHasNoDirection) {
  EXPECT_FALSE(
      found_in("force = -(1 N + 0.5 N * noise2(x / 8 mm, y / 8 mm)) * velocity / max(1 mm/s, length(velocity))")
          .opposing.frictions()
          .directed());
}

// A line beside two stripes has a slope by chance.
TEST(ReadingDirections, StripesHaveNoStiffness) {
  const ForceReading found = found_in(
      "let one = (x + 14 mm) / 6 mm\nlet other = (x - 22 mm) / 6 mm\n"
      "force = vector(1 N * (one * exp(-one^2) + other * exp(-other^2)), 0 N)");
  EXPECT_EQ(found.stiffness, 0);
  EXPECT_GT(found.relief().amplitude, 0.3);
}

TEST(ReadingDirections, WhatDampsInAWallIsTheWallsAndNoViscosity) {
  const ForceReading viscous = found_in("force = firm(300 N/m) - 2 N s/m * velocity");
  EXPECT_NEAR(viscous.opposing.damping, 2, 0.02);
  EXPECT_NEAR(viscous.wall->damping, 0, 0.05);
  const ForceReading crisp = found_in("force = firm(300 N/m, face: -10 mm) + crisp(4 N s/m, face: -10 mm)");
  EXPECT_NEAR(crisp.wall->damping, 4, 0.1);
  EXPECT_NEAR(crisp.opposing.damping, 0, 0.05);
}

TEST(ReadingDirections, ASwingsSizeIsThe99thPercentileOfItsSize) {
  const ForceReading sine = found_in("active 2 W\nforce = vector(1 N * sin(2 * pi * 10 Hz * time), 0 N)");
  EXPECT_NEAR(sine.vibration.amplitude, 1, 0.01);
  const ForceReading square =
      found_in("active 2 W\nforce = vector(if fract(30 Hz * time) < 0.5 then 1 N else -1 N, 0 N)");
  EXPECT_NEAR(square.vibration.amplitude, 1, 0.02);
}

// Friction holds a hand that has stopped, and so does what has a memory of elsewhere.
TEST(ReadingDirections, WhatFrictionHoldsIsNoOtherForce) {
  EXPECT_LT(found_in("force = sticky(0.5 N)").other.largest(), 0.01);
  EXPECT_NEAR(found_in("active 2 W\nstate met = 0 in 0 .. 1\nnext met = if x > 20 mm then 1 else met\n"
                       "force = vector(3 N * met, 0 N)")
                  .other.remembered,
              3, 1e-3);
  EXPECT_NEAR(found_in("force = vector(if button then 8 N else 0 N, 0 N)").other.button, 8, 1e-3);
  EXPECT_NEAR(found_in("active 2 W\nforce = vector(if time > 1 s then 3 N else 0 N, 0 N)").other.slowly, 3, 1e-3);
  EXPECT_NEAR(found_in("force = 2 N s/m * perpendicular(velocity)").opposing.aside, 0.4, 0.01);
}

}  // namespace
}  // namespace wale::read_test
