// The bound on a program's force is never below a force of the machine, and is tight where the largest force is known.

#include <gtest/gtest.h>

#include <cmath>

#include "compiler/prove/force_bound.hpp"
#include "compiler/prove/prove.hpp"
#include "tests/machine/running.hpp"
#include "tests/prove/programs.hpp"
#include "tests/prove/values.hpp"

namespace wale::force_bounds_test {
namespace {

using enum Operation;
using example::instruction;
using example::loaded;
using prove_test::pushing;
using prove_test::random_program;
using prove_test::Values;

TEST(ForceBounds, OfASpringIsItsStiffnessTimesTheWorkspace) {
  const Program spring =
      loaded(pushing({-30.0f}, {}, [](unsigned t) { return std::vector{instruction(multiply, t, 0, 34)}; }));
  const ForceBound bound = force_bound(spring);
  EXPECT_NEAR(bound.newton, 30 * 0.2286, 1e-5);
  EXPECT_NEAR(bound.axis_newton[0], 30 * 0.2286, 1e-5);
  EXPECT_EQ(bound.axis_newton[1], 0);
  EXPECT_NEAR(bound.found.newton, 30 * 0.2286, 1e-5);
  EXPECT_NEAR(std::abs(bound.found.hand.position.x), 0.2286, 1e-5);
}

// 2 x - 1.5 v is largest at a corner of place and velocity: 2 * 0.2286 m + 1.5 * 2 m/s.
TEST(ForceBounds, IsFoundAtACornerOfTheEnvelope) {
  const Program program = loaded(pushing({2.0f, -1.5f}, {}, [](unsigned t) {
    return std::vector{instruction(multiply, t, 0, 34), instruction(multiply, t + 1, 2, 35),
                       instruction(add, t, t, t + 1)};
  }));
  const ForceBound bound = force_bound(program);
  EXPECT_NEAR(bound.newton, 2 * 0.2286 + 1.5 * 2, 1e-5);
  EXPECT_NEAR(bound.ratio(), 1, 1e-3);
}

TEST(ForceBounds, OfAGratingIsTheLargestAmplitude) {
  const Parameter amplitude{"amplitude", "N", 1, 1.0f, 0.5f, 2.5f, 0.5f, 2.5f, ""};
  const Program grating = loaded(pushing({2513.27f}, {amplitude}, [](unsigned t) {
    return std::vector{instruction(multiply, t, 0, 34), instruction(sine, t + 1, t),
                       instruction(multiply, t, t + 1, 35)};
  }));
  const ForceBound bound = force_bound(grating);
  EXPECT_NEAR(bound.newton, 2.5, 1e-6);
  EXPECT_NEAR(bound.ratio(), 1, 2e-3);
  EXPECT_EQ(bound.found.parameters, std::vector<float>{2.5f});
}

// 3 N a / max(a + b, 1e-6): a share of a sum is 1 at most if none of its terms is negative; otherwise the sum may
// vanish beside its term, and the device's limit is all that is known.
TEST(ForceBounds, OfAShareIsTheWhole) {
  const auto share_beside = [](float least_other) {
    const Parameter a{"a", "", 1, 0.5f, 0, 1, 0, 1, ""}, b{"b", "", 1, 0.5f, least_other, 1, least_other, 1, ""};
    return force_bound(loaded(pushing({1e-6f, 3.0f}, {a, b}, [](unsigned t) {
      return std::vector{instruction(add, t, 36, 37), instruction(maximum, t, t, 34), instruction(divide, t, 36, t),
                         instruction(multiply, t, t, 35)};
    })));
  };
  const ForceBound of_both = share_beside(0);
  EXPECT_NEAR(of_both.newton, 3, 1e-5);
  EXPECT_NEAR(of_both.found.newton, 3, 1e-6) << "b may be 0";
  const ForceBound of_a_difference = share_beside(-1);
  EXPECT_GE(of_a_difference.newton, of_a_difference.found.newton);
  EXPECT_GT(of_a_difference.newton, 9) << "1 / max(1 - 1, 1e-6)";
}

// (x - 0.1)(x + 0.1) is -0.01 at least and 0.2286^2 - 0.01 at most.
TEST(ForceBounds, SplittingTightensTheBound) {
  const Program program = loaded(pushing({0.1f, 100.0f}, {}, [](unsigned t) {
    return std::vector{instruction(subtract, t, 0, 34), instruction(add, t + 1, 0, 34),
                       instruction(multiply, t + 2, t, t + 1), instruction(multiply, t, t + 2, 35)};
  }));
  const double most = 100 * (0.2286 * 0.2286 - 0.01);
  const ForceBound bound = force_bound(program);
  EXPECT_GE(bound.newton, most * (1 - 1e-6));
  EXPECT_LT(bound.newton, most * 1.002);
  EXPECT_LE(bound.newton, prove(program).bound_newton);
  EXPECT_NEAR(bound.found.newton, most, 1e-4);
}

// A force whose direction turns with x. Each component reaches 5 N, and the length is 5 N everywhere.
TEST(ForceBounds, KnowTheLengthOfAForceFromItsComponents) {
  PatchProgram p = pushing({20.0f, 5.0f}, {}, [](unsigned t) {
    return std::vector{instruction(multiply, t + 1, 0, 34), instruction(cosine, t + 2, t + 1),
                       instruction(sine, t + 3, t + 1), instruction(multiply, t, t + 2, 35),
                       instruction(multiply, t + 4, t + 3, 35)};
  });
  p.tick.back().a = static_cast<RegisterNumber>(p.first_temporary() + 4);  // the limit of force y
  const Program turning = loaded(p);
  EXPECT_NEAR(prove(turning).bound_newton, 5, 1e-4);  // sine and cosine of one angle need no splitting
  const ForceBound bound = force_bound(turning);
  EXPECT_NEAR(bound.found.newton, 5, 1e-4);
  EXPECT_NEAR(bound.newton, 5, 0.1);
  EXPECT_NEAR(bound.axis_newton[0], 5, 1e-4);
  EXPECT_NEAR(bound.axis_newton[1], 5, 1e-4);
}

TEST(ForceBounds, SplittingNeverFallsBelowAForceOfTheMachine) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const Program program = loaded(random_program(seed));
    const ForceBound bound = force_bound(program, whole_domain(program.description()), 20000);
    ASSERT_LE(bound.found.newton, bound.newton) << seed;
    ASSERT_LE(bound.newton, prove(program).bound_newton) << seed;
    Values values(seed);
    Bank bank(program);
    std::vector<Hand> hands(500);
    for (Hand& hand : hands) {
      for (glm::vec2* pair : {&hand.position, &hand.velocity, &hand.acceleration, &hand.raw_velocity,
                              &hand.raw_acceleration, &hand.workspace}) {
        *pair = {values.of(Interval::everything(true)), values.of(Interval::between(-1, 1))};
      }
      hand.time = values.any();
      hand.button = values.random()() % 2 == 0;
    }
    std::vector<Force> forces(hands.size());
    tick_all(bank, hands, forces);
    for (const Force& force : forces) {
      ASSERT_LE(std::hypot(static_cast<double>(force.x), static_cast<double>(force.y)), bound.newton) << seed;
      ASSERT_LE(std::abs(force.x), bound.axis_newton[0]) << seed;
      ASSERT_LE(std::abs(force.y), bound.axis_newton[1]) << seed;
    }
  }
}

TEST(ForceBounds, TheSameBoundEveryTime) {
  const Program program = loaded(random_program(4));
  const ForceBound once = force_bound(program), again = force_bound(program);
  EXPECT_EQ(once.newton, again.newton);
  EXPECT_EQ(once.found.newton, again.found.newton);
  EXPECT_EQ(once.evaluations, again.evaluations);
}

}  // namespace
}  // namespace wale::force_bounds_test
