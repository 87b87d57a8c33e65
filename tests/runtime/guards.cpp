#include "runtime/stage/guards.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <random>

#include "tests/runtime/figures.hpp"

namespace wale::guards_test {
namespace {

constexpr float step = 200.0f / 900;  // N per tick

/// The force after the guards, with the handle at rest.
Force at(Guards& guards, Force wanted) {
  const Force force = guards(wanted, glm::dvec2(0), 1);
  guards.commanded(force);
  return force;
}

/// Guards that have finished slewing to `force`.
Guards at_ease(Force force = Force(0)) {
  Guards guards(sandpaper());
  for (int tick = 0; tick < 200; ++tick) at(guards, force);
  return guards;
}

TEST(Guards, PassAForceInRange) {
  Guards guards = at_ease();
  const GuardCounts before = guards.counts();
  EXPECT_EQ(at(guards, {3, -4}), Force(3, -4));
  EXPECT_EQ(at(guards, {-10, 10}), Force(-10, 10));
  EXPECT_EQ(guards.counts().not_a_number, before.not_a_number);
  EXPECT_EQ(guards.counts().device_limit, before.device_limit);
  EXPECT_EQ(guards.counts().slew, before.slew);
}

TEST(Guards, NotANumberIsNoForceAtOnce) {
  Guards guards = at_ease({5, 5});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(at(guards, {nan, 5}), Force(0));
  EXPECT_EQ(at(guards, {5, -nan}), Force(0));
  EXPECT_EQ(guards.counts().not_a_number, 2);
}

TEST(Guards, EachAxisStaysWithinTheDevicesPeak) {
  Guards guards = at_ease();
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(at(guards, {11, -3}), Force(10, -3));
  EXPECT_EQ(at(guards, {-infinity, infinity}), Force(-10, 10));
  EXPECT_EQ(guards.counts().device_limit, 2);
}

TEST(Guards, TheForceStaysWithinTheUsersLimit) {
  Guards guards(sandpaper(), 3);
  for (int tick = 0; tick < 200; ++tick) at(guards, {1.79f, 2.39f});
  EXPECT_EQ(guards.counts().user_limit, 0);
  const Force held = at(guards, {6, -8});
  const auto step_of_device = static_cast<float>(sandpaper().force_step());
  EXPECT_NEAR(held.x, 1.8f, step_of_device);  // toward zero, so that the device's rounding exceeds nothing
  EXPECT_NEAR(held.y, -2.4f, step_of_device);
  EXPECT_LE(glm::length(held), 3);
  EXPECT_EQ(guards.counts().user_limit, 1);
}

TEST(Guards, SlewFromTheStartUntilCaughtUp) {
  Guards guards(sandpaper());
  for (int tick = 1; tick <= 9; ++tick) EXPECT_NEAR(at(guards, {0, 2.1f}).y, tick * step, 1e-5) << tick;
  EXPECT_EQ(at(guards, {0, 2.1f}), Force(0, 2.1f));
  EXPECT_EQ(guards.counts().slew, 9);
  EXPECT_EQ(at(guards, {0, -9}), Force(0, -9)) << "after the slew, fast changes pass";
  EXPECT_EQ(guards.counts().slew, 9);
}

TEST(Guards, SlewAgainAfterEachChangeAlsoAcrossAxes) {
  Guards guards = at_ease({3, 0});
  guards.slew();
  const Force next = at(guards, {0, 4});  // 5 N away
  EXPECT_NEAR(next.x, 3 - step * 0.6f, 1e-5);
  EXPECT_NEAR(next.y, step * 0.8f, 1e-5);
}

TEST(Guards, SlewingToAMovingForceEndsWhenItIsReached) {
  Guards guards(sandpaper());
  float last = 0;
  for (int tick = 0; tick < 400; ++tick) {
    const float wanted = 2 * std::sin(static_cast<float>(tick) * 0.02f) + 3;
    const float force = at(guards, {wanted, 0}).x;
    ASSERT_LE(std::abs(force - last), step * 1.0001f);
    if (tick > 60) {
      ASSERT_EQ(force, wanted);
    }
    last = force;
  }
}

TEST(Guards, SlewingEndsWhenAFastForceComesPast) {
  // The wanted force goes to and fro by far more than a step at each tick, and is never near the commanded one.
  for (const float offset : {0.0f, 3.0f}) {
    Guards guards(sandpaper());
    at(guards, {0, 0});
    guards.slew();
    Force wanted{0};
    int ticks = 0;
    for (; ticks < 40; ++ticks) {
      wanted = Force(offset + (ticks % 2 == 0 ? 2.5f : -2.5f), 0);
      if (at(guards, wanted) == wanted) break;
    }
    EXPECT_LT(ticks, 4 + offset / step) << offset;
    for (int i = 0; i < 10; ++i) {
      wanted = Force(offset + (i % 2 == 0 ? 2.5f : -2.5f), 1);
      EXPECT_EQ(at(guards, wanted), wanted);
    }
  }
}

TEST(Guards, TheLastStepOfSlewingIsNoLargerThanThatOfTheWantedForce) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> newton(-6, 6);
  for (int run = 0; run < 500; ++run) {
    Guards guards(sandpaper());
    Force wanted(newton(random), newton(random));
    Force commanded = at(guards, wanted);
    for (int tick = 0; tick < 30; ++tick) {
      const Force next = wanted + 0.4f * Force(newton(random), newton(random)), clamped = glm::clamp(next, -8.0f, 8.0f);
      const Force given = at(guards, clamped);
      const float own = glm::length(clamped - wanted), changed = glm::length(given - commanded);
      EXPECT_LE(changed, std::max(own, step) + 1e-4f) << "run " << run << ", tick " << tick;
      wanted = clamped, commanded = given;
    }
  }
}

TEST(Guards, WithoutADeclaredSlewForcesPass) {
  DeviceProfile profile = sandpaper();
  profile.slew = 0;
  Guards guards(profile);
  EXPECT_EQ(at(guards, {7, 0}), Force(7, 0));
  guards.slew();
  EXPECT_EQ(at(guards, {-7, 0}), Force(-7, 0));
  EXPECT_EQ(guards.counts().slew, 0);
}

}  // namespace
}  // namespace wale::guards_test
