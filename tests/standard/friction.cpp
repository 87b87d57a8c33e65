// Friction against the formulas of its authors.
#include "tests/standard/standard.hpp"

namespace wale::standard::friction_test {
namespace {

TEST(CoulombFromVelocity, IsAgainstTheMotionAndNoLargerThanItsMagnitude) {
  Field field(pushing("std.friction", "coulomb(0.7 N, rise: 5 N s/m)"));
  Chance chance(1);
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec2 way = chance.direction();
    const double speed = std::pow(10, chance.between(-4, -0.05));
    const glm::dvec2 force = field(chance.place(0.05), speed * way), expected = -std::min(0.7, 5 * speed) * way;
    EXPECT_NEAR(glm::distance(force, expected), 0, 1e-5) << speed;
  }
  EXPECT_EQ(field({0, 0}), glm::dvec2(0, 0));
}

TEST(Stribeck, FallsFromStaticToCoulombAsAGaussian) {
  Field field(pushing("std.friction", "vector(stribeck(length(velocity), 0.4 N, 1.1 N, knee: 40 mm/s), 0 N)"));
  for (double speed : {0.0, 0.01, 0.03, 0.04, 0.08, 0.3})
    EXPECT_NEAR(field({0, 0}, {0, speed}).x, 0.4 + 0.7 * std::exp(-speed * speed / 0.0016), 1e-6);
}

TEST(CoulombFriction, IsASpringAndThenDragsWithItsMagnitude) {
  Chance chance(2);
  for (int i = 0; i < 40; ++i) {
    const glm::dvec2 start = chance.place(0.03), way = chance.direction();
    Stroke stroke(made("std.friction", "coulomb_friction", "coulomb: 0.8 N, stiffness: 400 N/m"), start);
    EXPECT_EQ(stroke.force(), glm::dvec2(0));
    stroke.line(start + 0.001 * way, 0.05);  // 1 mm of 2 mm, as a spring
    EXPECT_NEAR(glm::distance(stroke.force(), -0.4 * way), 0, 1e-4);
    stroke.line(start, 0.05);  // no energy is lost
    EXPECT_NEAR(glm::length(stroke.force()), 0, 1e-4);
    EXPECT_NEAR(stroke.work(), 0, 1e-7);
    for (double speed : {0.02, 0.1, 0.6}) {
      stroke.line(stroke.place() + 0.015 * way, speed);
      EXPECT_NEAR(glm::distance(stroke.force(), -0.8 * way), 0, 1e-4) << speed;
    }
  }
}

TEST(CoulombFriction, HoldsAConstantForceForAMinute) {
  Stroke stroke(made("std.friction", "coulomb_friction"));
  stroke.line({0.01, 0.004}, 0.1);
  stroke.line({0.0095, 0.004}, 0.1);
  const glm::dvec2 held = stroke.force();
  for (int i = 0; i < 60 * 900; ++i) stroke.move(stroke.place());
  EXPECT_NEAR(glm::distance(stroke.force(), held), 0, 1e-5);
}

TEST(KarnoppFriction, SticksBelowBreakAwayAndSlipsAbove) {
  const Program program =
      made("std.friction", "karnopp_friction",
           "static: 1.2 N, coulomb: 0.5 N, viscosity: 2 N s/m, stiffness: 600 N/m, dead_zone: 15 mm/s");
  Stroke stroke(program);
  const glm::dvec2 way{0.6, 0.8};
  stroke.line(0.0019 * way, 0.05);  // it breaks at 1.2 N / 600 N/m = 2 mm
  EXPECT_NEAR(glm::distance(stroke.force(), -0.0019 * 600 * way), 0, 1e-4);
  stroke.line(0.0001 * way, 0.05);
  EXPECT_NEAR(glm::distance(stroke.force(), -0.0001 * 600 * way), 0, 1e-4);
  stroke.line(0.02 * way, 0.1);
  EXPECT_NEAR(glm::distance(stroke.force(), -(0.5 + 2 * 0.1) * way), 0, 2e-3);
  stroke.move(stroke.place());  // stopped: the bent bristle remains, and holds up to the static force again
  EXPECT_NEAR(glm::distance(stroke.force(), -0.5 * way), 0, 1e-4);
  stroke.line(stroke.place() + 0.001 * way, 0.01);
  EXPECT_NEAR(glm::distance(stroke.force(), -(0.5 + 0.001 * 600) * way), 0, 1e-4);
}

TEST(KarnoppFriction, ASlowHandSticksAndSlips) {
  Stroke stroke(made("std.friction", "karnopp_friction",
                     "static: 1.2 N, coulomb: 0.6 N, viscosity: 0 N s/m, stiffness: 600 N/m, dead_zone: 15 mm/s"));
  // At 5 mm/s every slip releases 0.6 N, and 0.6 N / 600 N/m = 1 mm of motion builds it up again.
  int slips = 0;
  double largest = 0, before = 0;
  for (double way = 0; way < 0.0405; way += 0.005 * seconds_per_tick) {
    const double force = -stroke.move({way, 0}).x;
    if (force < before - 0.3) {
      ++slips;
      EXPECT_NEAR(before, 1.2, 0.01);
      EXPECT_NEAR(force, 0.6, 0.01);
    }
    largest = std::max(largest, force);
    before = force;
  }
  EXPECT_NEAR(slips, 39, 1);
  EXPECT_LE(largest, 1.2001);
}

TEST(DahlFriction, FollowsTheClosedFormFromRestAtAnySpeed) {
  constexpr double coulomb = 0.8, stiffness = 400;
  for (double speed : {0.01, 0.1, 0.9}) {
    Stroke stroke(made("std.friction", "dahl_friction", "coulomb: 0.8 N, stiffness: 400 N/m"), {-0.02, 0});
    for (double way = 0; way < 0.04; way += speed * seconds_per_tick) {
      stroke.move({-0.02 + way, 0});
      ASSERT_NEAR(-stroke.force().x, coulomb * (1 - std::exp(-stiffness * way / coulomb)), 1e-4) << speed << " " << way;
    }
    EXPECT_NEAR(-stroke.force().x, coulomb, 1e-3);
  }
}

TEST(DahlFriction, TurnsBackAlongItsHysteresisLoop) {
  constexpr double coulomb = 0.8, stiffness = 400;
  Stroke stroke(made("std.friction", "dahl_friction", "coulomb: 0.8 N, stiffness: 400 N/m"), {-0.04, 0});
  stroke.line({0, 0}, 0.1);  // saturated
  for (int i = 1; i <= 60; ++i) {
    stroke.move({-0.0001 * i, 0});
    const double way = 0.0001 * i;
    EXPECT_NEAR(-stroke.force().x, coulomb * (2 * std::exp(-stiffness * way / coulomb) - 1), 2e-4) << way;
  }
  // A steady loop between -a and a has the upper branch z = Fc (1 - c exp(-s (x + a) / Fc)) with z(-a) = -z(a), so
  // c = 2 / (1 + exp(-2 a s / Fc)). Its area is the work of one loop.
  constexpr double a = 0.001;
  for (int i = 0; i < 20; ++i) stroke.line({i % 2 == 0 ? a : -a, 0}, 0.01);
  const double before = stroke.work();
  stroke.line({a, 0}, 0.01);
  stroke.line({-a, 0}, 0.01);
  const double e = std::exp(-2 * a * stiffness / coulomb), c = 2 / (1 + e);
  const double area = 2 * coulomb * (2 * a - c * coulomb / stiffness * (1 - e));
  EXPECT_NEAR(stroke.work() - before, area, 0.002 * area);
}

TEST(StribeckFriction, DragsAccordingToItsSpeed) {
  const Program program =
      made("std.friction", "stribeck_friction", "static: 1 N, coulomb: 0.4 N, knee: 50 mm/s, viscosity: 2 N s/m");
  for (double speed : {0.02, 0.05, 0.1, 0.3}) {
    Stroke stroke(program, {-0.03, 0});
    stroke.line({0.03, 0}, speed);
    const double expected = 0.4 + 0.6 * std::exp(-speed * speed / 0.0025) + 2 * speed;
    EXPECT_NEAR(-stroke.force().x, expected, 0.01) << speed;
  }
}

struct FrictionCase {
  const char *module, *name;
  double strongest, stiffness;  // of its bristle at the defaults, N and N/m
};

class Frictions : public testing::TestWithParam<FrictionCase> {};

TEST_P(Frictions, NeverGiveBackMoreThanABentBristleHolds) {
  const auto [module, name, strongest, stiffness] = GetParam();
  for (double phase : {0.0, 1.0, 2.5}) {
    Stroke stroke(made(module, name), wandering(0, phase));
    double lowest = 0, so_far = 0;
    for (int i = 1; i < 10 * 900; ++i) {
      stroke.move(wandering(i * seconds_per_tick, phase));
      so_far = std::max(so_far, stroke.work());
      lowest = std::min(lowest, stroke.work() - so_far);
    }
    EXPECT_GT(stroke.work(), 0.05);  // about 1 m at a few tenths of a newton
    EXPECT_GT(lowest, -1.01 * strongest * strongest / (2 * stiffness));
  }
}

TEST_P(Frictions, DoNotPushAHandThatIsSetDown) {
  Chance chance(3);
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(Stroke(made(GetParam().module, GetParam().name), chance.place(0.07)).force(), glm::dvec2(0));
}

INSTANTIATE_TEST_SUITE_P(Standard, Frictions,
                         testing::Values(FrictionCase{"std.friction", "coulomb_friction", 0.7, 500},
                                         FrictionCase{"std.friction", "karnopp_friction", 1.2, 600},
                                         FrictionCase{"std.friction", "dahl_friction", 0.8, 400},
                                         FrictionCase{"std.friction", "stribeck_friction", 1.1, 500},
                                         FrictionCase{"std.nap", "napped_cloth", 1.2, 400},
                                         FrictionCase{"std.nap", "brushed_pile", 1.3, 400},
                                         FrictionCase{"std.solid", "solid_noise", 1.8, 400}),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace wale::standard::friction_test
