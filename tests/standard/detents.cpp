// Detents and the desktop made of them: their rests, the energy to leave them, and that no closed path gains energy.
#include "tests/standard/standard.hpp"

namespace wale::standard::detents_test {
namespace {

/// The work of a slow hand on the straight path, in J.
double work(Field& field, glm::dvec2 from, glm::dvec2 to, int steps = 20000) {
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    sum -= glm::dot(field(from + (to - from) * ((i + 0.5) / steps)), (to - from) / static_cast<double>(steps));
  return sum;
}

TEST(Detents, HoldAtTheirMultiplesBehindABarrierOfStrengthTimesSpacingOverPi) {
  Field field(pushing("std.detent", "vector(detents(x, 10 mm, 1.2 N), 0 N)"));
  for (int i = -5; i <= 5; ++i) {
    const double rest = 0.01 * i;
    EXPECT_NEAR(field({rest, 0}).x, 0, 1e-5);
    EXPECT_LT(field({rest + 1e-4, 0}).x, 0);
    EXPECT_GT(field({rest - 1e-4, 0}).x, 0);
    EXPECT_NEAR(work(field, {rest, 0}, {rest + 0.005, 0}), 1.2 * 0.01 / pi, 1e-6);
  }
}

TEST(Detent, IsAWellOfKnownDepthAndStrengthAndNothingBeyond) {
  Field field(pushing("std.detent", "vector(detent(x, 8 mm, 1.5 N), 0 N)"));
  double strongest = 0, at = 0;
  for (double x = 0; x < 0.012; x += 1e-5)
    if (-field({x, 0}).x > strongest) strongest = -field({x, 0}).x, at = x;
  EXPECT_NEAR(strongest, 1.5, 1e-4);
  EXPECT_NEAR(at, 0.008 / std::sqrt(3), 5e-5);
  EXPECT_NEAR(work(field, {0, 0}, {0.02, 0}), 1.5 * 0.008 * 3 * std::sqrt(3) / 8, 1e-5);
  for (double x : {0.008, 0.0081, 0.03, -0.02}) EXPECT_EQ(field({x, 0}).x, 0);
}

TEST(Dimple, PullsToItsMiddleFromEverySide) {
  Field row(pushing("std.detent", "vector(detent(x, 8 mm, 1.5 N), 0 N)")),
      field(pushing("std.detent", "dimple(hand, 8 mm, 1.5 N)"));
  Chance chance(8);
  for (int i = 0; i < 300; ++i) {
    const glm::dvec2 out = chance.direction();
    const double away = chance.between(0, 0.01);
    EXPECT_NEAR(glm::distance(field(away * out), row({away, 0}).x * out), 0, 1e-5);
  }
  EXPECT_EQ(field({0, 0}), glm::dvec2(0));
}

TEST(Ratchet, IsEasyForwardsSteepBackAndCostsTheSame) {
  Field field(pushing("std.detent", "vector(ratchet(x, 8 mm, 0.8 N, steep: 0.25), 0 N)"));
  for (int i = -3; i < 3; ++i) {
    const double notch = 0.008 * i, edge = notch + 0.006;
    EXPECT_NEAR(work(field, {notch, 0}, {edge, 0}), 0.5 * 0.8 * 0.006, 1e-6);
    EXPECT_NEAR(work(field, {notch + 0.008, 0}, {edge, 0}), 0.5 * 0.8 * 0.006, 1e-6);
    EXPECT_NEAR(field({notch + 0.003, 0}).x, -0.8, 1e-3);
    EXPECT_NEAR(field({notch + 0.007, 0}).x, 0.8 * 3, 1e-3);
  }
}

TEST(Menu, HasADetentInTheMiddleOfEveryItemOnly) {
  Field field(pushing("std.desktop", "items(hand, 5, 12 mm, 50 mm, 1 N)"));
  std::vector<double> rests;
  for (double y = -0.05; y < 0.05; y += 1e-4)
    if (field({0, y}).y > 1e-4 && field({0, y + 1e-4}).y <= 1e-4) rests.push_back(y);
  ASSERT_EQ(rests.size(), 5u);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(rests[static_cast<std::size_t>(i)], 0.012 * (i - 2), 2e-4);
  EXPECT_NEAR(work(field, {0, 0}, {0, 0.006}), 0.012 / pi, 1e-6);
  EXPECT_NEAR(work(field, {0, 0}, {0.04, 0}), 0.012 / pi, 1e-6);  // the way out to the side costs the same
  Field even(pushing("std.desktop", "items(hand, 4, 10 mm, 50 mm, 1 N)"));
  for (int i = 0; i < 4; ++i) {
    const double rest = 0.01 * (i - 1.5);
    EXPECT_NEAR(even({0, rest}).y, 0, 1e-4);
    EXPECT_LT(even({0, rest + 1e-3}).y, 0);
  }
}

TEST(Rim, HoldsInsideWithTwoThirdsOfStrengthTimesReach) {
  Field field(pushing("std.desktop", "rim(hand, 60 mm, 40 mm, 9 mm, 2 N)"));
  EXPECT_EQ(field({0.02, 0.015}), glm::dvec2(0));
  EXPECT_NEAR(field({0.0345, 0}).x, -2, 1e-4);
  EXPECT_NEAR(field({0, -0.0245}).y, 2, 1e-4);
  EXPECT_EQ(field({0.0395, 0}), glm::dvec2(0));
  EXPECT_NEAR(work(field, {0.02, 0}, {0.05, 0}), 2 * 0.009 * 2 / 3, 1e-5);
  EXPECT_NEAR(work(field, {0.02, 0.01}, {0.06, 0.05}), 2 * 0.009 * 2 / 3, 1e-5);  // round the corner
}

TEST(WindowEdge, IsAGrooveAllAround) {
  Field field(pushing("std.desktop", "window_edge(hand, 80 mm, 50 mm, reach: 4 mm, strength: 1.2 N)"));
  for (const glm::dvec2 edge : {glm::dvec2(0.04, 0.003), {-0.04, -0.01}, {0.01, 0.025}, {-0.02, -0.025}}) {
    const glm::dvec2 out =
        std::abs(edge.x) > 0.039 ? glm::dvec2(glm::sign(edge.x), 0) : glm::dvec2(0, glm::sign(edge.y));
    EXPECT_NEAR(glm::length(field(edge)), 0, 1e-4);
    EXPECT_NEAR(glm::dot(field(edge + 0.004 / std::sqrt(3) * out), out), -1.2, 1e-3);
    EXPECT_NEAR(glm::dot(field(edge - 0.004 / std::sqrt(3) * out), out), 1.2, 1e-3);
    EXPECT_EQ(field(edge + 0.005 * out), glm::dvec2(0));
    EXPECT_EQ(field(edge - 0.005 * out), glm::dvec2(0));
  }
}

TEST(Document, PullsHalfAsHardAfterEachHalfLife) {
  const auto pull = [](const std::string& age) {
    Field field(
        made("std.desktop", "document", "age: " + age + " day, half_life: 7 day, strength: 2 N, settle: 0 N s/m"));
    return field({0.009, 0}).x;
  };
  EXPECT_NEAR(pull("7") / pull("0"), 0.5, 1e-5);
  EXPECT_NEAR(pull("21") / pull("0"), 0.125, 1e-5);
}

TEST(PushButton, ClicksAndStops) {
  Stroke stroke(made("std.desktop", "push_button",
                     "click: 6 mm, give: 3 mm, strength: 2 N, left: 0.4, stiffness: 900 N/m, damping: 0 N s/m"));
  EXPECT_NEAR(stroke.line({0, -0.003}, 0.02).y, 1, 1e-3);
  EXPECT_NEAR(stroke.line({0, -0.006}, 0.02).y, 2, 1e-3);
  EXPECT_NEAR(stroke.line({0, -0.0075}, 0.02).y, 0.8, 1e-3);
  EXPECT_NEAR(stroke.line({0, -0.009}, 0.02).y, 0.8, 1e-3);
  EXPECT_NEAR(stroke.line({0, -0.01}, 0.02).y, 0.8 + 0.9, 1e-3);
  EXPECT_NEAR(stroke.line({0, 0.01}, 0.02).y, 0, 1e-6);
  EXPECT_NEAR(stroke.work(), 0, 1e-5);
  EXPECT_EQ(Stroke(made("std.desktop", "push_button"), {0, -0.05}).force(), glm::dvec2(0));
}

class Conservative : public testing::TestWithParam<std::tuple<const char*, const char*, const char*>> {};

TEST_P(Conservative, NoClosedPathGainsEnergy) {
  const auto [module, name, still] = GetParam();
  const Program program = made(module, name, still);
  const auto size = program.default_size();
  Field field(program);
  Chance chance(9);
  for (int i = 0; i < 60; ++i) {
    glm::dvec2 corners[3];
    for (auto& corner : corners)
      corner = {chance.between(-0.45, 0.45) * size.width, chance.between(-0.45, 0.45) * size.height};
    double sum = 0, spent = 0;
    for (int k = 0; k < 3; ++k) {
      const double side = work(field, corners[k], corners[(k + 1) % 3], 8000);
      sum += side;
      spent += std::abs(side);
    }
    EXPECT_NEAR(sum, 0, 2e-5 + 1e-3 * spent) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Standard, Conservative,
                         testing::Values(std::tuple{"std.detent", "dimple", "settle: 0 N s/m"},
                                         std::tuple{"std.detent", "detents", "turned: 30 deg"},
                                         std::tuple{"std.detent", "detent_grid", "settle: 0 N s/m"},
                                         std::tuple{"std.desktop", "menu", "settle: 0 N s/m"},
                                         std::tuple{"std.desktop", "window_edge", "settle: 0 N s/m"},
                                         std::tuple{"std.desktop", "scroll_bar", "settle: 0 N s/m"},
                                         std::tuple{"mechanism.detent_dial", "detent_dial", "viscosity: 0"},
                                         std::tuple{"mechanism.toggle", "toggle", "viscosity: 0"},
                                         std::tuple{"mechanism.ratchet", "ratchet_teeth", "viscosity: 0"}),
                         [](const auto& each) { return std::string(std::get<1>(each.param)); });

TEST(DetentDial, HasItsNotchesInAnEvenRing) {
  Field field(made("mechanism.detent_dial", "detent_dial", "positions: 8, viscosity: 0"));
  for (int i = 0; i < 8; ++i) {
    const double angle = i * pi / 4;
    const glm::dvec2 out{std::cos(angle), std::sin(angle)}, round{-out.y, out.x};
    EXPECT_NEAR(glm::length(field(0.04 * out)), 0, 1e-3);
    EXPECT_LT(glm::dot(field(0.04 * out + 0.001 * round), round), -0.05);
    EXPECT_GT(glm::dot(field(0.04 * out - 0.001 * round), round), 0.05);
    EXPECT_LT(glm::dot(field(0.044 * out), out), -0.5);
    EXPECT_GT(glm::dot(field(0.036 * out), out), 0.5);
  }
}

TEST(Toggle, RestsOnBothSides) {
  Field field(made("mechanism.toggle", "toggle", "throw: 15 mm, strength: 2 N"));
  for (double rest : {-0.015, 0.015}) {
    EXPECT_NEAR(field({rest, 0}).x, 0, 1e-4);
    EXPECT_LT(field({rest + 0.001, 0}).x, 0);
    EXPECT_GT(field({rest - 0.001, 0}).x, 0);
  }
  EXPECT_NEAR(field({0.015 / std::sqrt(3), 0}).x, 2, 1e-4);
  EXPECT_NEAR(field({-0.015 / std::sqrt(3), 0}).x, -2, 1e-4);
}

}  // namespace
}  // namespace wale::standard::detents_test
