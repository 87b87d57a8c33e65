#include "wale/simulated.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "tests/runtime/figures.hpp"

namespace wale::simulated_test {
namespace {

constexpr double pi = std::numbers::pi;

/// The range of x in m, after two seconds of settling.
double sweep(const DeviceProfile& profile, double frequency) {
  SimulatedJoystick joystick(profile, normal_hand(), Lateral{0.04, frequency});
  joystick.elapse(1800);
  double low = 0, high = 0;
  for (int tick = 0; tick < 2700; ++tick) {
    joystick.elapse(1);
    low = std::min(low, joystick.position().x);
    high = std::max(high, joystick.position().x);
  }
  return high - low;
}

TEST(Simulated, FrictionShortensTheSweepByItsDescribingFunction) {
  EXPECT_NEAR(sweep(sandpaper(), 1), 0.099, 0.0005);  // tests/reference/closed_loop.md
  // At 2 Hz, near the resonance, the hand follows 40 mm with 67.0 mm; friction is 4/pi * 0.15 N against 94.2 N/m.
  EXPECT_NEAR(sweep(sandpaper(), 2), 2 * (0.0670 - 4 / pi * 0.15 / 94.2), 0.0003);
}

TEST(Simulated, WithoutFrictionTheSweepFollowsTheTransferFunction) {
  DeviceProfile profile = sandpaper();
  profile.friction = 0;
  for (const double frequency : {0.5, 1.0, 2.0}) {
    const double w = 2 * pi * frequency, k = 135, b = 6.5, all_b = 7.5, m = 0.85;
    const double gain = std::hypot(k, b * w) / std::hypot(k - m * w * w, all_b * w);
    EXPECT_NEAR(sweep(profile, frequency), 2 * 0.04 * gain, 2e-4 * gain) << frequency << " Hz";
  }
}

TEST(Simulated, FreeSwingHasTheFrequencyAndDecayOfMassSpringAndDamper) {
  DeviceProfile profile = sandpaper();
  profile.friction = 0;
  profile.damping = 0.2;
  // A constant force displaces the handle, which is then released.
  SimulatedJoystick joystick(profile, {.mass = 0.55, .damping = 0, .stiffness = 135}, Rest{});
  joystick.command({4, 0});
  joystick.elapse(90000);
  ASSERT_NEAR(joystick.position().x, 4 / 135.0, 2e-5);
  joystick.command({0, 0});
  const double m = 0.85, decay = 0.2 / (2 * m), w = std::sqrt(135 / m - decay * decay);
  const double x0 = joystick.position().x;
  for (int tick = 1; tick <= 1800; ++tick) {
    joystick.elapse(1);
    const double t = tick / profile.rate;
    const double x = x0 * std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t));
    ASSERT_NEAR(joystick.position().x, x, 2e-5) << "tick " << tick;
  }
}

/// A command of 2 N on a free mass: no motion during the delay, then a parabola.
TEST(Simulated, ACommandArrivesAfterTheDelayOfItsAxis) {
  DeviceProfile profile = sandpaper();
  profile.friction = profile.damping = 0;
  profile.delay_x = 0.0015;
  profile.delay_y = 0.004;
  SimulatedJoystick joystick(profile, no_hand, Rest{});
  for (int tick = 1; tick <= 60; ++tick) {
    joystick.command(tick <= 2 ? Force(2, 2) : Force(0));  // for two periods
    joystick.elapse(1);
    const auto way = [&](double delay) {
      const double t = tick / profile.rate - delay, pushed = std::clamp(t, 0.0, 2 / profile.rate);
      return 2 / 0.3 * (pushed * pushed / 2 + pushed * std::max(0.0, t - pushed));
    };
    ASSERT_NEAR(joystick.position().x, way(profile.delay_x), 1e-7 * tick) << tick;
    ASSERT_NEAR(joystick.position().y, way(profile.delay_y), 1e-7 * tick) << tick;
  }
}

/// A sine at the axis's bandwidth is attenuated by 3 dB.
TEST(Simulated, AnActuatorIsALowPassOfItsBandwidth) {
  DeviceProfile profile = sandpaper();
  profile.friction = profile.damping = 0;
  profile.bandwidth_x = 30;
  profile.force_counts = 1 << 26;
  const double mass = 1;
  SimulatedJoystick joystick(profile, {.mass = 0.7, .damping = 0, .stiffness = 0}, Rest{});
  double largest_x = 0, largest_y = 0;
  glm::dvec2 before = joystick.velocity();
  for (int tick = 0; tick < 900; ++tick) {
    joystick.command(Force(static_cast<float>(std::sin(2 * pi * 30 * tick / profile.rate))));
    joystick.elapse(1);
    const glm::dvec2 force = mass * (joystick.velocity() - before) * profile.rate;
    before = joystick.velocity();
    if (tick > 300) largest_x = std::max(largest_x, force.x), largest_y = std::max(largest_y, force.y);
  }
  EXPECT_NEAR(largest_x / largest_y, std::sqrt(0.5), 0.01);
}

