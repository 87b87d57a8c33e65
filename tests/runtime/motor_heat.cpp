// The limit that keeps motors cool, against the closed form of first-order heating under a constant force, and against
// an independent integration.
#include "runtime/stage/motor_heat.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "runtime/stage/guards.hpp"
#include "tests/runtime/figures.hpp"

namespace wale::motor_heat_test {
namespace {

constexpr double continuous = 5, tau = 20;  // N, s

DeviceProfile rated() {
  DeviceProfile profile = sandpaper();
  profile.continuous_newton = continuous;
  profile.heating_seconds = tau;
  return profile;
}

/// r in the documentation of MotorHeat, in s: the time in which the force eases to the rating.
double easing(const DeviceProfile& profile) { return profile.force_newton / (2 * profile.slew); }

TEST(MotorHeat, UnderAConstantForceTheRatingIsReachedAtTheTimeOfTheClosedForm) {
  const DeviceProfile profile = rated();
  for (const double force : {10.0, 8.0, 5.5}) {
    SCOPED_TRACE(force);
    MotorHeat heat(profile);
    const double reached = -tau * std::log(1 - std::pow(continuous / force, 2));  // s
    double lowered = 0, last = force, fastest = 0;
    for (long tick = 0; tick < std::lround(3 * reached * profile.rate); ++tick) {
      heat.elapse(1);
      const Force held = heat.held_within({-force, 0});
      ASSERT_EQ(held.y, 0);
      if (held.x > -static_cast<float>(force) && lowered == 0) lowered = static_cast<double>(tick) / profile.rate;
      fastest = std::max(fastest, last + held.x);
      last = -held.x;
      heat.commanded(held);
      if (static_cast<double>(tick) / profile.rate > reached + 20 * easing(profile)) {
        ASSERT_NEAR(held.x, -continuous, 1e-5);
      }
    }
    EXPECT_NEAR(lowered, reached - easing(profile), 0.2 * easing(profile)) << "the force eases no sooner than needed";
    EXPECT_LE(fastest, profile.slew / profile.rate) << "the force eases no faster than a slew";
  }
}

TEST(MotorHeat, NeverExceedsTheRatingForAnyForce) {
  std::mt19937 random(1995);
  std::uniform_real_distribution<double> anything(-10, 10);
  for (const double slew : {200.0, 0.0, 20.0}) {
    DeviceProfile profile = rated();
    profile.slew = slew;
    profile.heating_seconds = slew == 20 ? 5 : 0.7;  // much longer than the easing
    MotorHeat heat(profile);
    glm::dvec2 hot(0), wanted(0), force(0);
    double hottest = 0, most = 0;
    for (long tick = 0; tick < 40'000; ++tick) {
      const long periods = slew > 0 && random() % 100 == 0 ? 1 + static_cast<long>(random() % 10) : 1;
      const double share = -std::expm1(-static_cast<double>(periods) / (profile.rate * profile.heating_seconds));
      hot += share * (force * force - hot);
      hottest = std::max({hottest, hot.x, hot.y});
      if (random() % 300 == 0) wanted = {anything(random) > 0 ? 10 : anything(random), anything(random)};
      heat.elapse(periods);
      ASSERT_NEAR(heat.heat().x, hot.x, 1e-8);
      force = heat.held_within(Force(wanted));
      for (int axis = 0; axis < 2; ++axis) {
        ASSERT_LE(std::abs(force[axis]), std::abs(wanted[axis]) * 1.000001);
        ASSERT_GE(force[axis] * wanted[axis], 0);
        if (std::abs(wanted[axis]) <= continuous) {
          ASSERT_FLOAT_EQ(static_cast<float>(force[axis]), static_cast<float>(wanted[axis]))
              << "the continuous force always passes";
        }
      }
      most = std::max(most, std::abs(force.x));
      heat.commanded(Force(force));
    }
    EXPECT_LE(hottest, continuous * continuous * (1 + 1e-6));
    EXPECT_GT(hottest, 0.9 * continuous * continuous);
    EXPECT_EQ(most, 10) << "a cold motor gets every force";
  }
}

TEST(MotorHeat, WithoutARatingForcesPass) {
  MotorHeat heat(sandpaper());
  for (int tick = 0; tick < 100'000; ++tick) {
    heat.elapse(1);
    ASSERT_EQ(heat.held_within({10, -10}), Force(10, -10));
    heat.commanded({10, -10});
  }
}

TEST(MotorHeat, IsCountedSeparatelyAndActsOnEachAxis) {
  DeviceProfile profile = rated();
  profile.slew = 0;
  profile.mass = 0;  // so that the passivity observer does not act
  Guards guards(profile);
  long held = 0;
  for (int tick = 0; tick < 9000; ++tick) {
    const Force force = guards({9, 4}, {0, 0}, 1);
    held += force.x < 9;
    ASSERT_EQ(force.y, 4);
    guards.commanded(force);
    if (tick == 8999) {
      EXPECT_NEAR(force.x, continuous, 1e-3);
    }
  }
  EXPECT_GT(held, 0);
  EXPECT_EQ(guards.counts().heat, held);
  EXPECT_EQ(guards.counts().device_limit + guards.counts().user_limit, 0);
}

}  // namespace
}  // namespace wale::motor_heat_test
