// The proved ranges of states contain every value that a state reaches, and are tight where the values are known.

#include "compiler/prove/reachable.hpp"

#include <gtest/gtest.h>

#include "tests/machine/running.hpp"
#include "tests/prove/programs.hpp"

namespace wale {
namespace {

using enum Operation;
using example::instruction;
using example::loaded;

/// The proved range of the only state of a program. The state begins at 0, is within +-100, and its next value is
/// temporary t + 1 after `tick`. `constants` begin at register 34.
Interval reached(const std::vector<float>& constants, std::vector<Instruction> (*tick)(unsigned state, unsigned t)) {
  PatchProgram p = example::least();
  p.constants = {0.0f, 10.0f};
  p.constants.insert(p.constants.end(), constants.begin(), constants.end());
  p.states = {{"s", -100, 100, 32, 0}};
  p.temporaries = 4;
  const unsigned t = p.first_temporary();
  p.states[0].next = static_cast<RegisterNumber>(t + 1);
  p.tick = tick(p.first_state(), t);
  p.tick.push_back(instruction(limit, t + 2, p.first_state(), 33));
  p.tick.push_back(instruction(limit, t + 3, 32, 33));
  p.outputs = {{OutputQuantity::force, 0, static_cast<RegisterNumber>(t + 2), 33},
               {OutputQuantity::force, 1, static_cast<RegisterNumber>(t + 3), 33}};
  return reachable_domain(loaded(p)).states.at(0);
}

TEST(Reachable, ACountUpToThreeIsNeverMore) {
  const Interval counted = reached({1.0f, 3.0f}, [](unsigned s, unsigned t) {
    return std::vector{instruction(add, t, s, 34), instruction(minimum, t + 1, t, 35)};
  });
  EXPECT_EQ(counted, Interval::between(0, 3));
}

// The next s is s / 2 + x. With x within +-0.2286 m, s stays within twice that.
TEST(Reachable, ADecayingStateSettlesAtItsFixedPoint) {
  const Interval fading = reached({0.5f}, [](unsigned s, unsigned t) {
    return std::vector{instruction(multiply, t, s, 34), instruction(add, t + 1, t, 0)};
  });
  const float most = 2 * 0.2286f;
  EXPECT_GE(fading.high, most * 0.9999f);
  EXPECT_LT(fading.high, most * 1.001f);
  EXPECT_LT(-fading.low, most * 1.001f);
}

TEST(Reachable, AGrowingStateReachesItsBounds) {
  const Interval growing =
      reached({0.5f}, [](unsigned s, unsigned t) { return std::vector{instruction(add, t + 1, s, 34)}; });
  EXPECT_EQ(growing, Interval::between(0, 100));
}

// 0 / 0 is not a number, so the state begins again at 0; 7 / 7 is 1.
TEST(Reachable, NotANumberIsNotRemembered) {
  const Interval ratio =
      reached({0.5f}, [](unsigned s, unsigned t) { return std::vector{instruction(divide, t + 1, s, s)}; });
  EXPECT_TRUE(ratio.contains(0));
  EXPECT_FALSE(ratio.maybe_nan);
}

}  // namespace
}  // namespace wale