TEST(Simulated, EnergyIsConservedWithoutDamping) {
  DeviceProfile profile = sandpaper();
  profile.friction = profile.damping = 0;
  SimulatedJoystick joystick(profile, {.mass = 0.55, .damping = 0, .stiffness = 135}, Rest{});
  joystick.command({4, -2});
  joystick.elapse(200);
  joystick.command({0, 0});
  const auto energy = [&] {
    const auto x = joystick.position(), v = joystick.velocity();
    return 0.5 * 135 * (x.x * x.x + x.y * x.y) + 0.5 * 0.85 * (v.x * v.x + v.y * v.y);
  };
  const double before = energy();
  ASSERT_GT(before, 0.01);
  for (int second = 0; second < 60; ++second) {
    joystick.elapse(900);
    EXPECT_NEAR(energy() / before, 1, 1e-3) << second << " s";
  }
}

TEST(Simulated, StictionHoldsBelowCoulombFrictionAndReleasesAbove) {
  const float step = 10.0f / 2048;  // otherwise rounding might lift it above friction
  SimulatedJoystick held(sandpaper(), no_hand, Rest{});
  held.command({0.149f - step, -0.149f + step});
  for (int tick = 0; tick < 900; ++tick) {
    held.elapse(1);
    ASSERT_EQ(held.position(), glm::dvec2(0));
    ASSERT_EQ(held.velocity(), glm::dvec2(0));
  }
  held.command({0.16f, 0});
  held.elapse(900);
  EXPECT_GT(held.position().x, 0.001);
  EXPECT_EQ(held.position().y, 0);
}

TEST(Simulated, FrictionStopsAPushedHandleForGood) {
  DeviceProfile profile = sandpaper();
  profile.damping = 0;
  SimulatedJoystick joystick(profile, no_hand, Rest{});
  joystick.command({1, 0});
  joystick.elapse(90);
  joystick.command({0, 0});
  const double speed = joystick.velocity().x, from = joystick.position().x;
  EXPECT_NEAR(speed, (1 - 0.15) / 0.3 * 0.1, 0.001);
  joystick.elapse(900);
  EXPECT_EQ(joystick.velocity().x, 0);
  EXPECT_NEAR(joystick.position().x - from, speed * speed * 0.3 / (2 * 0.15), 1e-5);  // v^2 m / 2 F
  const auto rest = joystick.position();
  joystick.elapse(900);
  EXPECT_EQ(joystick.position(), rest);
}

TEST(Simulated, ForceIsQuantisedClampedAndHeld) {
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Rest{});
  const float step = 10.0f / 2048;
  EXPECT_FLOAT_EQ(joystick.command({1.934f, 0}).x, std::round(1.934f / step) * step);
  EXPECT_EQ(joystick.command({25, -25}), Force(10, -10));
  EXPECT_EQ(joystick.command({step * 0.49f, -step * 0.49f}), Force(0, 0));
  EXPECT_EQ(joystick.command({std::nanf(""), 5}), Force(0, 5));
}

TEST(Simulated, EncodersCountStepsFromTheCentre) {
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Rest{{0.010, -0.020}});
  const double step = 0.2286 / 4096;
  EXPECT_EQ(joystick.sample().counts, glm::ivec2(std::round(0.010 / step), -std::round(0.020 / step)));
}

TEST(Simulated, InteractionContainsInertiaAndFriction) {
  DeviceProfile profile = sandpaper();
  SimulatedJoystick joystick(profile, normal_hand(), Lateral{0.04, 1});
  joystick.elapse(1800);
  double before = joystick.velocity().x;
  for (int tick = 0; tick < 900; ++tick) {
    const double at_start = joystick.position().x;
    joystick.elapse(1);
    const double after = joystick.velocity().x;
    if (before * after > 0) {
      // Newton's law for the handle alone: the hand's force moves its mass against damping and friction.
      const double mean = (joystick.position().x - at_start) * profile.rate;
      const double handle = 0.3 * (after - before) * profile.rate + 1 * mean + std::copysign(0.15, after);
      ASSERT_NEAR(joystick.sample().interaction.x, handle, 1e-3) << "tick " << tick;
    }
    before = after;
  }
}

