// Programs for devices that only vibrate: which the loader accepts, and its reasons for refusing the others.

#include <gtest/gtest.h>

#include <limits>

#include "schema/without_place.hpp"
#include "tests/schema/example_program.hpp"
#include "wale/program.hpp"

namespace wale::verification_of_pads_test {
namespace {

std::string refusal_of(PatchProgram program) {
  const auto loaded = Program::load(std::move(program));
  return !loaded ? in_words_without_place(loaded.error()) : "";
}

template <typename Change>
std::string refusal_after(Change change, PositionSource source = PositionSource::touch) {
  PatchProgram pad = example::pad(source);
  change(pad);
  return refusal_of(std::move(pad));
}

TEST(VerificationOfPads, TakesAmplitudeAndFrequencyWithAndWithoutAPosition) {
  for (const PositionSource source : {PositionSource::none, PositionSource::pointer, PositionSource::touch})
    EXPECT_EQ(refusal_of(example::pad(source)), "");
}

TEST(VerificationOfPads, OutputsAreThoseOfTheDevice) {
  const std::string neither = "an output is neither amplitude nor frequency, the only outputs of this device";
  EXPECT_EQ(refusal_after([](auto& p) { p.outputs[0].quantity = OutputQuantity::force; }), neither);
  EXPECT_EQ(refusal_after([](auto& p) { p.outputs[1].axis = 1; }), neither);
  EXPECT_EQ(refusal_after([](auto& p) { p.outputs.pop_back(); }), "output frequency occurs 0 times, expected once");
  EXPECT_EQ(refusal_after([](auto& p) { p.outputs[1] = p.outputs[0]; }),
            "output amplitude occurs 2 times, expected once");
  PatchProgram joystick = example::least();
  joystick.outputs = example::pad().outputs;
  EXPECT_EQ(refusal_of(joystick), "an output is neither force x nor force y");
}

TEST(VerificationOfPads, EachOutputHasItsOwnCeiling) {
  EXPECT_EQ(refusal_after([](auto& p) { p.constants[1] = 16.01f; }),
            "output amplitude has register 33 as its ceiling, expected a constant above 0 and up to 16 m/s^2, "
            "or a register that setup limits by such a constant");
  EXPECT_EQ(refusal_after([](auto& p) { p.constants[2] = 200.1f; }),
            "output frequency has register 34 as its ceiling, expected a constant above 0 and up to 200 Hz, "
            "or a register that setup limits by such a constant");
  // The frequency's ceiling of 200 is valid for the frequency and too high for the amplitude.
  EXPECT_EQ(refusal_after([](auto& p) { p.tick[2].b = p.outputs[0].ceiling = 34; }).substr(0, 35),
            "output amplitude has register 34 as");
  EXPECT_EQ(refusal_after([](auto& p) { p.tick[3].operation = static_cast<std::uint8_t>(Operation::minimum); }),
            "output frequency is written last by tick 3 `minimum`, expected a `limit`");
}

TEST(VerificationOfPads, TheDeviceMakesSense) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal_after([](auto& p) { p.device.force_newton = 3; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.device.shaker->frequency_high = 30; }), "") << "below the least";
  EXPECT_NE(refusal_after([](auto& p) { p.device.shaker->frequency_low = 0; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.device.shaker->spin_up = -1; }), "");
  EXPECT_NE(refusal_after([&](auto& p) { p.device.shaker->command_steps = nan; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.device.shaker->response.clear(); }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.device.shaker->response[0].points.clear(); }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.device.shaker->response[0].points[1].acceleration = 4; }), "") << "level";
  EXPECT_NE(refusal_after([](auto& p) { p.device.shaker->response[0].points[1].command = 1.1; }), "");
  EXPECT_NE(refusal_after([&](auto& p) { p.device.shaker->response[0].points[0].acceleration = nan; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.device.shaker->response[1].frequency = 40; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.device.workspace_diameter = 0; }), "") << "it has a position";
  const auto none = PositionSource::none;
  EXPECT_NE(refusal_after([](auto& p) { p.device.workspace_diameter = 0.1; }, none), "") << "it has none";
  EXPECT_NE(refusal_after([](auto& p) { p.device.speed_limit = 1; }, none), "");
  EXPECT_NE(refusal_after([](auto& p) { p.device.shaker->exploring_speed = 0; }, none), "");
}

TEST(VerificationOfPads, FatesAreKnownAndWithinTheirRange) {
  EXPECT_EQ(refusal_after([](auto& p) { p.fates[0].name.clear(); }), "fate 0 has no name");
  EXPECT_NE(refusal_after([](auto& p) { p.fates[0].fate = Fate{0}; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.fates[0].asked = 1.5f; }), "");
  EXPECT_NE(refusal_after([](auto& p) { p.fates[0].given = -0.5f; }), "");
}

TEST(VerificationOfPads, ATickGivesAmplitudeAndFrequency) {
  const auto loaded = Program::load(example::pad());
  Bank bank(*loaded);
  for (const float speed : {0.0f, 0.01f, -0.2f, 0.4f}) {
    const Force drive = tick(bank, {.velocity = {speed, 0.3f}});
    EXPECT_EQ(drive.x, 5);
    EXPECT_FLOAT_EQ(drive.y, std::abs(speed) * 400);
  }
  EXPECT_EQ(tick(bank, {.velocity = {0.9f, 0}}).y, 200) << "its ceiling";
  // Without a position there is no speed to read.
  const auto blind = Program::load(example::pad(PositionSource::none));
  Bank without(*blind);
  EXPECT_EQ(tick(without, {.velocity = {0.1f, 0}}).y, 0);
}

}  // namespace
}  // namespace wale::verification_of_pads_test
