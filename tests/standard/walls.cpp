// Walls: their force, the energy that they return, and their release.
#include "tests/standard/standard.hpp"

namespace wale::standard::walls_test {
namespace {

/// The outward force of a wall, in N, by the documentation of library/std/wall.wale. All arguments are in SI units.
double expected_push(double depth, double entering, double stiffness, double damping, double envelope) {
  double push = 0;
  if (depth > 0) push += stiffness * depth;
  if (entering > 0 && depth > -envelope) push += damping * entering * (depth < 0 ? 1 + depth / envelope : 1);
  return push;
}

TEST(Wall, FollowsItsClosedFormAtAnyAngle) {
  Chance chance(4);
  for (double degrees : {0.0, 35.0, -120.0}) {
    Stroke stroke(made("std.wall", "wall",
                       "stiffness: 600 N/m, damping: 5 N s/m, envelope: 3 mm, face: 10 mm, angle: " +
                           std::to_string(degrees) + " deg"));
    const double angle = degrees * pi / 180;
    const glm::dvec2 inwards{std::cos(angle), std::sin(angle)}, along{-inwards.y, inwards.x};
    for (int i = 0; i < 500; ++i) {
      const double depth = chance.between(-0.01, 0.01), entering = chance.between(-0.4, 0.4);
      const glm::dvec2 force = stroke.tick_at((0.01 + depth) * inwards + chance.between(-0.04, 0.04) * along,
                                              entering * inwards + chance.between(-0.4, 0.4) * along);
      const glm::dvec2 expected = -expected_push(depth, entering, 600, 5, 0.003) * inwards;
      EXPECT_NEAR(glm::distance(force, expected), 0, 1e-4) << depth << " " << entering;
    }
  }
}

TEST(Wall, ReturnsTheSpringsEnergyAndKeepsTheDampings) {
  for (double speed : {0.05, 0.2, 0.4}) {
    Stroke stroke(made("std.wall", "wall", "stiffness: 800 N/m, damping: 4 N s/m, envelope: 2 mm, face: 20 mm"));
    constexpr double depth = 0.006, stored = 800 * depth * depth / 2;
    stroke.line({0.02 + depth, 0}, speed);
    const double in = stroke.work();
    // On average, the damping in the envelope is half of that behind the face.
    EXPECT_NEAR(in, stored + 4 * speed * (0.001 + depth), 0.1 * in) << speed;
    double pulled = 0;
    for (double left = depth; left > -0.01; left -= speed * seconds_per_tick) {
      const double push = -stroke.move({0.02 + left, 0}).x;
      pulled = std::min(pulled, push);
      EXPECT_NEAR(push, 800 * std::max(0.0, left), 1e-3);  // only the spring, and nothing outside of the face
    }
    EXPECT_EQ(pulled, 0);
    EXPECT_NEAR(in - stroke.work(), stored, 0.06 * stored);
    EXPECT_GT(stroke.work(), 0);
  }
}

TEST(Wall, YieldsToAHandThatEntersBehindItAndReturnsWithIt) {
  Stroke stroke(made("std.wall", "wall", "stiffness: 800 N/m, damping: 0 N s/m, face: 20 mm"), {0.05, 0});
  EXPECT_EQ(stroke.force(), glm::dvec2(0));
  stroke.line({0.052, 0}, 0.05);
  EXPECT_NEAR(stroke.force().x, -800 * 0.002, 1e-3);
  stroke.line({0.03, 0}, 0.1);
  EXPECT_NEAR(stroke.force().x, 0, 1e-5);
  stroke.line({0.033, 0}, 0.1);
  EXPECT_NEAR(stroke.force().x, -800 * 0.003, 2e-3);
  stroke.line({0, 0}, 0.1);
  stroke.line({0.025, 0}, 0.1);
  EXPECT_NEAR(stroke.force().x, -800 * 0.005, 2e-3);
  EXPECT_GT(stroke.work(), 0);
}

TEST(Post, PushesOutwardsInEveryDirection) {
  Chance chance(5);
  for (int i = 0; i < 100; ++i) {
    const glm::dvec2 out = chance.direction();
    Stroke stroke(made("std.wall", "post", "radius: 25 mm, stiffness: 700 N/m, damping: 3 N s/m"), 0.04 * out);
    EXPECT_EQ(stroke.force(), glm::dvec2(0));
    const double depth = chance.between(0, 0.008), entering = chance.between(-0.3, 0.3);
    const glm::dvec2 force = stroke.tick_at((0.025 - depth) * out, -entering * out);
    EXPECT_NEAR(glm::distance(force, expected_push(depth, entering, 700, 3, 0.002) * out), 0, 1e-4);
  }
}

TEST(Room, HasFourWallsAndNothingInBetween) {
  Stroke stroke(made("std.wall", "room", "width: 100 mm, depth: 60 mm, stiffness: 500 N/m, damping: 0 N s/m"));
  Chance chance(6);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec2 place{chance.between(-0.056, 0.056), chance.between(-0.036, 0.036)};
    const glm::dvec2 expected{-500 * (place.x - std::clamp(place.x, -0.05, 0.05)),
                              -500 * (place.y - std::clamp(place.y, -0.03, 0.03))};
    EXPECT_NEAR(glm::distance(stroke.tick_at(place, {0, 0}), expected), 0, 1e-4);
  }
  EXPECT_EQ(Stroke(made("std.wall", "room"), {0.09, -0.07}).force(), glm::dvec2(0));
}

}  // namespace
}  // namespace wale::standard::walls_test
