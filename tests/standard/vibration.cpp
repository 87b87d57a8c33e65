// Statistics of noise that does not depend on the place.
#include <set>

#include "tests/standard/standard.hpp"

namespace wale::standard::vibration_test {
namespace {

/// The forces of `ticks` ticks of a hand at `place` (m) with `velocity` (m/s).
std::vector<glm::dvec2> felt(const Program& program, glm::dvec2 place, glm::dvec2 velocity, int ticks) {
  Stroke stroke(program, place);
  std::vector<glm::dvec2> forces;
  for (int i = 0; i < ticks; ++i) forces.push_back(stroke.tick_at(place, velocity));
  return forces;
}

const Program& vibration() {
  static const Program program = pushing("std.vibration", "vibration(0.8 N, 90 Hz, full: 0.2 m/s)");
  return program;
}

TEST(Vibration, HasNoMeanAndTheSpreadOfNoise) {
  double sum = 0, squares = 0;
  const auto forces = felt(vibration(), {0, 0}, {0.3, 0}, 30 * 900);
  for (const auto& force : forces) {
    sum += force.x;
    squares += force.x * force.x;
    EXPECT_LE(std::abs(force.x), 0.8);
    EXPECT_EQ(force.y, 0);
  }
  // The values at 256 moments are uniform from -1 to 1, and their mean is within three standard deviations of 0.
  // Between moments the variance is (1 - s)^2 + s^2 of that, where s is the interpolation's polynomial of fifth degree.
  double between = 0;
  for (int i = 0; i < 10000; ++i) {
    const double t = (i + 0.5) / 10000, s = t * t * t * (t * (6 * t - 15) + 10);
    between += ((1 - s) * (1 - s) + s * s) / 10000;
  }
  const double count = static_cast<double>(forces.size());
  EXPECT_NEAR(sum / count / 0.8, 0, 3 * std::sqrt(1.0 / 3 / 256));
  EXPECT_NEAR(squares / count / 0.64, between / 3, 0.15 * between / 3);
}

TEST(Vibration, ChangesAtItsRateAndIsContinuous) {
  const auto forces = felt(vibration(), {0, 0}, {0.3, 0}, 10 * 900);
  // The 90 moments a second are ten ticks apart. The steepest slope between two is 15/8 of their difference, at most 2.
  for (std::size_t i = 1; i < forces.size(); ++i)
    ASSERT_LE(std::abs(forces[i].x - forces[i - 1].x), 0.8 * 2 * 15 / 8 / 10 + 1e-5) << i;
  int turns = 0;
  for (std::size_t i = 2; i < forces.size(); ++i)
    turns += (forces[i].x - forces[i - 1].x) * (forces[i - 1].x - forces[i - 2].x) < 0;
  EXPECT_NEAR(turns / 10.0, 60, 8);  // two thirds of independent values are local extremes
}

TEST(Vibration, DependsOnTimeAndVelocityAndNotOnPlace) {
  const auto here = felt(vibration(), {0, 0}, {0.1, 0}, 900), there = felt(vibration(), {0.031, -0.02}, {0.1, 0}, 900);
  const auto half = felt(vibration(), {0, 0}, {0, 0.05}, 900), fast = felt(vibration(), {0, 0}, {0.7, 0}, 900);
  std::set<float> values;
  for (std::size_t i = 0; i < here.size(); ++i) {
    EXPECT_EQ(here[i], there[i]);
    EXPECT_NEAR(half[i].y, here[i].x / 2, 1e-6);  // along the motion, in proportion to the speed
    EXPECT_NEAR(fast[i].x, here[i].x * 2, 1e-5);  // up to full speed
    values.insert(static_cast<float>(here[i].x));
  }
  EXPECT_GT(values.size(), 800u);  // the force changes at one place
  for (const auto& force : felt(vibration(), {0, 0}, {0, 0}, 100)) EXPECT_EQ(force, glm::dvec2(0));
}

TEST(Fizz, NeverPushesInTheDirectionOfMotion) {
  const Program program = made("std.vibration", "fizz");
  for (double speed : {0.01, 0.1, 0.2, 0.6})
    for (const auto& force : felt(program, {0, 0}, {0.6 * speed, -0.8 * speed}, 2000))
      ASSERT_LE(force.x * 0.6 - force.y * 0.8, 1e-6) << speed;
}

TEST(Grit, HasABumpForEachGrainOfTheHandsPath) {
  const Program program = made("std.vibration", "grit", "amplitude: 1 N, grain: 2 mm, rise: 8 N s/m");
  for (double speed : {0.15, 0.4}) {
    Stroke stroke(program, {-0.06, 0});
    std::vector<double> drags;
    double way = 0;
    for (int lap = 0; lap < 20; ++lap)
      for (double x = 0; x < 0.12; x += speed * seconds_per_tick) {
        stroke.tick_at({lap % 2 == 0 ? -0.06 + x : 0.06 - x, 0}, {lap % 2 == 0 ? speed : -speed, 0});
        const double drag = lap % 2 == 0 ? -stroke.force().x : stroke.force().x;
        ASSERT_GE(drag, 0);
        ASSERT_LE(drag, 1);
        drags.push_back(drag);
        way += speed * seconds_per_tick;
      }
    int peaks = 0;
    for (std::size_t i = 2; i < drags.size(); ++i) peaks += drags[i - 1] > drags[i - 2] && drags[i - 1] >= drags[i];
    EXPECT_NEAR(peaks / (way / 0.002), 1.0 / 3, 0.06) << speed;  // a third of independent values are local maxima
  }
  // At the second stroke, the same place has another force.
  Stroke stroke(program, {0, 0});
  stroke.line({0.0313, 0}, 0.3);
  const double once = stroke.force().x;
  stroke.line({0, 0}, 0.3);
  stroke.line({0.0313, 0}, 0.3);
  EXPECT_GT(std::abs(stroke.force().x - once), 0.02);
}

}  // namespace
}  // namespace wale::standard::vibration_test
