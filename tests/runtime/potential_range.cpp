// The range of the potential of a program's force, against closed forms.
#include "runtime/stage/potential_range.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "tests/runtime/figures.hpp"
#include "tests/runtime/programs.hpp"
#include "wale/stage.hpp"

namespace wale::potential_range_test {
namespace {

constexpr PatchSize size{.width = 0.16f, .height = 0.12f, .rim = 0.005f};

double range_of(const Program& program) { return potential_range(Bank(program, program.default_parameters(), size)); }

/// The work, in J, of the limit over half the distance between two lines of the sampling, at either end.
double between_lines(double most) {
  return most * 0.5 * (static_cast<double>(size.width) + static_cast<double>(size.height)) / 32;
}

TEST(PotentialRange, OfASpringIsThatFromItsCentreToACorner) {
  const double stiffness = 40;
  const double truth = 0.5 * stiffness * (0.08 * 0.08 + 0.06 * 0.06);
  const double range = range_of(spring(static_cast<float>(stiffness)));
  EXPECT_NEAR(range, truth + between_lines(9), 0.01 * truth);
}

TEST(PotentialRange, OfAConstantForceIsTheForceTimesTheWidth) {
  EXPECT_NEAR(range_of(push(3)), 3 * 0.16 + between_lines(9), 0.01 * 3 * 0.16);
}

TEST(PotentialRange, OfATextureIsThatOfOneOfItsSlopes) {
  for (const float wale : {0.001f, 0.0025f, 0.005f}) {
    // The area under a Gaussian is amplitude times standard deviation times sqrt(2 pi), less its parts beyond a quarter
    // of a wale from its middle, 2.67 standard deviations.
    const double truth = 1.934 * wale * 24 / 256 * std::sqrt(2 * std::numbers::pi);
    const double range = range_of(corduroy(1.934f, wale)) - between_lines(1.934);
    EXPECT_GT(range, 0.9 * truth) << wale;
    EXPECT_LT(range, 2 * truth) << wale << ": the finest rib has three samples";
  }
}

TEST(PotentialRange, OfAProgramWithStatesIsTheLimitTimesTheDiagonal) {
  EXPECT_NEAR(range_of(bead(500)), 9 * std::hypot(0.16, 0.12), 1e-3);
}

TEST(PotentialRange, OfAResistanceIsZero) { EXPECT_NEAR(range_of(oil(5)), between_lines(9), 1e-6); }

/// J, the bound by its definition: every line, one tick at a time.
double by_definition(const Program& program) {
  Bank bank(program, program.default_parameters(), size);
  double sum = 0, most = 0;
  for (const Output& output : program.description().outputs)
    most = std::max(most, static_cast<double>(std::abs(bank.registers()[output.ceiling])));
  for (const bool along_x : {true, false}) {
    const float length = along_x ? size.width : size.height, across = along_x ? size.height : size.width;
    double farthest = 0;
    for (int line = 0; line < 32; ++line) {
      const float beside = across * ((static_cast<float>(line) + 0.5f) / 32 - 0.5f);
      double potential = 0, low = 0, high = 0, last = 0;
      for (int point = 0; point < 512; ++point) {
        const float along = length * ((static_cast<float>(point) + 0.5f) / 512 - 0.5f);
        const Force force = tick(bank, {.position = along_x ? glm::vec2(along, beside) : glm::vec2(beside, along)});
        const double here = along_x ? force.x : force.y;
        if (point > 0) potential -= 0.5 * (last + here) * (static_cast<double>(length) / 512);
        low = std::min(low, potential), high = std::max(high, potential), last = here;
      }
      farthest = std::max(farthest, high - low);
    }
    sum += farthest;
  }
  return std::min(trivial_potential_range(bank), sum + between_lines(most));
}

/// Along x the force is y^2 x; along y it is 3 min(x, y): no two lines are alike but those at y and -y.
Program saddle() {
  Assembly a({3});
  const RegisterNumber square = a.tick(Operation::multiply, a.input(Input::y), a.input(Input::y));
  const RegisterNumber along_x = a.tick(Operation::multiply, square, a.input(Input::x));
  const RegisterNumber least = a.tick(Operation::minimum, a.input(Input::x), a.input(Input::y));
  const RegisterNumber along_y = a.tick(Operation::multiply, least, a.constant(0));
  a.push(0, along_x, a.constant(0));
  a.push(1, along_y, a.constant(0));
  return a.load();
}

TEST(PotentialRange, IsThatOfAllLinesThoughEqualOnesAreComputedOnce) {
  for (const Program& program : {spring(40), push(3), corduroy(1.934f), oil(5), saddle()})
    EXPECT_NEAR(range_of(program) / by_definition(program), 1, 1e-12) << "but for the order of 512 sums";
}

/// On a stage, a program that pushes along the motion of the hand may give only the range of its force at rest.
TEST(PotentialRange, IsTheEnergyThatAStageAllows) {
  const Program source = oil(-4);  // 4 N s/m along the motion
  SimulatedJoystick joystick(sandpaper(), {.mass = 0.55, .damping = 6.5, .stiffness = 135}, Lateral{0.04, 1});
  Stage stage(joystick);
  Patch patch = *stage.add(source);
  const auto run = stage.run({.seconds = 10, .virtual_time = true});
  ASSERT_TRUE(run);
  const Record& record = run->record;
  double given = 0;
  for (std::size_t i = 1; i < record.ticks.size(); ++i)
    given += 0.5 * glm::dot(glm::dvec2(record.ticks[i - 1].force + record.ticks[i].force),
                            glm::dvec2(record.ticks[i].position - record.ticks[i - 1].position));
  const double allowed = potential_range(Bank(source));
  EXPECT_LT(allowed, 0.1) << "much less than the 2 J of its limit across the patch";
  EXPECT_GT(run->guards.energy, 0);
  EXPECT_LT(given, allowed + 0.002 * 10 + 0.01);
}

}  // namespace
}  // namespace wale::potential_range_test
