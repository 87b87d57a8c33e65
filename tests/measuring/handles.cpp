// The handle's own figures, from shaking a simulated one whose mass, damping, friction and delay are known.
#include <gtest/gtest.h>

#include <atomic>
#include <string>

#include "calibration/device/bench.hpp"

namespace wale::measuring::handles_test {
namespace {

struct Truth {
  const char* name;
  double mass, damping, friction, delay;
};

class Shaken : public testing::TestWithParam<Truth> {};

TEST_P(Shaken, GivesItsMassDampingFrictionAndDelay) {
  const Truth truth = GetParam();
  const DeviceProfile profile{.name = "stick",
                              .workspace_diameter = 0.2,
                              .position_counts = 16384,
                              .force_newton = 10,
                              .force_counts = 4096,
                              .rate = 1000,
                              .mass = truth.mass,
                              .damping = truth.damping,
                              .friction = truth.friction,
                              .delay_x = truth.delay,
                              .delay_y = truth.delay};
  DeviceWiring wiring;
  wiring.gain = {0.9, 0.9};
  wiring.response[0].dead_band = wiring.response[1].dead_band = 0.2;
  PlantedDevice device(profile, wiring, 1);
  const std::atomic<bool> stop{false};
  Bench bench(device, {1, 1}, true, stop);
  const auto ticks = bench.shake(0, 2.5, wiring.response_of(0, profile.force_newton));
  ASSERT_TRUE(ticks);
  const auto fit = fit_handle(*ticks, 1 / profile.rate);
  ASSERT_TRUE(fit) << fit.error().sentence;
  EXPECT_NEAR(fit->mass.value, truth.mass, 0.03 * truth.mass) << truth.name;
  EXPECT_NEAR(fit->damping.value, truth.damping, 0.1 * truth.damping + 0.05);
  EXPECT_NEAR(fit->friction.value, truth.friction, 0.1 * truth.friction + 0.02);
  EXPECT_NEAR(fit->delay.value, truth.delay, 5e-4);
  for (const HandleTick& tick : *ticks) ASSERT_LT(std::abs(tick.position), 0.09) << "it stays off the edge";
  EXPECT_GT(bench.smallest_steps()[0], 0);
}

/// The first shaking leaves the handle where the second one can begin.
TEST_P(Shaken, GivesTheSameAlongBothAxes) {
  const Truth truth = GetParam();
  const DeviceProfile profile{.name = "stick",
                              .workspace_diameter = 0.2,
                              .position_counts = 4096,
                              .force_newton = 10,
                              .force_counts = 2048,
                              .rate = 900,
                              .mass = truth.mass,
                              .damping = truth.damping,
                              .friction = truth.friction};
  PlantedDevice device(profile, {}, 1);
  const std::atomic<bool> stop{false};
  Bench bench(device, {1, 1}, true, stop);
  for (const int axis : {0, 1}) {
    const auto ticks = bench.shake(axis, 2.5, DeviceWiring{}.response_of(0, profile.force_newton));
    ASSERT_TRUE(ticks);
    const auto fit = fit_handle(*ticks, 1 / profile.rate);
    ASSERT_TRUE(fit) << fit.error().sentence;
    EXPECT_NEAR(fit->mass.value, truth.mass, 0.03 * truth.mass) << truth.name << ", axis " << axis;
    EXPECT_NEAR(fit->delay.value, 0, 5e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(Handles, Shaken,
                         testing::Values(Truth{"usual", 0.3, 1.2, 0.2, 2e-3}, Truth{"heavy", 0.8, 3, 0.4, 5e-3},
                                         Truth{"light", 0.12, 0.6, 0.1, 1e-3}),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(Handles, AHeldHandleGivesNoFigures) {
  const std::vector<HandleTick> still(5000, {0.01, 2});
  const auto fit = fit_handle(still, 1e-3);
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, Code::not_measured);
}

TEST(Bench, StopsWithoutForce) {
  PlantedDevice device({.name = "stick",
                        .workspace_diameter = 0.2,
                        .position_counts = 4096,
                        .force_newton = 10,
                        .force_counts = 512,
                        .rate = 1000,
                        .mass = 0.3},
                       {}, 1);
  std::atomic<bool> stop{true};
  Bench bench(device, {1, 1}, true, stop);
  const auto pushed = bench.push(Way::right, 5, 1);
  ASSERT_FALSE(pushed);
  EXPECT_EQ(pushed.error().code, Code::stopped);
}

}  // namespace
}  // namespace wale::measuring::handles_test
