// The stage with programs that have states, and the inputs that it gives to programs.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "runtime/stage/player.hpp"
#include "tests/runtime/figures.hpp"
#include "tests/runtime/placed.hpp"
#include "tests/runtime/programs.hpp"
#include "wale/stage.hpp"

namespace wale::remembering_test {
namespace {

/// A device whose reading is a function of the period, in counts.
class Puppet : public Device {
 public:
  explicit Puppet(std::function<Reading(long)> reading) : reading_(std::move(reading)) { profile_.slew = 1e9; }
  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long periods) noexcept override { elapsed_ += periods; }
  Reading sample() noexcept override { return reading_(elapsed_); }
  Force command(Force force) noexcept override { return force; }

 private:
  DeviceProfile profile_ = sandpaper();
  std::function<Reading(long)> reading_;
  long elapsed_ = 0;
};

constexpr int beyond = 2000;  // counts: 112 mm from the centre, outside the patch of 160 mm

RunResult run(Stage& stage, long ticks, std::function<void(const Now&)> progress = {}) {
  auto result = stage.run({.seconds = static_cast<double>(ticks) / 900, .virtual_time = true, .progress = progress});
  if (!result) {
    ADD_FAILURE() << in_words(result.error());
    return {};
  }
  return *std::move(result);
}

/// force x = an input times a gain.
Program feeling(Input input, float gain = 1) {
  Assembly a({9, gain, 0});
  a.push(0, a.tick(Operation::multiply, a.input(input), a.constant(1)), a.constant(0));
  a.push(1, a.constant(2), a.constant(0));
  return a.load();
}

/// force x = ticks since the hand entered, times the parameter `gain`; force y = the time of the entry in s. Times stay
/// below the ceiling.
Program counting() {
  Assembly a({9, 0, 1}, {{"gain", "", 1, 0.001f, 0, 1, 0, 1, ""}});
  const RegisterNumber count = a.state("count", 0, 1e6f), since = a.state("since", 0, 1e6f);
  a.evolve(count, a.constant(1), a.tick(Operation::add, count, a.constant(2)));
  a.evolve(since, a.input(Input::time), since);
  a.push(0, a.tick(Operation::multiply, count, a.parameter(0)), a.constant(0));
  a.push(1, since, a.constant(0));
  return a.load();
}

TEST(Remembering, StatesBeginWheneverTheHandEnters) {
  // Outside for periods 0-9, 100-119 and 200-.
  Puppet device([](long period) {
    const bool outside = period < 10 || (period >= 100 && period < 120) || period >= 200;
    return Reading{.counts = {outside ? beyond : 0, 0}};
  });
  Stage stage(device);
  Patch patch = *stage.add(counting());
  const auto ticks = run(stage, 220).record.ticks;
  for (long i = 0; i < 220; ++i) {
    const bool outside = i < 10 || (i >= 100 && i < 120) || i >= 200;
    const long entered = i < 100 ? 10 : 120;
    ASSERT_NEAR(ticks[i].force.x, outside ? 0 : 0.001 * static_cast<double>(i - entered), 1e-6) << i;
    ASSERT_NEAR(ticks[i].force.y, outside ? 0 : static_cast<double>(entered) / 900, 1e-6) << i;
  }
}

TEST(Remembering, AChangedParameterKeepsTheStates) {
  Puppet device([](long) { return Reading{}; });
  Stage stage(device);
  Patch patch = *stage.add(counting());
  const auto turn = [&](const Now& now) {
    EXPECT_TRUE(patch.set("gain", 0.001f * static_cast<float>(1 + now.ticks_run / 90)));
  };
  const auto ticks = run(stage, 450, turn).record.ticks;
  for (long i = 0; i < 450; ++i) {
    ASSERT_NEAR(ticks[i].force.x, 0.001 * static_cast<double>((1 + i / 90) * i), 1e-4) << i;
  }
}

TEST(Remembering, APatchPlacedAnewBeginsAnewEvenUnderTheHand) {
  Puppet device([](long) { return Reading{}; });
  Stage stage(device);
  const Program program = counting();
  Patch patch = *stage.add(program);
  const auto again = [&](const Now& now) {
    if (now.ticks_run != 180) return;
    StageEdit edit = stage.edit();
    edit.remove(patch);
    EXPECT_TRUE(edit.add(program));
    EXPECT_TRUE(edit.commit());
  };
  const auto ticks = run(stage, 270, again).record.ticks;
  EXPECT_NEAR(ticks[179].force.x, 0.179, 1e-6);
  EXPECT_NEAR(ticks[180].force.x, 0, 1e-6);
  EXPECT_NEAR(ticks[180].force.y, 0.2, 1e-6);
  EXPECT_NEAR(ticks[269].force.x, 0.089, 1e-6);
}

TEST(Remembering, EachRunBeginsAnew) {
  Puppet device([](long) { return Reading{}; });
  Stage stage(device);
  Patch patch = *stage.add(counting());
  for (int i = 0; i < 2; ++i) {
    const auto ticks = run(stage, 50).record.ticks;
    EXPECT_NEAR(ticks[49].force.x, 0.049, 1e-6);
    EXPECT_EQ(ticks[49].force.y, 0);
  }
}

TEST(Remembering, ABeadIsPulledAlong) {
  // The hand moves 20 mm at once; the bead follows by semi-implicit Euler.
  const double step = sandpaper().position_step(), dt = 1 / 900.0;
  Puppet device([](long period) { return Reading{.counts = {period < 5 ? 0 : 358, 0}}; });
  Stage stage(device);
  Patch patch = *stage.add(bead(200));
  const RunResult result = run(stage, 900);
  double place = 0, speed = 0;
  for (long i = 0; i < 900; ++i) {
    const double pull = 200 * ((i < 5 ? 0 : 358 * step) - place);
    ASSERT_NEAR(result.record.ticks[i].force.x, -pull, 2e-3) << i;
    speed += pull * dt;
    place += speed * dt;
  }
  EXPECT_EQ(result.guards.restored, 0);
}

TEST(Remembering, StatesThatAreNotNumbersAreCounted) {
  // next = 0 / 0 while the hand is right of the centre, else 1 / 1.
  Assembly a({9, 0, 1});
  const RegisterNumber state = a.state("state", 0, 1);
  const RegisterNumber right = a.tick(Operation::less, a.constant(1), a.input(Input::x));
  const RegisterNumber whole = a.tick(Operation::subtract, a.constant(2), right);
  a.evolve(state, a.constant(1), a.tick(Operation::divide, whole, whole));
  a.push(0, state, a.constant(0));
  a.push(1, a.constant(1), a.constant(0));
  Puppet device([](long period) { return Reading{.counts = {period >= 20 && period < 50 ? 10 : -10, 0}}; });
  Stage stage(device);
  Patch patch = *stage.add(a.load());
  const RunResult result = run(stage, 100);
  EXPECT_EQ(result.guards.restored, 30);
  EXPECT_EQ(result.guards.not_a_number, 0);
  for (long i = 0; i < 100; ++i) {
    ASSERT_EQ(result.record.ticks[i].force.x, i == 0 || (i > 20 && i <= 50) ? 0.0f : 1.0f) << i;
  }
}

/// Like `counting`, with another gain, another range, one more parameter, and a state `fresh` that begins at 7 in place
/// of `since`.
Program counting_too(float gain, bool renamed = false) {
  Assembly a({9, 7, 1}, {{"other", "", 1, 0.25f, 0, 1, 0, 1, ""}, {"gain", "", 1, gain, 0, 0.5f, 0, 0.5f, ""}});
  const RegisterNumber fresh = a.state("fresh", 0, 100);
  const RegisterNumber count = a.state(renamed ? "ticks" : "count", 0, 1e6f);
  a.evolve(fresh, a.constant(1), fresh);
  a.evolve(count, a.constant(2), a.tick(Operation::add, count, a.constant(2)));
  a.push(0, a.tick(Operation::multiply, count, a.parameter(1)), a.constant(0));
  a.push(1, fresh, a.constant(0));
  return a.load();
}

TEST(Replacing, KeepsParametersAndStatesOfTheSameNameAndStartsTheOthers) {
  Puppet device([](long) { return Reading{}; });
  Stage stage(device);
  Patch patch = *stage.add(counting());
  ASSERT_TRUE(patch.set("gain", 0.004f));
  const auto result = run(stage, 300, [&](const Now& now) {
    if (now.ticks_run == 90) {
      EXPECT_TRUE(patch.replace(counting_too(0.1f)));
    }
    if (now.ticks_run == 180) {
      EXPECT_TRUE(patch.replace(counting_too(0.1f, true)));
    }
  });
  const auto& ticks = result.record.ticks;
  EXPECT_NEAR(ticks[89].force.x, 0.004 * 89, 1e-5);
  EXPECT_NEAR(ticks[90].force.x, 0.004 * 90, 1e-5) << "the count and the gain are kept";
  EXPECT_EQ(ticks[90].force.y, 7);
  EXPECT_NEAR(ticks[179].force.x, 0.004 * 179, 1e-5);
  EXPECT_NEAR(ticks[180].force.x, 0.004 * 1, 1e-5) << "a state with another name is new";
}

TEST(Replacing, AStateOfAnotherUnitIsAnotherState) {
  const auto counting_in = [](const std::string& unit) {
    PatchProgram program = counting().description();
    program.states[0].si_unit = unit;
    return *Program::load(program);
  };
  Puppet device([](long) { return Reading{}; });
  Stage stage(device);
  Patch patch = *stage.add(counting_in("m"));
  const auto result = run(stage, 300, [&](const Now& now) {
    if (now.ticks_run == 90) {
      EXPECT_TRUE(patch.replace(counting_in("m")));
    }
    if (now.ticks_run == 180) {
      EXPECT_TRUE(patch.replace(counting_in("kg")));
    }
  });
  EXPECT_NEAR(result.record.ticks[90].force.x, 0.090, 1e-6);
  EXPECT_NEAR(result.record.ticks[180].force.x, 0, 1e-6) << "a state with another unit is new";
  EXPECT_NEAR(result.record.ticks[299].force.x, 0.119, 1e-6);
  EXPECT_NEAR(result.record.ticks[180].force.y, 0, 1e-6) << "the other state is kept";
}

TEST(Replacing, SeveralTimesBeforeATickTakesTheLastAndKeepsStates) {
  Puppet device([](long) { return Reading{}; });
  Stage stage(device);
  Patch patch = *stage.add(counting());
  ASSERT_TRUE(patch.set("gain", 0.002f));
  const auto result = run(stage, 200, [&](const Now& now) {
    if (now.ticks_run != 90) return;
    for (const float gain : {0.3f, 0.2f, 0.4f}) EXPECT_TRUE(patch.replace(counting_too(gain)));
  });
  EXPECT_NEAR(result.record.ticks[90].force.x, 0.002 * 90, 1e-5);
}

TEST(Replacing, OutsideOfTheHandStatesBeginAtTheNextEntry) {
  Puppet device([](long period) { return Reading{.counts = {period > 50 && period <= 150 ? beyond : 0, 0}}; });
  Stage stage(device);
  Patch patch = *stage.add(counting());
  const auto result = run(stage, 300, [&](const Now& now) {
    if (now.ticks_run == 90) {
      EXPECT_TRUE(patch.replace(counting_too(0.1f)));
    }
  });
  EXPECT_NEAR(result.record.ticks[151].force.x, 0.1 * 1, 1e-5) << "the gain was not set, so it is the new default";
}

TEST(Replacing, KeepsTheCellsOfGrids) {
  // The bead has written into the middle of its track. A program with a stiffer spring that replaces it keeps the
  // track.
  const Program soft = bead(100), stiff = bead(200);
  Bank bank(soft);
  auto first = std::make_shared<Memory>(soft);
  first->enter(bank, {});
  tick(bank, *first, {});
  ASSERT_EQ(first->grid(0)[4], 1);
  auto second = std::make_shared<Memory>(stiff, first);
  EXPECT_TRUE(second->follows(first.get()));
  EXPECT_EQ(second->grid(0)[4], 0);
  second->succeed(false);
  EXPECT_EQ(second->grid(0)[4], 1);
  EXPECT_FALSE(second->follows(first.get()));
}

TEST(Inputs, TimeIsTheNumberOfPeriods) {
  Puppet device([](long) { return Reading{}; });
  Stage stage(device);
  Patch patch = *stage.add(feeling(Input::time));
  const auto ticks = run(stage, 900).record.ticks;
  for (long i = 0; i < 900; ++i) ASSERT_NEAR(ticks[i].force.x, static_cast<double>(i) / 900, 1e-6);
}

TEST(Inputs, SkippedPeriodsCountTowardsTime) {
  Puppet device([](long) { return Reading{}; });
  Exchange<PlacedPatches> patches;
  Record record;
  Player player(device, patches, record, 3);
  const Program program = feeling(Input::time);
  patches.publish(placed(program));
  player.serve({.period = 0});
  player.serve({.period = 450, .elapsed = 450, .skipped = 449});
  EXPECT_EQ(record.ticks[1].force.x, 0) << "the first tick after half a second of missed periods has no force";
  player.serve({.period = 451, .elapsed = 1});
  EXPECT_FLOAT_EQ(record.ticks[2].force.x, 451 / 900.0f);
}

TEST(Inputs, TheButton) {
  Puppet device([](long period) { return Reading{.button = period % 3 == 0}; });
  Stage stage(device);
  Patch patch = *stage.add(feeling(Input::button));
  const auto ticks = run(stage, 30).record.ticks;
  for (long i = 0; i < 30; ++i) ASSERT_EQ(ticks[i].force.x, i % 3 == 0 ? 1.0f : 0.0f);
}

TEST(Inputs, ThePlaceOnTheWorkspace) {
  Puppet device([](long) { return Reading{.counts = {358, -179}}; });
  Stage stage(device);
  Patch patch = *stage.add(feeling(Input::workspace_x), {.at = {0.01f, 0.02f}});
  EXPECT_NEAR(run(stage, 3).record.ticks[2].force.x, 358 * 0.2286 / 4096, 1e-7);
  ASSERT_TRUE(patch.replace(feeling(Input::workspace_y)));
  EXPECT_NEAR(run(stage, 3).record.ticks[2].force.x, -179 * 0.2286 / 4096, 1e-7);
  ASSERT_TRUE(patch.replace(feeling(Input::x)));
  EXPECT_NEAR(run(stage, 3).record.ticks[2].force.x, 358 * 0.2286 / 4096 - 0.01, 1e-7);
}

// x = t^2 counts and y = -2 t^2: the raw velocity along x is 2 t - 1 counts per tick, and the acceleration is 2 counts
// per tick^2 by any estimate.
TEST(Inputs, MotionInMetresAndSeconds) {
  const double step = 0.2286 / 4096, rate = 900;
  const auto reading = [](long period) {
    const auto square = static_cast<int>(period * period);
    return Reading{.counts = {square, -2 * square}};
  };
  const auto felt = [&](Input input, float gain) {
    Puppet device(reading);
    Stage stage(device);
    Patch patch = *stage.add(feeling(input, gain));
    return run(stage, 20).record.ticks[9].force.x / gain;
  };
  EXPECT_NEAR(felt(Input::raw_velocity_x, 1), 17 * step * rate, 1e-5);
  EXPECT_NEAR(felt(Input::raw_velocity_y, 1), -1, 1e-6) << "held at the speed limit";
  EXPECT_NEAR(felt(Input::raw_acceleration_x, 0.01f), 2 * step * rate * rate, 1e-3);
  EXPECT_NEAR(felt(Input::raw_acceleration_y, 0.01f), -4 * step * rate * rate, 1e-3);
  EXPECT_NEAR(felt(Input::acceleration_x, 0.01f), 2 * step * rate * rate, 1e-3);
  EXPECT_NEAR(felt(Input::acceleration_y, 0.01f), -4 * step * rate * rate, 1e-3);
}

}  // namespace
}  // namespace wale::remembering_test
