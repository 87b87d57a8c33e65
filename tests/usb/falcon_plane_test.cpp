#include "runtime/device/falcon/falcon_plane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/usb/falcon_bus.hpp"

namespace wale::test::falcon_plane {
namespace {

using namespace falcon;

constexpr double full = FalconModel::full_newton;
const ForceLimits limits{.peak = glm::dvec2(full)};
constexpr HoldInPlane none{.stiffness = 0};

Encoders at(const glm::dvec3& place) { return encoders_of(*inverse(place)); }

int largest(const Torques& torques) {
  return std::max({std::abs(torques[0]), std::abs(torques[1]), std::abs(torques[2])});
}

TEST(FalconPlane, FullForceIsAMotorsWholeTorqueInTheWorstDirection) {
  FalconPlane plane(limits, none);
  ASSERT_TRUE(plane.see(at(workspace_centre), 0));
  int most = 0;
  for (int degrees = 0; degrees < 360; ++degrees) {
    const double angle = degrees * 3.14159265358979323846 / 180;
    const auto push = plane.push(full * glm::dvec2(std::cos(angle), std::sin(angle)), 0);
    most = std::max(most, largest(push.torques));
    EXPECT_NEAR(glm::length(push.force), full, 0.02) << "whole encoder counts lie slightly off the middle";
  }
  EXPECT_NEAR(most, most_torque, 8);
}

TEST(FalconPlane, KeepsTheDirectionOfAForceThatIsTooLarge) {
  FalconPlane plane(limits, none);
  for (const glm::dvec2 place : {glm::dvec2(0), glm::dvec2(0.05, 0), glm::dvec2(-0.03, 0.035)}) {
    ASSERT_TRUE(plane.see(at(workspace_centre + glm::dvec3(place, 0)), 0));
    const auto push = plane.push({30, 40}, 0);
    EXPECT_EQ(largest(push.torques), most_torque);
    EXPECT_NEAR(std::atan2(push.force.y, push.force.x), std::atan2(40, 30), 1e-3);
    EXPECT_GT(glm::length(push.force), 5);
    EXPECT_NEAR(push.hold, 0, 0.02);
  }
}

TEST(FalconPlane, HandlesImpossibleForcesAndPlaces) {
  FalconPlane plane(limits, none);
  EXPECT_EQ(plane.push({1, 1}, 0).torques, Torques{}) << "before the first position";
  ASSERT_TRUE(plane.see(at(workspace_centre), 0));
  EXPECT_EQ(plane.push({std::nan(""), 1}, 0).torques, Torques{});
  EXPECT_LE(largest(plane.push({HUGE_VAL, -HUGE_VAL}, 0).torques), most_torque);
  EXPECT_FALSE(plane.see({30000, -30000, 30000}, 1));
  EXPECT_NEAR(plane.position().x, 0, 1e-4) << "the last valid position";
}

TEST(FalconPlane, TheReportedForceIsTheForceOfTheArms) {
  FalconPlane plane(limits);
  for (const glm::dvec3 place : {glm::dvec3(0), glm::dvec3(0.04, -0.02, 0.01), glm::dvec3(-0.01, 0.045, -0.02)}) {
    ASSERT_TRUE(plane.see(at(workspace_centre + place), 0));
    plane.push({1, 2}, 0);
    const auto push = plane.push({1.5, -2.5}, 90'000);
    FalconModel model;
    model.place = workspace_centre + place;
    model.torques = {push.torques[0], push.torques[1], push.torques[2]};
    model.step();
    EXPECT_NEAR(model.force().x, push.force.x, 0.01);
    EXPECT_NEAR(model.force().y, push.force.y, 0.01);
    EXPECT_NEAR(model.force().z, push.hold, 0.01);
    EXPECT_NEAR(push.force.x, 1.5, 0.01);
    EXPECT_NEAR(push.force.y, -2.5, 0.01);
  }
}

TEST(FalconPlane, TheHoldComesInGraduallyAndIsBounded) {
  FalconPlane plane(limits);
  const Encoders outside = at(workspace_centre + glm::dvec3(0, 0, 0.02));
  double before = 0;
  for (std::int64_t now = 0; now < 1'000'000; now += 1000) {
    ASSERT_TRUE(plane.see(outside, now));
    const double hold = plane.push({0, 0}, now).hold;
    ASSERT_LE(std::abs(hold), 3 + 0.01);
    ASSERT_LE(std::abs(hold - before), 3 * 0.002 + 0.01) << "all of it takes half a second";
    before = hold;
  }
  EXPECT_NEAR(before, -3, 0.01) << "20 mm at 400 N/m would be 8 N";
  EXPECT_NEAR(plane.push({0, 0}, 2'000'000).hold, 0, 0.01) << "starts again after a pause";
  plane.push({0, 0}, 2'050'000);
  plane.let_go();
  EXPECT_NEAR(plane.push({0, 0}, 2'060'000).hold, 0, 0.01) << "starts again after a release";
}

TEST(FalconPlane, TheForceInThePlaneComesFirst) {
  FalconPlane held(limits), freely(limits, none);
  const Encoders outside = at(workspace_centre + glm::dvec3(0.02, 0.01, 0.02));
  for (std::int64_t now = 0; now < 1'000'000; now += 1000) {
    held.see(outside, now);
    freely.see(outside, now);
    const auto with = held.push({50, 10}, now), without = freely.push({50, 10}, now);
    ASSERT_LE(largest(with.torques), most_torque);
    ASSERT_LT(glm::length(with.force - without.force), 0.01);
  }
}

/// Closes the loop over the protocol: encoders with whole counts, one packet each way per millisecond, a light handle.
TEST(FalconPlane, HoldsTheHandleInThePlaneWithoutShaking) {
  FalconModel model({}, true);
  model.logs = false;
  FalconBus bus(model, {});
  FalconPlane plane(limits);
  ASSERT_TRUE(bus.run_until([&] { return bus.session.state() == FalconSession::State::running; }));
  model.hand = workspace_centre + glm::dvec3(0.01, 0.02, 0.01);
  double furthest_late = 0, fastest_late = 0;
  for (int tick = 0; tick < 4000; ++tick) {
    ASSERT_TRUE(plane.see(bus.session.answer()->encoders, bus.session.heard()));
    bus.session.command(plane.push({1, 0}, bus.now).torques, bus.now);
    bus.frame();
    if (tick < 3000) continue;
    furthest_late = std::max(furthest_late, std::abs(model.place.z - workspace_centre.z));
    fastest_late = std::max(fastest_late, glm::length(model.velocity));
  }
  EXPECT_NEAR(furthest_late, 0.01 * 100 / 500, 0.0005) << "a hand of 100 N/m against 400 N/m";
  EXPECT_LT(fastest_late, 0.005);
  EXPECT_NEAR(model.place.x, 0.01 + 1.0 / 100, 0.0005) << "1 N against a hand of 100 N/m";
  EXPECT_NEAR(plane.position().x, model.place.x, 0.0001);
  EXPECT_NEAR(plane.position().y, model.place.y, 0.0001);
}

}  // namespace
}  // namespace wale::test::falcon_plane
