// `stretch` and the friction that is made of it, against the stop operator of hysteresis in double precision, and
// against closed forms of dry friction.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/compiler/compiling.hpp"
#include "wale/memory.hpp"

namespace wale::compiling::stretching_test {
namespace {

constexpr double dt = 1.0 / 900;

/// A hand on a program with memory, tick by tick.
class Felt {
 public:
  explicit Felt(const Program& program, double x = 0, double y = 0) : bank_(program), memory_(program) {
    memory_.enter(bank_, at(x, y));
  }

  Force operator()(double x, double y = 0) { return tick(bank_, memory_, at(x, y)); }

 private:
  static Hand at(double x, double y) {
    Hand hand;
    hand.position = hand.workspace = {static_cast<float>(x), static_cast<float>(y)};
    return hand;
  }

  Bank bank_;
  Memory memory_;
};

TEST(Sticky, DragsWithItsSizeAtEverySpeed) {
  for (const double newton : {0.1, 0.5, 1.0, 2.0})
    for (const double speed : {0.02, 0.05, 0.25, 1.0}) {
      Felt felt(compiled("force = sticky(" + std::to_string(newton) + " N)"), -0.07);
      double force = 0;
      for (double x = -0.07; x < 0.07; x += speed * dt) force = felt(x).x;
      EXPECT_NEAR(force, -newton, 1e-4 * newton) << newton << " N at " << speed << " m/s";
    }
}

TEST(Sticky, GrowsOverDragByStiffnessAndTurnsOverTwice) {
  Felt felt(compiled("force = sticky(1.2 N, stiffness: 400 N/m)"));
  for (int i = 0; i <= 600; ++i) {
    const double x = 1e-5 * i;
    EXPECT_NEAR(felt(x).x, -std::min(400 * x, 1.2), 1e-3);
  }
  for (int i = 0; i <= 900; ++i) {
    const double back = 1e-5 * i;
    EXPECT_NEAR(felt(6e-3 - back).x, -1.2 + std::min(400 * back, 2.4), 1e-3);
  }
}

// A hand pushed with less than the drag stays where it is: on a mass with friction only, a constant force moves it by
// force / stiffness and no further.
TEST(Sticky, HoldsAHandThatPushesLess) {
  Felt felt(compiled("force = sticky(1 N)"));
  double x = 0, v = 0;
  const double mass = 0.85, damping = 7.5, push = 0.5;
  for (int i = 0; i < 60 * 900; ++i) {
    v += dt * (push + felt(x).x - damping * v) / mass;
    x += dt * v;
    ASSERT_LT(x, 1.0 / 600);  // where it would begin to slide
  }
  EXPECT_NEAR(x, push / 600, 1e-6);
}

TEST(Sticky, PushesNoHandThatHasJustCome) {
  Felt felt(compiled("force = sticky(2 N)"), 0.03, -0.02);
  EXPECT_EQ(felt(0.03, -0.02), Force(0, 0));
}

TEST(Stretch, IsTheStopOperatorOfAVector) {
  const Program program = compiled("force = 100 N/m * stretch(hand, 3 mm)");
  std::mt19937 random(7);
  const auto uniform = [&] { return random() / 2147483648.0 - 1; };
  Felt felt(program, 0.01, 0);
  double x = 0.01, y = 0, end_x = x, end_y = y;
  felt(x, y);
  for (int i = 0; i < 5000; ++i) {
    x = std::clamp(x + 1e-3 * uniform(), -0.07, 0.07), y = std::clamp(y + 1e-3 * uniform(), -0.07, 0.07);
    const double away_x = x - end_x, away_y = y - end_y, away = std::hypot(away_x, away_y);
    const double kept = std::min(1.0, 3e-3 / away);
    end_x = x - kept * away_x, end_y = y - kept * away_y;
    const Force force = felt(x, y);
    ASSERT_NEAR(force.x, 100 * kept * away_x, 2e-5) << i;
    ASSERT_NEAR(force.y, 100 * kept * away_y, 2e-5) << i;
  }
}

TEST(Stretch, OfANumberRemembersOneNumber) {
  const Program program = compiled("force = vector(-200 N/m * stretch(x, 2 mm), 0 N)");
  EXPECT_EQ(program.description().states.size(), 1u);
  Felt felt(program);
  EXPECT_NEAR(felt(1e-3).x, -0.2, 1e-5);
  EXPECT_NEAR(felt(9e-3).x, -0.4, 1e-5);
  EXPECT_NEAR(felt(8e-3).x, -0.2, 1e-5);
}

// Two bristles that let go at different reaches add up to a friction that bends in two steps (Prandtl and Ishlinskii).
TEST(Stretch, EachCallHasItsOwnMemory) {
  const Program program = compiled("force = sticky(0.3 N, stiffness: 600 N/m) + sticky(0.6 N, stiffness: 300 N/m)");
  EXPECT_EQ(program.description().states.size(), 4u);
  Felt felt(program);
  for (int i = 0; i <= 400; ++i) {
    const double x = 1e-5 * i;
    ASSERT_NEAR(felt(x).x, -std::min(600 * x, 0.3) - std::min(300 * x, 0.6), 1e-3);
  }
}

TEST(Stretch, OfTheSameArgumentsIsTheSame) {
  Felt felt(compiled("force = sticky(0.3 N) - sticky(0.3 N)"));
  for (const double x : {0.0, 0.001, 0.02, 0.0195}) EXPECT_EQ(felt(x), Force(0, 0));
}

TEST(Stretch, InABlendBelongsToItsComponent) {
  const Program program = Compiled(
                              "wale 1\nmaterial a { physical { force = sticky(0.8 N) } }\n"
                              "material b { physical { force = sticky(0.4 N) } }\nmaterial m = 0.5 a + 0.25 b\n")
                              .programs.at("m");
  EXPECT_EQ(program.description().states.size(), 4u);
  Felt felt(program);
  felt(0.02);
  EXPECT_NEAR(felt(0.03).x, -(0.5 * 0.8 + 0.25 * 0.4), 1e-5);
}

std::string refusal(const std::string& physical, const std::string& declarations = "") {
  try {
    compiled(physical, declarations);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(Stretch, RefusesWhatItCannotRemember) {
  const std::string state = "state p : position = hand in -50 mm .. 50 mm\n next p = hand\n";
  EXPECT_NE(refusal(state + "force = 1 N/m * stretch(hand - p, 1 mm)").find("[W0306]"), std::string::npos);
  EXPECT_NE(refusal("force = 1 N * stretch(hand, 1 N)").find("[W0302]"), std::string::npos);
  EXPECT_NE(refusal("force = vector(1 N * stretch(x / 1 mm, 1), 0 N)").find("[W0207]"), std::string::npos);
  EXPECT_NE(refusal("height h = stretch(x, 1 mm)\n force = lateral(h, amplitude: 1 N)").find("[W0306]"),
            std::string::npos);
  EXPECT_NE(refusal("force = vector(c, 0 N)", "let c = 1 N * stretch(1 mm, 1 mm) / 1 mm").find("[W0304]"),
            std::string::npos);
}

}  // namespace
}  // namespace wale::compiling::stretching_test
