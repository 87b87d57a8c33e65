// Keys: the energy of their edges and hollows, the click past a threshold, the knock of the button and the lock.
#include <limits>

#include "tests/standard/standard.hpp"
#include "wale/shape.hpp"

namespace wale::standard::keys_test {
namespace {

/// A key's top of 20 mm by 20 mm with a rim of 1 mm, in a shape.
class Key {
 public:
  Key(const std::string& force, const Shape& shape)
      : program_(material("import std.key\nmaterial m { physical {\n patch 20 mm, 20 mm\n force = " + force + "\n} }",
                          "m")),
        bank_(program_, program_.default_parameters(), PatchSize{0.02f, 0.02f, 0.001f}),
        shape_(shape.stretched({0.02f, 0.02f})) {}

  /// The force on a hand at rest, as the stage gives it.
  glm::dvec2 operator()(glm::dvec2 place) {
    if (std::abs(place.x) > 0.01 || std::abs(place.y) > 0.01 || !shape_.contains(glm::vec2(place))) return {0, 0};
    Hand hand;
    hand.position = place;
    if (!shape_.is_rectangle()) {
      const EdgeDistance edge = shape_.edge(glm::vec2(place));
      hand.edge = std::max(edge.metres, std::numeric_limits<float>::min());
      hand.edge_slope = edge.slope;
    }
    return tick(bank_, hand);
  }

  /// The work of a slow hand along a straight way, J.
  double work(glm::dvec2 from, glm::dvec2 to, int steps = 20000) {
    double sum = 0;
    for (int i = 0; i < steps; ++i)
      sum -= glm::dot((*this)(from + (to - from) * ((i + 0.5) / steps)), (to - from) / static_cast<double>(steps));
    return sum;
  }

