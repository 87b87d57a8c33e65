// The largest force that a user allows is never exceeded by what a device exerts, whatever its steps are.
#include "runtime/device/user_limit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>

#include "runtime/device/shipped_devices.hpp"
#include "runtime/stage/guards.hpp"
#include "tests/runtime/figures.hpp"
#include "tests/runtime/programs.hpp"
#include "wale/devices.hpp"
#include "wale/simulated_pad.hpp"
#include "wale/stage.hpp"

namespace wale::user_limit_test {
namespace {

constexpr double limits[] = {0.001, 0.1, 0.25, 0.3, 0.5, 0.7, 0.777, 1, 1.5, 2, 3.3, 7, 40};

/// Some directions, the axes and their middle among them.
Force toward(int direction, double size) {
  const double turn = direction * 0.26179938779914943654;  // 15 degrees
  return {size * std::cos(turn), size * std::sin(turn)};
}

double size_of(Force exerted) { return glm::length(glm::dvec2(exerted)); }

TEST(UserLimit, HoldsForAllDevicesAndLimitsOfAStage) {
  const auto& shipped = shipped_devices();
  ASSERT_TRUE(shipped);
  for (const DeclaredDevice& each : *shipped) {
    const DeviceProfile& profile = each.profile;
    for (const double limit : limits) {
      if (profile.shaker) {
        for (const double frequency : {profile.shaker->frequency_low, profile.shaker->frequency_high,
                                       (profile.shaker->frequency_low + profile.shaker->frequency_high) / 2}) {
          Guards guards(profile, limit);
          SimulatedPad pad(profile, Rest{});
          float largest = 0;
          for (int tick = 0; tick < 2000; ++tick) {
            const Force commanded = guards({1000, static_cast<float>(frequency)}, glm::dvec2(0), 1);
            largest = std::max(largest, pad.command(commanded).x);
            pad.elapse(1);
          }
          EXPECT_LE(largest, limit) << profile.name << " at " << frequency;
        }
        continue;
      }
      for (int direction = 0; direction < 24; ++direction) {
        Guards guards(profile, limit);
        SimulatedJoystick joystick(profile, normal_hand(), Rest{});
        Force exerted(0);
        double largest = 0;
        for (int tick = 0; tick < 600; ++tick) {
          exerted = joystick.command(guards(toward(direction, 1000), glm::dvec2(0), 1));
          guards.commanded(exerted);
          largest = std::max(largest, size_of(exerted));
        }
        EXPECT_LE(largest, limit) << profile.name << " toward " << direction;
        // No more is lost than the steps of both axes. (A motor that heats may allow less, and so may a peak.)
        if (limit < profile.force_newton && profile.continuous_newton == 0) {
          EXPECT_GT(size_of(exerted), limit - 1.5 * profile.force_step()) << profile.name << " toward " << direction;
        }
      }
    }
  }
}

TEST(UserLimit, HoldsForAllDevicesAndLimitsOfOpening) {
  const auto& shipped = shipped_devices();
  ASSERT_TRUE(shipped);
  for (const DeclaredDevice& each : *shipped) {
    for (const double limit : limits) {
      const auto opened = open_device("simulated:" + each.profile.name, {.max_force = limit, .hand = normal_hand()});
      ASSERT_TRUE(opened) << in_words(opened.error());
      for (int direction = 0; direction < 24; ++direction) {
        Force command = toward(direction, 1000);
        if (each.profile.shaker) command.y = static_cast<float>(each.profile.shaker->frequency_low) * (1 + direction);
        Force exerted(0);
        for (int tick = 0; tick < (each.profile.shaker ? 200 : 1); ++tick) {
          exerted = (*opened)->command(command);
          (*opened)->elapse(1);
        }
        EXPECT_LE(each.profile.shaker ? exerted.x : size_of(exerted), limit) << each.profile.name;
      }
    }
  }
}

TEST(UserLimit, IsFeltAlikeWhetherTheStageOrTheDeviceHasIt) {
  const auto run = [](double of_stage, double of_device) {
    auto device = open_device("simulated:sandpaper", {.max_force = of_device, .hand = normal_hand(), .motion = Lateral{0.05, 1}});
    EXPECT_TRUE(device);
    Stage stage(*std::move(device), {.max_force = of_stage});
    EXPECT_TRUE(stage.add(oil(20)));
    return *stage.run({.seconds = 3, .virtual_time = true});
  };
  const RunResult one = run(1, HUGE_VAL), other = run(HUGE_VAL, 1);
  EXPECT_GT(one.guards.user_limit, 100);
  EXPECT_EQ(one.guards.user_limit, other.guards.user_limit);
  EXPECT_EQ(other.guards.passivity, 0);
  ASSERT_EQ(one.record.ticks.size(), other.record.ticks.size());
  for (std::size_t i = 0; i < one.record.ticks.size(); ++i)
    ASSERT_EQ(one.record.ticks[i].force, other.record.ticks[i].force) << i;
}

TEST(UserLimit, LeavesAForceAloneThatIsAllowed) {
  const UserLimit limit(sandpaper(), 3), none(sandpaper(), HUGE_VAL);
  EXPECT_EQ(limit.in_steps({1.2345f, -0.5f}), Force(1.2345f, -0.5f));
  EXPECT_EQ(none.in_steps(none.clamped({1234, 5})), Force(1234, 5));
}

}  // namespace
}  // namespace wale::user_limit_test
