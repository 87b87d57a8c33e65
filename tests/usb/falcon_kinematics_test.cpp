#include "runtime/device/falcon/falcon_kinematics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "tests/usb/falcon_reference.hpp"

namespace wale::test::falcon_kinematics {
namespace {

using namespace falcon;

/// Places all over the workspace: up to 50 mm from its middle in the plane, and up to 30 mm to either side of the
/// plane.
std::vector<glm::dvec3> places() {
  std::vector<glm::dvec3> places;
  for (int radius = 0; radius <= 50; radius += 10) {
    for (int degrees = 0; degrees < 360; degrees += 24) {
      for (int out = -30; out <= 30; out += 15) {
        const double angle = degrees * falcon_pi / 180;
        places.push_back(workspace_centre + 1e-3 * glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), out));
      }
    }
  }
  return places;
}

TEST(FalconKinematics, EncodersCountTheMotorsShafts) {
  // 320 slots read at four edges, a shaft of 14.25 mm that drives a drum of 110 mm: 9880.7 counts a turn of the arm.
  const double counts_per_turn = 4 * 320 * 110 / 14.25;
  EXPECT_NEAR(angles_of({0, 0, 0}).x, 35 * falcon_pi / 180, 1e-12);
  EXPECT_NEAR(angles_of({1447, 0, 0}).x - angles_of({0, 0, 0}).x, 1447 / counts_per_turn * 2 * falcon_pi, 1e-12);
  for (const std::int16_t counts : {-32768, -1, 0, 1, 1447, 32767}) {
    const Encoders encoders{counts, 0, static_cast<std::int16_t>(counts / 2)};
    EXPECT_EQ(encoders_of(angles_of(encoders)), encoders);
  }
  EXPECT_EQ(encoders_of({1e9, -1e9, 0})[0], 32767);
}

TEST(FalconKinematics, TheInverseFitsShinsToKnees) {
  for (const glm::dvec3& place : places()) {
    const auto angles = inverse(place);
    ASSERT_TRUE(angles.has_value());
    EXPECT_LT(glm::length(*angles - arm_angles(place)), 1e-9);
  }
  EXPECT_FALSE(inverse({0, 0, 0.25})) << "beyond the reach of the arms";
  EXPECT_FALSE(inverse({0.2, 0, 0.12}));
}

TEST(FalconKinematics, ForwardUndoesInverse) {
  for (const glm::dvec3& place : places()) {
    const auto there = forward(*inverse(place));
    ASSERT_TRUE(there.has_value());
    EXPECT_LT(glm::length(*there - place), 1e-9);
  }
  EXPECT_FALSE(forward({3, -3, -3}));
  EXPECT_FALSE(forward(angles_of({30000, -30000, 30000})));
}

TEST(FalconKinematics, AllThreeArmsHaveTheSameAngleInTheMiddle) {
  const auto angles = inverse(workspace_centre);
  EXPECT_NEAR(angles->x, angles->y, 1e-12);
  EXPECT_NEAR(angles->x, angles->z, 1e-12);
  const auto across = torques_for(*turning(workspace_centre, *angles), {0, 0, 1});
  EXPECT_NEAR(across->x, across->y, 1e-12);
  EXPECT_NEAR(across->x, across->z, 1e-12);
}

TEST(FalconKinematics, TheJacobianMatchesFiniteDifferences) {
  for (const glm::dvec3& place : places()) {
    const auto slopes = turning(place, *inverse(place));
    ASSERT_TRUE(slopes.has_value());
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LT(glm::length((*slopes)[axis] - arm_slopes(axis, place)), 1e-5 * glm::length((*slopes)[axis]));
    }
  }
}

TEST(FalconKinematics, NoPowerIsLostBetweenHandleAndArms) {
  const glm::dvec3 force(1.2, -3.4, 0.5), movement(0.3, 0.2, -0.7);
  for (const glm::dvec3& place : places()) {
    const auto slopes = turning(place, *inverse(place));
    const auto torques = torques_for(*slopes, force);
    ASSERT_TRUE(torques.has_value());
    EXPECT_LT(glm::length(force_by(*slopes, *torques) - force), 1e-9);
    EXPECT_NEAR(glm::dot(*torques, *slopes * movement), glm::dot(force, movement), 1e-9);
  }
  EXPECT_FALSE(torques_for(glm::dmat3(0), force));
}

}  // namespace
}  // namespace wale::test::falcon_kinematics
