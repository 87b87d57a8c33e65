// Devices that only vibrate: their response, the simulated pad, and a stage on it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "runtime/stage/guards.hpp"
#include "schema/without_place.hpp"
#include "tests/runtime/programs.hpp"
#include "tests/schema/example_program.hpp"
#include "wale/felt.hpp"
#include "wale/simulated_pad.hpp"
#include "wale/stage.hpp"

namespace wale::pads_test {
namespace {

using example::pad_device;

Program ribs(PositionSource source = PositionSource::touch) { return *Program::load(example::pad(source)); }

RunResult run(Stage& stage, double seconds) {
  auto result = stage.run({.seconds = seconds, .virtual_time = true, .progress = {}, .stop = nullptr});
  if (!result) throw std::runtime_error(in_words(result.error()));
  return *std::move(result);
}

// The bench pad gives at 40 Hz 4 m/s^2 at half command and 8 at full, and at 120 Hz 6 at a quarter and 16 at full.
TEST(Pads, TheResponseIsStraightBetweenItsPoints) {
  const Shaker shaker = *pad_device().shaker;
  EXPECT_DOUBLE_EQ(shaker.peak(), 16);
  EXPECT_DOUBLE_EQ(shaker.acceleration(0, 40), 0);
  EXPECT_DOUBLE_EQ(shaker.acceleration(0.25, 40), 2);
  EXPECT_DOUBLE_EQ(shaker.acceleration(0.75, 40), 6);
  EXPECT_DOUBLE_EQ(shaker.acceleration(1, 10), 8) << "as at the lowest frequency";
  EXPECT_DOUBLE_EQ(shaker.acceleration(0.625, 120), 11);
  EXPECT_DOUBLE_EQ(shaker.acceleration(1, 500), 16);
  EXPECT_DOUBLE_EQ(shaker.acceleration(0.5, 80), (4 + 6 + 10.0 / 3) / 2) << "half way between 40 and 120 Hz";
}

TEST(Pads, TheCommandIsTheInverseOfTheResponse) {
  const Shaker shaker = *pad_device().shaker;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> commands(0, 1), frequencies(20, 200);
  for (int i = 0; i < 1000; ++i) {
    const double command = commands(random), frequency = frequencies(random);
    ASSERT_NEAR(shaker.command(shaker.acceleration(command, frequency), frequency), command, 1e-12) << frequency;
  }
  EXPECT_EQ(shaker.command(1000, 80), 1) << "the full command";
  EXPECT_EQ(shaker.command(0, 80), 0);
}

// A first-order approach: after t it is 1 - exp(-t / spin_up) of the final value. The simulation's steps are 1/40 ms.
TEST(Pads, SpinUpIsExponential) {
  SimulatedPad pad(pad_device(), Rest{});
  pad.command({6, 60});
  for (int tick = 1; tick <= 100; ++tick) {
    pad.elapse(1);
    const double expected = 6 * (1 - std::exp(-tick / 20.0));
    ASSERT_NEAR(pad.command({6, 60}).x, expected, 0.02) << tick;
  }
  pad.command({0, 60});
  pad.elapse(20);
  EXPECT_NEAR(pad.command({0, 60}).x, 6 * (1 - std::exp(-5.0)) * std::exp(-1.0), 0.02);
}

TEST(Pads, AmplitudeAndFrequencyStayWithinTheResponse) {
  SimulatedPad pad(pad_device(), Rest{});
  pad.command({16, 40});
  pad.elapse(1000);
  EXPECT_NEAR(pad.command({16, 40}).x, 8, 1e-4) << "the most at 40 Hz";
  pad.command({-3, 40});
  pad.elapse(1000);
  EXPECT_NEAR(pad.command({0, 10}).x, 0, 1e-4);
  EXPECT_EQ(pad.command({0, 10}).y, 40) << "the lowest frequency";
  EXPECT_EQ(pad.command({0, 900}).y, 200);
  pad.command({std::nanf(""), 100});
  pad.elapse(1000);
  EXPECT_NEAR(pad.command({0, 40}).x, 0, 1e-4);
}

TEST(Pads, CommandsHaveSteps) {
  DeviceProfile profile = pad_device();
  profile.shaker->command_steps = 4;  // at 40 Hz: 0, 2, 4, 6, 8 m/s^2
  profile.shaker->spin_up = 0;
  SimulatedPad pad(profile, Rest{});
  for (const auto& [asked, given] : std::vector<std::pair<float, float>>{{0.9f, 0}, {1.1f, 2}, {4.9f, 4}, {7.5f, 8}}) {
    pad.command({asked, 40});
    pad.elapse(1);
    EXPECT_NEAR(pad.command({asked, 40}).x, given, 1e-6) << asked;
  }
}

TEST(Pads, GuardsHoldAmplitudeAndFrequencyAndSlewTheAmplitude) {
  Guards guards(pad_device());  // 2000 m/s^3 at 1000 Hz: 2 m/s^2 a tick
  EXPECT_EQ(guards({5, 100}, glm::dvec2(0), 1), Force(2, 100)) << "the amplitude slews, the frequency does not";
  EXPECT_EQ(guards({5, 150}, glm::dvec2(0), 1), Force(4, 150));
  EXPECT_EQ(guards({5, 150}, glm::dvec2(0), 1), Force(5, 150));
  EXPECT_EQ(guards({-4, 10}, glm::dvec2(0), 1), Force(0, 40))
      << "the amplitude is at least 0, the frequency at least the lowest";
  EXPECT_EQ(guards({99, 999}, glm::dvec2(0), 1), Force(16, 200));
  EXPECT_EQ(guards({std::nanf(""), 100}, glm::dvec2(0), 1), Force(0, 40));
  EXPECT_EQ(guards.counts().not_a_number, 1);
}

// A finger moves to and fro over ribs of 2.5 mm. At speed v the frequency is v / 2.5 mm.
TEST(Pads, AStageRunsRibsUnderAFinger) {
  SimulatedPad pad(pad_device(), Lateral{.amplitude = 0.03, .frequency = 1, .centre = {}});
  Stage stage(pad);
  Patch patch = *stage.add(ribs());
  const RunResult result = run(stage, 2);
  EXPECT_TRUE(result.record.vibrates);
  double fastest = 0;
  for (const TickRecord& tick : result.record.ticks) {
    const double speed = std::abs(tick.velocity.x);
    ASSERT_NEAR(tick.force.y, std::clamp(speed / 0.0025, 40.0, 200.0), 1e-3);
    fastest = std::max(fastest, speed);
  }
  EXPECT_NEAR(fastest, 2 * 3.14159265 * 0.03, 0.07 * fastest) << "within the error of the velocity filter";
  const Felt felt = measure(
      result.record,
      {.position_step = pad.profile().position_step(), .predicted_amplitude = 0, .settling = 0.5, .vibrates = true});
  ASSERT_TRUE(felt.vibration);
  EXPECT_NEAR(felt.vibration->acceleration.p99, 5, 0.05);
  EXPECT_NEAR(felt.vibration->acceleration.rms, 5, 0.05);
  EXPECT_NEAR(felt.position_range, 0.06, 1e-3);
  EXPECT_EQ(felt.vibration->lowest, 40);
}

TEST(Pads, AStageRunsWithoutAPosition) {
  SimulatedPad pad(pad_device(PositionSource::none), Lateral{.amplitude = 0.03, .frequency = 1, .centre = {}});
  Stage stage(pad);
  Patch patch = *stage.add(ribs(PositionSource::none));
  const RunResult result = run(stage, 1);
  for (const TickRecord& tick : result.record.ticks) {
    ASSERT_TRUE(tick.inside);
    ASSERT_EQ(tick.position, glm::vec2(0));
    ASSERT_EQ(tick.velocity, glm::vec2(0));
  }
  EXPECT_NEAR(result.record.ticks.back().force.x, 5, 1e-3);
}

TEST(Pads, ProgramsOfTheOtherKindAreRefused) {
  SimulatedPad pad(pad_device(), Rest{});
  Stage on_pad(pad);
  EXPECT_EQ(in_words_without_place(on_pad.add(push(1)).error()),
            "by hand was built for sandpaper, which pushes, and bench pad only vibrates; build it for bench pad");
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Rest{});
  Stage on_joystick(joystick);
  EXPECT_EQ(in_words_without_place(on_joystick.add(ribs()).error()),
            "bench ribs was built for bench pad, which vibrates, and sandpaper pushes; build it for sandpaper");
}

}  // namespace
}  // namespace wale::pads_test