 private:
  Program program_;
  Bank bank_;
  Shape shape_;
};

std::vector<Shape> shapes() {
  return {Shape(), *Shape::ellipse(0.01f, 0.01f),
          *Shape::polygon(std::vector<glm::vec2>{{-0.01f, -0.01f}, {0.01f, -0.01f}, {0, 0.01f}})};
}

TEST(KeyEdge, TakesTwoThirdsOfStrengthTimesSlopeToClimbFromAnywhere) {
  for (const Shape& shape : shapes()) {
    Key key("key_edge(3 mm, 1.5 N)", shape);
    for (const glm::dvec2 from : {glm::dvec2(0.012, 0.001), {-0.012, -0.002}, {0.002, -0.012}, {0.001, 0.012}})
      EXPECT_NEAR(key.work(from, {0, -0.004}), 2.0 / 3 * 1.5 * 0.003, 2e-6) << from.x << " " << from.y;
  }
  Key square("key_edge(3 mm, 1.5 N)", Shape());
  EXPECT_NEAR(square({0.0085, 0}).x, 1.5, 1e-3);  // steepest in the middle of the slope, and off the key
  EXPECT_EQ(square({0.005, 0}), glm::dvec2(0));
}

TEST(KeyHollow, IsAsDeepAsTheWellOfADetentAndDrawsInwards) {
  // The well of a detent of the same reach is 3 sqrt(3) / 8 strength reach deep.
  const double deep = 3 * std::sqrt(3) / 8 * 1.2 * 0.01;
  for (const Shape& shape : shapes()) {
    Key key("key_hollow(1.2 N)", shape);
    for (const glm::dvec2 to : {glm::dvec2(0.012, 0.001), {-0.012, -0.002}, {0.002, -0.012}, {0.001, 0.012}})
      EXPECT_NEAR(key.work({0, 0}, to), deep, 1e-2 * deep) << to.x << " " << to.y;
  }
  Key round("key_hollow(1.2 N)", *Shape::ellipse(0.01f, 0.01f));
  for (double turn = 0; turn < 6.2; turn += 0.7) {
    const glm::dvec2 out{std::cos(turn), std::sin(turn)};
    EXPECT_NEAR(glm::dot(round(0.01 / std::sqrt(3) * out), out), -1.2, 2e-3);
  }
}

TEST(Knock, IsAWholeSineThatLeavesNoMomentum) {
  Field field(pushing("std.key", "vector(1 N * knock(x / (1 m/s), 12 ms), 0 N)"));
  double sum = 0;
  for (int i = 0; i < 12000; ++i) {
    const double since = (i + 0.5) * 1e-6;
    const double force = field({since, 0}).x;
    EXPECT_NEAR(force, -std::sin(2 * pi * since / 0.012), 1e-3);
    sum += force;
  }
  EXPECT_NEAR(sum / 12000, 0, 1e-4);
  EXPECT_EQ(field({0.0121, 0}).x, 0);
}

TEST(ClickKey, ResistsToTheThresholdClicksAndStops) {
  Stroke stroke(made("mechanism.keys", "click_key",
                     "travel: 5 mm, give: 2 mm, strength: 2 N, left: 0.35, stiffness: 600 N/m, roughness: 0"));
  EXPECT_NEAR(stroke.line({0, -0.0025}, 0.02).y, 1, 1e-3);
  EXPECT_NEAR(stroke.line({0, -0.005}, 0.02).y, 2, 1e-3);
  EXPECT_NEAR(stroke.line({0, -0.0061}, 0.02).y, 0.7, 1e-3);
  EXPECT_NEAR(stroke.line({0, -0.008}, 0.02).y, 0.7 + 0.6, 1e-3);
  EXPECT_NEAR(stroke.line({0, 0.003}, 0.02).y, 0, 1e-6);
  EXPECT_NEAR(stroke.work(), 0, 1e-5);
  EXPECT_EQ(Stroke(made("mechanism.keys", "click_key", "roughness: 0"), {0, -0.006}).force(), glm::dvec2(0));
}

/// Ticks of a material whose button is pressed in some, at rest where it was set down.
std::vector<glm::dvec2> pressed(const Program& program, const std::vector<bool>& button, glm::dvec2 drift = {0, 0}) {
  Bank bank(program);
  Memory memory(program);
  Hand hand;
  memory.enter(bank, hand);
  std::vector<glm::dvec2> forces;
  for (std::size_t i = 0; i < button.size(); ++i) {
    hand.button = button[i];
    hand.time = static_cast<double>(i) * seconds_per_tick;
    hand.position = static_cast<double>(i) * drift;
    forces.push_back(tick(bank, memory, hand));
  }
  return forces;
}

TEST(HollowKey, ClicksAsTheButtonGoesDownAndFainterUp) {
  std::vector<bool> button(90, false);
  std::fill(button.begin() + 20, button.begin() + 55, true);
  const auto forces = pressed(made("mechanism.keys", "hollow_key", "click: 1.5 N, release: 0.5"), button);
  const auto largest = [&](int from, int to) {
    double most = 0;
    for (int i = from; i < to; ++i) most = std::max(most, std::abs(forces[static_cast<std::size_t>(i)].y));
    return most;
  };
  EXPECT_EQ(largest(0, 21), 0);
  EXPECT_NEAR(largest(21, 34), 1.5, 0.1);  // 12 ms are 11 ticks; one may miss the peak of the sine
  EXPECT_EQ(largest(34, 56), 0);
  EXPECT_NEAR(largest(56, 70), 0.75, 0.05);
  EXPECT_EQ(largest(70, 90), 0);
  EXPECT_LT(forces[23].y, 0);  // down first, and up first as it comes up
  EXPECT_GT(forces[58].y, 0);
}

TEST(LockKey, HoldsAfterOnePressAndLetsGoAfterTheNext) {
  const glm::dvec2 drift(2e-5, 0);  // m a tick
  std::vector<bool> button(1200, false);
  std::fill(button.begin() + 300, button.begin() + 320, true);
  std::fill(button.begin() + 700, button.begin() + 720, true);
  const auto forces = pressed(made("mechanism.keys", "lock_key", "stickiness: 0.45, hold: 1.5 N"), button, drift);
  EXPECT_NEAR(forces[290].x, -0.45, 0.01);
  EXPECT_NEAR(forces[690].x, -1.95, 0.02);
  EXPECT_NEAR(forces[1100].x, -0.45, 0.01);
}

}  // namespace
}  // namespace wale::standard::keys_test
