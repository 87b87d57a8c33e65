// The whole library in the simulated hand: the passivity observer does not act on materials that are passive there.
#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include "compiler/grade/grade.hpp"
#include "compiler/modules/load_modules.hpp"
#include "runtime/machine/parallel.hpp"
#include "tests/library/shelf.hpp"
#include "wale/simulated.hpp"
#include "wale/stage.hpp"

namespace wale::observed_test {
namespace {

/// The guards' counts in two seconds of rubbing to and fro and two seconds of circling.
GuardCounts guarded(const Program& program) {
  const HandModel normal{.mass = 0.55, .damping = 6.5, .stiffness = 135};
  GuardCounts all;
  for (const Motion& motion : {Motion(Lateral{0.04, 1}), Motion(Circular{0.03, 0.7})}) {
    SimulatedJoystick joystick(program.description().device, normal, motion);
    Stage stage(joystick);
    Patch patch = *stage.add(program);
    const auto run = stage.run({.seconds = 2, .virtual_time = true});
    if (!run) throw std::runtime_error(in_words(run.error()));
    all.passivity += run->guards.passivity;
    all.energy += run->guards.energy;
  }
  return all;
}

/// The same program, with a device whose force is delayed by that many ticks.
Program late(const Program& program, double ticks) {
  PatchProgram description = program.description();
  description.device.damping_known = true;
  description.device.delay_x = description.device.delay_y = ticks / description.device.rate;
  auto loaded = Program::load(std::move(description));
  if (!loaded) throw std::runtime_error(in_words(loaded.error()));
  return *std::move(loaded);
}

/// With a delay, the observer does not act on materials that are passive by the device's damping. It acts on at most 5
/// % of those that need the hand's damping, which it does not know.
TEST(Observed, NothingIsDampedWithADelayEither) {
  const std::vector<Program> programs = shelf::programs();
  std::vector<std::string> damped(programs.size());
  std::atomic<long> on_device = 0, in_hand = 0, damped_in_hand = 0;
  in_parallel(programs.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (const double ticks : {1.0, 2.0}) {
        const Program program = late(programs[i], ticks);
        const Grade graded = grade(Bank(program), normal_hand(common_modules()->declarations));
        if (graded.energy.active() || graded.required_damping > graded.device_damping + graded.hand_damping) continue;
        const bool acted = guarded(program).passivity > 0;
        if (graded.required_damping <= graded.device_damping) {
          ++on_device;
          if (acted) damped[i] = program.description().material;
        } else {
          ++in_hand;
          damped_in_hand += acted;
        }
      }
  });
  for (const std::string& name : damped) EXPECT_EQ(name, "");
  EXPECT_GT(on_device, 20);
  EXPECT_GT(in_hand, 20);
  EXPECT_LE(damped_in_hand, in_hand / 20) << in_hand;
}

TEST(Observed, NothingIsDampedThatIsPassiveInTheHandAndNoDeclaredEnergyIsLimited) {
  const std::vector<Program> programs = shelf::programs();
  ASSERT_GT(programs.size(), 100u);
  std::vector<GuardCounts> counts(programs.size());
  in_parallel(programs.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) counts[i] = guarded(programs[i]);
  });
  long calm = 0;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    const std::string& name = programs[i].description().material;
    EXPECT_EQ(counts[i].energy, 0) << name;
    const Grade graded = grade(Bank(programs[i]), normal_hand(common_modules()->declarations));
    if (graded.energy.active() || graded.required_damping > graded.device_damping + graded.hand_damping) continue;
    ++calm;
    EXPECT_EQ(counts[i].passivity, 0) << name;
  }
  EXPECT_GT(calm, 30);
}

}  // namespace
}  // namespace wale::observed_test