TEST(Simulated, CannotLeaveTheWorkspace) {
  SimulatedJoystick joystick(sandpaper(), no_hand, Rest{});
  joystick.command({10, 10});
  for (int tick = 0; tick < 900; ++tick) {
    joystick.elapse(1);
    ASSERT_LE(glm::length(joystick.position()), 0.1143 * (1 + 1e-12));
    ASSERT_LT(std::abs(joystick.sample().counts.x), 2049);
  }
  EXPECT_NEAR(joystick.position().x, 0.1143 / std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(glm::length(joystick.velocity()), 0, 1e-6);
}

TEST(Simulated, SeveralPeriodsAtOnceAreTheSameAsOneByOne) {
  SimulatedJoystick once(sandpaper(), normal_hand(), Circular{0.04, 1}),
      often(sandpaper(), normal_hand(), Circular{0.04, 1});
  once.elapse(500);
  for (int tick = 0; tick < 500; ++tick) often.elapse(1);
  EXPECT_EQ(once.position(), often.position());
  EXPECT_EQ(once.velocity(), often.velocity());
}

TEST(Motion, IsSineAndCircle) {
  const Motion lateral = Lateral{0.04, 1.5, {0.01, 0.02}}, circular = Circular{0.03, 0.7, {0.01, 0.02}};
  for (double t = 0; t < 1000; t += 0.0173) {
    const double a = 2 * pi * std::fmod(1.5 * t, 1), b = 2 * pi * std::fmod(0.7 * t, 1);
    ASSERT_NEAR(at(lateral, t).position.x, 0.01 + 0.04 * std::sin(a), 1e-13);
    ASSERT_EQ(at(lateral, t).position.y, 0.02);
    ASSERT_NEAR(at(lateral, t).velocity.x, 0.04 * 2 * pi * 1.5 * std::cos(a), 1e-12);
    ASSERT_NEAR(at(circular, t).position.x, 0.01 + 0.03 * std::cos(b), 1e-13);
    ASSERT_NEAR(at(circular, t).position.y, 0.02 + 0.03 * std::sin(b), 1e-13);
    ASSERT_NEAR(at(circular, t).velocity.y, 0.03 * 2 * pi * 0.7 * std::cos(b), 1e-12);
  }
}

TEST(Motion, StrokesAlongAnyDirectionAndPresses) {
  const Motion across = Lateral{0.04, 1.5, {0.01, 0.02}, heading(0.25)},
               oblique = Lateral{0.04, 1.5, {}, heading(1.0 / 12)};
  const Motion press = Press{0.03, 0.5, {0.01, 0.02}, {0, 1}};
  for (double t = 0; t < 100; t += 0.0173) {
    const double a = 2 * pi * std::fmod(1.5 * t, 1), b = 2 * pi * std::fmod(0.5 * t, 1);
    ASSERT_NEAR(at(across, t).position.x, 0.01, 1e-13);
    ASSERT_NEAR(at(across, t).position.y, 0.02 + 0.04 * std::sin(a), 1e-13);
    ASSERT_NEAR(at(across, t).velocity.y, 0.04 * 2 * pi * 1.5 * std::cos(a), 1e-12);
    ASSERT_NEAR(at(oblique, t).position.x, 0.04 * std::sin(a) * std::sqrt(0.75), 1e-13);  // 30 degrees
    ASSERT_NEAR(at(oblique, t).position.y, 0.04 * std::sin(a) / 2, 1e-13);
    ASSERT_EQ(at(press, t).position.x, 0.01);
    ASSERT_NEAR(at(press, t).position.y, 0.02 + 0.03 * (1 - std::cos(b)) / 2, 1e-13);
    ASSERT_NEAR(at(press, t).velocity.y, 0.03 * pi * 0.5 * std::sin(b), 1e-12);
  }
}

TEST(Motion, HandFollowsATrace) {
  Trace trace;
  for (int i = 0; i <= 300; ++i) {
    const double t = i / 100.0;
    trace.points.push_back({t, {0.03 * std::sin(2 * pi * t), 0}, {0.03 * 2 * pi * std::cos(2 * pi * t), 0}});
  }
  SimulatedJoystick traced(sandpaper(), normal_hand(), trace), sine(sandpaper(), normal_hand(), Lateral{0.03, 1});
  for (int tick = 0; tick < 2600; ++tick) {
    traced.elapse(1);
    sine.elapse(1);
    ASSERT_NEAR(traced.position().x, sine.position().x, 1e-6) << "tick " << tick;
  }
}

}  // namespace
}  // namespace wale::simulated_test
