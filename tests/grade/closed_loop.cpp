// The grade's stability against the simulated device. Without hand, friction and quantisation, oscillations grow above
// the graded stiffness. In a hand, motion grows as the margin falls.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <vector>

#include "runtime/stage/velocity_filter.hpp"
#include "tests/grade/grading.hpp"
#include "wale/simulated.hpp"

namespace wale::closed_loop_test {
namespace {

using compiling::Files;

/// A device whose figures are all declared, with such a force range and speed limit that neither limits the loop.
struct Bench {
  double mass = 0.3;    // kg
  double damping = 1;   // N s/m
  double delay = 0;     // s
  double friction = 0;  // N
  int window = 1;       // ticks, of the velocity filter

  std::string declared() const {
    return fmt::format(
        "device bench {{\n  workspace disc(228.6 mm)\n  position 4096 counts\n  force 1000 N, 65536 counts\n  rate "
        "900 "
        "Hz\n  speed 100 m/s\n  slew 200 N/s\n  velocity_filter {}, 1 counts\n  patch 160 mm, 160 mm, 5 mm\n  mass {} "
        "kg\n  damping {} N s/m\n  friction {} N\n  delay {} ms\n  source \"a test\"\n}}\n",
        window, mass, damping, friction, 1e3 * delay);
  }
};

/// A spring k and a viscosity b as parameters.
Program spring_and_viscosity(const Bench& bench) {
  Files files;
  SourceSet sources;
  Diagnostics diagnostics;
  const SourceId source = sources.add("test.wale", "wale 1\n" + bench.declared() + R"(
material m { physical {
  param k = 1000 N/m in 1 N/m .. 1000000 N/m
  param b = 0 N s/m in -1000 N s/m .. 1000 N s/m
  active 100 W
  force = -k * hand - b * velocity
} })");
  const auto program = compile(sources, source, "m", "bench", files, diagnostics);
  std::string reasons;
  for (const auto& diagnostic : diagnostics.all()) reasons += render_text(diagnostic, sources, false);
  if (!program) throw std::runtime_error(reasons);
  return *program;
}

Bank bank(const Program& program, double stiffness, double viscosity) {
  return Bank(program, std::vector<float>{static_cast<float>(stiffness), static_cast<float>(viscosity)},
              program.default_size());
}

/// The stiffness, in N/m, for which the grade requires exactly the device's damping.
double graded_stiffness(const Program& program, const Bench& bench, double viscosity) {
  double low = 1, high = 1e6;
  for (int i = 0; i < 24; ++i) {
    const double middle = std::sqrt(low * high);
    (grade(bank(program, middle, viscosity), grading::hand).required_damping > bench.damping ? high : low) = middle;
  }
  return std::sqrt(low * high);
}

/// Whether a small oscillation along x grows over 25 simulated seconds.
bool grows(const Program& program, double stiffness, double viscosity) {
  DeviceProfile profile = program.description().device;
  profile.position_counts = profile.force_counts = 1 << 29;
  SimulatedJoystick joystick(profile, {}, Rest{});
  VelocityFilter velocity(profile);
  Bank here = bank(program, stiffness, viscosity);
  const long ticks = std::lround(25 * profile.rate), second = std::lround(profile.rate);
  double early = 0, late = 0;
  for (long n = 0; n < ticks; ++n) {
    joystick.elapse(1);
    const double position = joystick.position().x;
    const double counts_per_tick = velocity(joystick.sample().counts.x, 1);
    Hand hand{.position = glm::vec2(position, 0)};
    hand.velocity.x = static_cast<float>(counts_per_tick * profile.position_step() * profile.rate);
    joystick.command(n < 3 ? Force(0.5, 0) : tick(here, hand));  // a displacement of about 10 um
    if (n >= second && n < 3 * second) early = std::max(early, std::abs(position));
    if (n >= ticks - 2 * second) late = std::max(late, std::abs(position));
    if (std::abs(position) > 0.01) return true;
  }
  return late > early;
}

TEST(ClosedLoop, OscillationsGrowFromTheGradedStiffnessOn) {
  // b T / m up to 0.22; with delays up to 2 ms.
  for (const double damping : {0.5, 1.0, 5.0, 20.0, 60.0})
    for (const double delay : {0.0, 0.001, 0.002}) {
      const Bench bench{.damping = damping, .delay = delay};
      const Program program = spring_and_viscosity(bench);
      const double graded = graded_stiffness(program, bench, 0);
      SCOPED_TRACE(fmt::format("b {} N s/m, delay {} ms: {} N/m", damping, 1e3 * delay, graded));
      EXPECT_NEAR(graded, damping / (0.5 / 900 + delay), 1e-3 * graded) << "Colgate and Schenkel";
      EXPECT_FALSE(grows(program, 0.9 * graded, 0));
      EXPECT_TRUE(grows(program, 1.1 * graded, 0));
    }
}

TEST(ClosedLoop, OscillationsGrowFromTheGradedStiffnessWithNegativeViscosity) {
  for (const double viscosity : {-0.2, -0.5, -0.8}) {
    const Bench bench;
    const Program program = spring_and_viscosity(bench);
    const double graded = graded_stiffness(program, bench, viscosity);
    SCOPED_TRACE(fmt::format("B {} N s/m: {} N/m", viscosity, graded));
    EXPECT_FALSE(grows(program, 0.9 * graded, viscosity));
    EXPECT_TRUE(grows(program, 1.1 * graded, viscosity));
  }
}

TEST(ClosedLoop, WithViscosityItNeverGrowsBelowTheGradedStiffness) {
  for (const int window : {1, 15})
    for (const double viscosity : {0.3, 0.8}) {
      const Bench bench{.damping = 2, .window = window};
      const Program program = spring_and_viscosity(bench);
      const double graded = graded_stiffness(program, bench, viscosity);
      SCOPED_TRACE(fmt::format("B {} N s/m, window {}: {} N/m", viscosity, window, graded));
      EXPECT_FALSE(grows(program, 0.95 * graded, viscosity));
    }
}

/// The RMS speed, in m/s, in the last of six seconds after a push, in a hand that holds still.
double unrest(const Program& program, double stiffness) {
  const DeviceProfile& profile = program.description().device;
  SimulatedJoystick joystick(profile, {.mass = 0.55, .damping = 6.5, .stiffness = 135}, Rest{});
  Bank here = bank(program, stiffness, 0);
  const long ticks = std::lround(6 * profile.rate), second = std::lround(profile.rate);
  double squares = 0;
  for (long n = 0; n < ticks; ++n) {
    joystick.elapse(1);
    const glm::dvec2 position = glm::dvec2(joystick.sample().counts) * profile.position_step();
    joystick.command(n < 20 ? Force(8, 0) : tick(here, {.position = glm::vec2(position)}));
    if (n >= ticks - second) squares += glm::dot(joystick.velocity(), joystick.velocity());
  }
  return std::sqrt(squares / static_cast<double>(second));
}

TEST(ClosedLoop, InAHandTheMarginOrdersTheOutcomes) {
  for (const double delay : {0.0, 0.001}) {
    const Bench bench{.delay = delay, .friction = 0.15};
    const Program program = spring_and_viscosity(bench);
    const double all = bench.damping + 6.5, late = 0.5 / 900 + delay;
    std::vector<double> outcomes;
    for (const double margin : {6.0, 3.0, 0.5, -4.0, -8.0, -16.0}) {  // N s/m
      const double stiffness = (all - margin) / late;
      const Grade graded = grade(bank(program, stiffness, 0), grading::hand);
      ASSERT_NEAR(graded.device_damping + graded.hand_damping - graded.required_damping, margin, 0.05);
      outcomes.push_back(unrest(program, stiffness));
    }
    SCOPED_TRACE(fmt::format("{} s: {}", delay, fmt::join(outcomes, ", ")));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(outcomes[i], 1e-3) << "at rest within a count";
    EXPECT_GT(outcomes[3], 0.01);
    EXPECT_GT(outcomes[4], outcomes[3]);
    EXPECT_GT(outcomes[5], outcomes[4]);
  }
}

}  // namespace
}  // namespace wale::closed_loop_test
