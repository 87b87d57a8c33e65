// The whole library in the simulated hand: the passivity observer has nothing to do on what is passive there.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "compiler/grade/grade.hpp"
#include "runtime/machine/parallel.hpp"
#include "tests/library/shelf.hpp"
#include "wale/simulated.hpp"
#include "wale/stage.hpp"

namespace wale::observed_test {
namespace {

/// Ticks on which the observer acted, in four seconds of rubbing to and fro and going round.
long acted_on(const Program& program) {
  const HandModel normal{.mass = 0.55, .damping = 6.5, .stiffness = 135};
  long acted = 0;
  for (const Motion& motion : {Motion(Lateral{0.04, 1}), Motion(Circular{0.03, 0.7})}) {
    SimulatedJoystick joystick(program.description().device, normal, motion);
    Stage stage(joystick);
    stage.place(program);
    const auto run = stage.run({.seconds = 2, .virtual_time = true});
    const auto* result = std::get_if<RunResult>(&run);
    acted += result ? result->guards.passivity : 1;
  }
  return acted;
}

TEST(Observed, NothingIsDoneToWhatIsPassiveInTheHand) {
  std::vector<Program> passive;
  for (const Program& program : shelf::programs()) {
    const Grade graded = grade(Bank(program));
    const bool calm = graded.required_damping <= graded.device_damping + graded.hand_damping;
    if (calm && !graded.energy.active() && program.description().active_watt == 0) passive.push_back(program);
  }
  ASSERT_GT(passive.size(), 100u);
  std::vector<long> acted(passive.size());
  in_parallel(passive.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) acted[i] = acted_on(passive[i]);
  });
  for (std::size_t i = 0; i < passive.size(); ++i) EXPECT_EQ(acted[i], 0) << passive[i].description().material;
}

}  // namespace
}  // namespace wale::observed_test
