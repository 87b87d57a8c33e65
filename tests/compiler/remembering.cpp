// States, memories, time and phase, against the evaluator of tests/reference/, which follows the language's order of
// evaluation, and against recurrences and closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "compiler/parse/parse.hpp"
#include "tests/compiler/compiling.hpp"
#include "tests/reference/evaluator.hpp"
#include "wale/memory.hpp"

namespace wale::compiling::remembering_test {
namespace {

constexpr double dt = 1.0 / 900;

/// A program with its bank and memory.
struct Running {
  explicit Running(const Program& compiled) : program(compiled), bank(program), memory(program) {}

  void enter(const Hand& hand) { memory.enter(bank, hand); }
  Force operator()(const Hand& hand) { return tick(bank, memory, hand); }

  Program program;
  Bank bank;
  Memory memory;
};

Hand at(double x, double y, double vx = 0, double vy = 0) {
  return {{static_cast<float>(x), static_cast<float>(y)}, {static_cast<float>(vx), static_cast<float>(vy)}};
}

const char* const brick = R"(
    param mass = 0.3 kg in 0.05 kg .. 2 kg
    param k    = 120 N/m in 10 N/m .. 800 N/m
    param b    = 0.8 N s/m in 0 N s/m .. 5 N s/m
    state p : position = hand in -60 mm .. 60 mm
    state v : velocity = vector(0 m/s, 0 m/s) in -2 m/s .. 2 m/s
    let pull = k * (hand - p)
    v' = (pull - b * v) / mass
    p' = v
    force = -pull)";

TEST(States, AgreeWithTheReferenceEvaluator) {
  const std::string text = std::string("wale 1\nmaterial m { physical {") + brick + "\n} }\n";
  SourceSet sources;
  Diagnostics diagnostics;
  const SyntaxTree tree = parse(sources, sources.add("test.wale", text), diagnostics);
  std::mt19937 random(4);
  const auto uniform = [&] { return random() / 2147483648.0 - 1; };
  for (int run = 0; run < 20; ++run) {
    Running running(Compiled(text).only());
    reference::Simulation simulation(tree);
    const double x0 = 0.04 * uniform(), y0 = 0.04 * uniform(), f = 3 + 2 * uniform();
    for (int i = 0; i < 150; ++i) {
      const double x = x0 + 0.02 * std::sin(2 * std::numbers::pi * f * i * dt), y = y0 - 0.01 * i * dt;
      const Hand hand = at(x, y);
      const reference::HandState state{hand.position.x, hand.position.y};
      if (i == 0) running.enter(hand), simulation.enter(state);
      const Force force = running(hand);
      const auto expected = simulation.tick(state);
      for (int axis = 0; axis < 2; ++axis) {
        ASSERT_LT(expected.error[axis], 1e-3);
        ASSERT_NEAR(force[axis], expected.value[axis], expected.error[axis] + 1e-7) << "run " << run << " tick " << i;
      }
    }
  }
}

TEST(States, SwingAtTheFrequencyOfMassAndSpring) {
  Running running(compiled(brick));
  running.enter(at(0, 0));
  // The hand jumps 10 mm and stays: the brick swings about it, damped, with omega = sqrt(k/m - (b/2m)^2).
  const double omega = std::sqrt(120 / 0.3 - std::pow(0.8 / 0.6, 2)), decay = 0.8 / 0.6;
  for (int i = 0; i < 1800; ++i) {
    const double t = i * dt;
    const double swing = -0.01 * std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
    const Force force = running(at(0.01, 0));
    EXPECT_NEAR(force.x, 120 * swing, 120 * 0.01 * 0.03) << t;  // semi-implicit Euler is off by about omega dt
  }
}

TEST(States, UpdatesReadUpdatesAboveThemAndLetsReadOldValues) {
  Running running(compiled(R"(
    state a = 1 in -1000 .. 1000
    state b = 10 in -1000 .. 1000
    state c = 100 in -1000 .. 1000
    let old = a + b
    next a = a + 1
    next b = a + b
    next c = old
    force = vector(1 N * (a / 100), 1 N * (c / 1000)))"));
  running.enter(at(0, 0));
  // By hand: a counts, b adds the new a, and c is the sum of a and b as they were before the tick.
  const float expected[4][3] = {{1, 10, 100}, {2, 12, 11}, {3, 15, 14}, {4, 19, 18}};
  for (const auto& [a, b, c] : expected) {
    EXPECT_EQ(running.memory.states()[0], a);
    EXPECT_EQ(running.memory.states()[1], b);
    EXPECT_EQ(running.memory.states()[2], c);
    const Force force = running(at(0, 0));
    EXPECT_FLOAT_EQ(force.x, a / 100);
    EXPECT_FLOAT_EQ(force.y, c / 1000);
  }
}

TEST(States, StopAtTheirBoundsAndAtThoseOfTheirDimension) {
  Running running(compiled(R"(
    state near : length = 0 mm in -1 mm .. 1 mm
    state far : length = 0 mm
    near' = 1 m/s
    far' = 5 m/s
    force = 1 N/m * vector(near, far))"));
  running.enter(at(0, 0));
  for (int i = 0; i < 900; ++i) running(at(0, 0));
  EXPECT_FLOAT_EQ(running.memory.states()[0], 1e-3f);
  EXPECT_FLOAT_EQ(running.memory.states()[1], 1);  // schema/units.wale: length in -1 m .. 1 m
}

TEST(States, BeginAsTheHandEntersAndReplaceNotANumber) {
  Running running(compiled(R"(
    state start : position = hand
    state wild = 0.5 in 0 .. 10
    next wild = sqrt(x / 1 m)
    force = 1 N/m * (start - hand) * wild)"));
  running.enter(at(0.01, 0.02));
  EXPECT_FLOAT_EQ(running.memory.states()[0], 0.01f);
  EXPECT_FLOAT_EQ(running.memory.states()[1], 0.02f);
  running(at(0.04, 0));
  EXPECT_FLOAT_EQ(running.memory.states()[2], 0.2f);
  running(at(-0.04, 0));  // the root of a negative number
  EXPECT_FLOAT_EQ(running.memory.states()[2], 0.5f);
  EXPECT_EQ(running.memory.restored(), 1);
}

TEST(Phase, IsAWrappedAccumulator) {
  Running running(compiled(R"(
    param f = 7 Hz in 1 Hz .. 400 Hz
    force = vector(1 N * phase(f), 1 N * phase(f / 2)))"));
  running.enter(at(0, 0));
  for (int i = 0; i < 2000; ++i) {
    const Force force = running(at(0, 0));
    const double turns = 7 * i * dt;
    const auto apart = [](double a, double b) { return std::abs(std::remainder(a - b, 1.0)); };
    // Each tick rounds once, to 6e-8 at most.
    EXPECT_LT(apart(force.x, turns), 6e-8 * (i + 1)) << i;
    EXPECT_LT(apart(force.y, turns / 2), 6e-8 * (i + 1)) << i;
  }
}

TEST(Inputs, ReachTheExpressionsThatNameThem) {
  const Program program = compiled(R"(
    let sum = vector(1 N, 0 N) * (time / 1 s + (if button then 10 else 0) + dt / 1 s)
    force = sum * 0.1 + 0.01 kg * acceleration + 1 N/m * hand_on_workspace)");
  Bank bank(program);
  Hand hand;
  hand.acceleration = {3, 4};
  hand.workspace = {0.05f, -0.06f};
  hand.time = 2.5;
  const Force up = tick(bank, hand);
  EXPECT_NEAR(up.x, 0.1 * (2.5 + dt) + 0.03 + 0.05, 1e-6);
  EXPECT_NEAR(up.y, 0.04 - 0.06, 1e-6);
  hand.button = true;
  EXPECT_NEAR(tick(bank, hand).x - up.x, 1, 1e-6);
}

const char* const track = R"(
    patch 40 mm, 20 mm
    memory depth : length = 0 mm in 0 mm .. 3 mm, cell 2 mm
    next depth = depth + 1 mm
    force = vector(1 N * (depth / 1 mm), 1 N * (depth(vector(9 mm, 1 mm)) / 1 mm)))";

TEST(Memories, ChangeUnderTheHandOnly) {
  const Program program = compiled(track);
  ASSERT_EQ(program.description().grids.size(), 1u);
  EXPECT_EQ(program.description().grids[0].columns, 20u);
  EXPECT_EQ(program.description().grids[0].rows, 10u);
  Running running(program);
  running.enter(at(0, 0));
  // Cell centres lie at odd millimetres.
  for (int i = 0; i < 5; ++i) running(at(0.009, 0.001));
  for (int i = 0; i < 2; ++i) running(at(-0.0091, -0.0069));
  for (std::uint32_t row = 0; row < 10; ++row)
    for (std::uint32_t column = 0; column < 20; ++column) {
      const double expected = row == 5 && column == 14 ? 3 : row == 1 && column == 5 ? 2 : 0;  // mm; held at 3
      EXPECT_FLOAT_EQ(running.memory.grid(0)[row * 20 + column], static_cast<float>(1e-3 * expected))
          << row << " " << column;
    }
  // Values between cells are interpolated, and a place as argument reads the value there.
  EXPECT_NEAR(running(at(0.010, 0.001)).x, 1.5, 1e-5);
  EXPECT_NEAR(running(at(-0.015, 0.005)).y, 3, 1e-5);
  // A new entry does not change memories.
  running.enter(at(0, 0));
  EXPECT_NEAR(running(at(0.009, 0.001)).x, 3, 1e-5);
}

TEST(Memories, ScaleWithThePatch) {
  Running running(compiled(track));
  running.bank = Bank(running.program, running.program.default_parameters(), {0.08f, 0.04f, 0.002f});
  running.enter(at(0, 0));
  running(at(0.018, 0.002));  // twice as far on a patch twice as large
  EXPECT_FLOAT_EQ(running.memory.grid(0)[5 * 20 + 14], 1e-3f);
}

TEST(Shown, MarksFollowTheState) {
  const Program program = compiled(std::string(brick) + R"(
    show box(p, 20 mm, 10 mm, angle: 30 deg, colour: "#c04020")
    show spring(hand, p)
    show colour(0.2, x / 1 m, 0.5))");
  const Picture& picture = program.description().picture;
  ASSERT_EQ(picture.marks.size(), 2u);
  EXPECT_EQ(picture.marks[0].kind, MarkKind::box);
  EXPECT_EQ(picture.marks[0].colour, 0xc04020u);
  EXPECT_EQ(picture.marks[1].kind, MarkKind::spring);
  EXPECT_TRUE(picture.colour.has_value());
}

}  // namespace
}  // namespace wale::compiling::remembering_test
