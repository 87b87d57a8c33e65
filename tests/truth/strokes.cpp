// What is known of programs with a memory, against strokes over them: no formula of the hand alone gives their force.

#include <gtest/gtest.h>

#include "tests/compiler/compiling.hpp"
#include "tests/standard/standard.hpp"
#include "tests/truth/families.hpp"

namespace wale::truth {
namespace {

/// Half of the difference of the force along x at the middle, to and fro at a speed in m/s: what resists the motion.
double resistance(const Program& program, double speed) {
  constexpr double reach = 0.03;
  standard::Stroke stroke(program, {-reach, 0});
  const double right = stroke.line({0, 0}, speed).x;
  stroke.line({reach, 0}, speed);
  const double left = stroke.line({0, 0}, speed).x;
  return (left - right) / 2;
}

Family family_named(const std::string& name) {
  for (const Family& family : families()) {
    if (name == family.name) return family;
  }
  throw std::runtime_error("no class " + name);
}

TEST(Truth, FrictionsResistByTheirSizeAtAnySpeed) {
  for (const char* name : {"friction", "sticky", "breakaway", "hysteresis"})
    for (std::size_t i = 0; i < 6; ++i) {
      const Case made = generated(family_named(name), i);
      const Program program = compiling::Compiled(made.source).only();
      const double size = made.truth[Cue::friction].value;
      for (const double speed : {0.4, 0.1}) EXPECT_NEAR(resistance(program, speed), size, 0.002 * size) << made.name;
    }
}

TEST(Truth, ABristleHoldsUpToItsBreakaway) {
  for (std::size_t i = 0; i < 6; ++i) {
    const Case made = generated(family_named("breakaway"), i);
    standard::Stroke stroke(compiling::Compiled(made.source).only());
    double most = 0;
    for (int step = 1; step <= 1000; ++step)  // 9 mm/s: slower than what keeps it sliding
      most = std::max(most, -stroke.move({1e-5 * step, 0}).x);
    const double held = made.truth[Cue::breakaway].value;
    EXPECT_NEAR(most, held, 0.02 * held) << made.name;
    EXPECT_GT(held, 1.2 * made.truth[Cue::friction].value) << made.name;
  }
}

TEST(Truth, ATiringSpringIsStiffAtTheFirstTouch) {
  for (std::size_t i = 0; i < 6; ++i) {
    const Case made = generated(family_named("tiring spring"), i);
    const standard::Stroke stroke(compiling::Compiled(made.source).only(), {0.02, 0});
    EXPECT_NEAR(-stroke.force().x / 0.02, made.truth[Cue::stiffness].value, 1e-3) << made.name;
  }
}

}  // namespace
}  // namespace wale::truth
