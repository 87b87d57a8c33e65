// Devices that only vibrate, on the command line: building, feeling, describing, sampling, drawing, and refusals.

#include <gtest/gtest.h>

#include "tests/command_line/running.hpp"

namespace wale::command_line::pads_test {
namespace {

TEST(Pads, AMaterialIsFeltOnEach) {
  for (const std::string device : {"touch_pad", "gamepad"}) {
    const Outcome outcome = wale({"feel", corduroy, "--device", device, "--virtual-time", "--json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto felt = outcome.json();
    EXPECT_EQ(felt.at("profile"), device);
    // Level 0.6 is 12 m/s^2 * 0.6^(1/0.76), and the measurement gives it back.
    EXPECT_NEAR(felt.at("vibration").at("p99_m_per_s2"), 6.127, 0.05);
    EXPECT_NEAR(felt.at("percepts").at("roughness").at("level"), 0.6, 0.01);
    EXPECT_LE(felt.at("vibration").at("lowest_hz"), felt.at("vibration").at("highest_hz"));
    EXPECT_EQ(wale({"feel", corduroy, "--device", device, "--virtual-time", "--seconds", "0.2"}).status, 0);
  }
  const std::string text = wale({"feel", corduroy, "--device", "gamepad", "--virtual-time"}).out;
  EXPECT_TRUE(contains(text, "place        none")) << text;
  EXPECT_TRUE(contains(text, "gamepad, hand at an assumed 0.1 m/s,")) << text;
}

TEST(Pads, AProgramHoldsItsFates) {
  const TemporaryFolder folder;
  const std::string program = folder / "pad.wpp";
  ASSERT_EQ(wale({"build", corduroy, "--device", "gamepad", "-o", program}).status, 0);
  const auto described = wale({"describe", program, "--json"}).json();
  EXPECT_EQ(described.at("fates").at("percepts").at("roughness").at("fate"), "approximated");
  EXPECT_EQ(described.at("fates").at("physics").at("place of features").at("fate"), "lost");
  EXPECT_EQ(described, wale({"describe", corduroy, "--device", "gamepad", "--json"}).json());
  EXPECT_FALSE(described.contains("force"));
  EXPECT_EQ(described.at("grade").at("name"), "does not apply");
  const std::string text = wale({"describe", program}).out;
  EXPECT_TRUE(contains(text, "\non gamepad\n")) << text;
  EXPECT_TRUE(contains(text, "does not apply: it only vibrates")) << text;
  const auto joystick = wale({"describe", corduroy, "--json"}).json();
  EXPECT_EQ(joystick.at("fates").at("percepts").at("roughness").at("fate"), "kept");
  // A program is felt only on the device that it was built for.
  EXPECT_EQ(wale({"feel", program, "--device", "sandpaper", "--virtual-time"}).status, 2);
  EXPECT_EQ(wale({"feel", program, "--virtual-time"}).status, 0);
}

TEST(Pads, EveryVerbTakesTheirPrograms) {
  const TemporaryFolder folder;
  for (const std::string device : {"touch_pad", "gamepad"}) {
    const std::string program = folder / (device + ".wpp");
    ASSERT_EQ(wale({"build", corduroy, "--device", device, "-o", program}).status, 0);
    EXPECT_EQ(wale({"preview", program, "-o", folder / "pad.png"}).status, 0);
    const Outcome sample = wale({"sample", program, "--at", "1 mm, 0 mm, 0.1 m/s, 0 m/s"});
    EXPECT_EQ(sample.status, 0);
    EXPECT_TRUE(contains(sample.out, "amplitude (m/s^2),frequency (Hz)")) << sample.out;
    for (const std::string stage : {"listing", "cpp"})
      EXPECT_EQ(wale({"build", program, "--emit", stage}).status, 0) << stage;
    EXPECT_EQ(wale({"build", corduroy, "--device", device, "--emit", "ir"}).status, 0);
    const Outcome compared = wale({"compare", program, corduroy});
    EXPECT_EQ(compared.status, 1);
    EXPECT_TRUE(contains(compared.err, "only vibrates")) << compared.err;
    const std::string record = folder / (device + ".csv");
    ASSERT_EQ(wale({"feel", program, "--virtual-time", "--seconds", "0.1", "--record", record}).status, 0);
  }
}

TEST(Pads, DescribeComparesAllDevices) {
  const Outcome table = wale({"describe", corduroy, "--device", "all"});
  ASSERT_EQ(table.status, 0) << table.err;
  for (const char* part : {"sandpaper", "falcon", "touch_pad", "gamepad", "roughness", "place of features", "lost"})
    EXPECT_TRUE(contains(table.out, part)) << part << "\n" << table.out;
  const auto json = wale({"describe", corduroy, "--device", "all", "--json"}).json();
  EXPECT_EQ(json.at("corduroy").at("sandpaper").at("percepts").at("roughness").at("fate"), "kept");
  EXPECT_EQ(json.at("corduroy").at("gamepad").at("physics").at("place of features").at("fate"), "lost");
}

TEST(Pads, AreAmongTheDevices) {
  const auto devices = wale({"devices", "--json"}).json();
  int pads = 0;
  for (const auto& device : devices)
    if (device.at("name") == "touch_pad") {
      ++pads;
      EXPECT_EQ(device.at("axes"), 1);
      EXPECT_EQ(device.at("position"), "touch");
    }
  EXPECT_EQ(pads, 1);
  const std::string text = wale({"devices"}).out;
  EXPECT_TRUE(contains(text, "no position: assumed to explore at 0.1 m/s")) << text;
}

}  // namespace
}  // namespace wale::command_line::pads_test
