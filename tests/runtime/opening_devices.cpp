// Listing and opening devices by the public header alone. Real ones are in tests/usb_mock.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "wale/devices.hpp"

namespace wale::opening_devices_test {
namespace {

Code code_of(const Result<std::unique_ptr<Device>>& opened) {
  EXPECT_FALSE(opened);
  return opened ? Code{} : opened.error().code;
}

constexpr HandModel hand{.mass = 0.1, .damping = 3, .stiffness = 300};

TEST(OpeningDevices, EachListedSimulationOpens) {
  const std::vector<DeviceInfo> all = devices();
  std::set<std::string> spellings;
  long simulated = 0, pointers = 0;
  for (const DeviceInfo& each : all) {
    EXPECT_TRUE(spellings.insert(each.spelling).second) << each.spelling << " means two devices";
    pointers += each.kind == DeviceKind::pointer;
    if (each.kind != DeviceKind::simulated) continue;
    ++simulated;
    const auto opened = open_device(each.spelling, {.hand = hand});
    ASSERT_TRUE(opened) << each.spelling << ": " << in_words(opened.error());
    EXPECT_EQ((*opened)->profile().name, each.name);
    ASSERT_TRUE(each.profile);
    EXPECT_EQ((*opened)->profile().force_newton, each.profile->force_newton);
  }
  EXPECT_GE(simulated, 5);
  EXPECT_EQ(pointers, 1);
  EXPECT_TRUE(spellings.contains("simulated:sandpaper"));
}

TEST(OpeningDevices, TheSimulatedOneIsThatOfTheProgram) {
  const auto usual = open_device("simulated", {.hand = hand});
  ASSERT_TRUE(usual);
  EXPECT_EQ((*usual)->profile().name, default_device);
  const auto falcon = open_device("simulated", {.built_for = "falcon", .hand = hand});
  ASSERT_TRUE(falcon);
  EXPECT_EQ((*falcon)->profile().name, "falcon");
}

TEST(OpeningDevices, TheSimulatedHandMovesAsItShould) {
  // A stiff hand on a slow circle of 10 mm is always nearly 10 mm from the middle.
  const auto opened = open_device("simulated", {.hand = {.mass = 0.1, .damping = 40, .stiffness = 4000},
                                                .motion = Circular{.radius = 0.01, .frequency = 0.2}});
  ASSERT_TRUE(opened);
  Device& device = **opened;
  for (int i = 0; i < 1000; ++i) {
    device.elapse(1);
    const Reading reading = device.sample();
    EXPECT_EQ(reading.contact, Contact::good);
    EXPECT_NEAR(std::hypot(reading.counts.x, reading.counts.y) * device.profile().position_step(), 0.01, 0.001);
    device.command({0, 0});
  }
}

TEST(OpeningDevices, AMotionNeedsAHand) {
  for (const Motion& motion : std::initializer_list<Motion>{Lateral{0.02, 1}, Rest{}}) {
    const auto opened = open_device("simulated", {.motion = motion});
    ASSERT_FALSE(opened);
    EXPECT_EQ(opened.error().place.name, "hand");
    EXPECT_FALSE(opened.error().mend.empty());
  }
  EXPECT_TRUE(open_device("simulated"));
  EXPECT_TRUE(open_device("simulated", {.hand = {.stiffness = 100}, .motion = Lateral{0.02, 1}}));
}

TEST(OpeningDevices, TheForceOfTheUserLimitsASimulatedOneToo) {
  constexpr double most = 0.5;
  const auto opened = open_device("simulated", {.max_force = most, .hand = hand});
  ASSERT_TRUE(opened);
  float largest = 0;
  for (int i = 0; i < 360; ++i) {
    const double turn = i * 0.0174533;
    const Force exerted = (*opened)->command({9 * std::cos(turn), 9 * std::sin(turn)});
    largest = std::max(largest, std::hypot(exerted.x, exerted.y));
    EXPECT_LE(std::hypot(exerted.x, exerted.y), most) << i;
  }
  EXPECT_GT(largest, most - 0.02);
  EXPECT_EQ((*opened)->command({0.25f, 0}), (*open_device("simulated", {.hand = hand}))->command({0.25f, 0}));
  const auto least = open_device("simulated", {.max_force = 1e-9, .hand = hand});
  EXPECT_EQ((*least)->command({9, 9}), Force(0));
}

TEST(OpeningDevices, RefusesNumbersThatAreNoneInAnyPlace) {
  for (const double none : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    for (double HandModel::*part : {&HandModel::mass, &HandModel::damping, &HandModel::stiffness}) {
      HandModel wrong = hand;
      wrong.*part = none;
      EXPECT_EQ(code_of(open_device("simulated", {.hand = wrong})), Code::malformed_value);
    }
    for (const Motion& motion : std::initializer_list<Motion>{
             Rest{{none, 0}}, Rest{{0, none}}, Lateral{none, 1}, Lateral{0.02, none}, Lateral{0.02, 1, {none, 0}},
             Lateral{0.02, 1, {}, {none, 0}}, Circular{none, 1}, Circular{0.02, none}, Circular{0.02, 1, {0, none}},
             Press{none, 1}, Press{0.02, none}, Press{0.02, 1, {none, 0}}, Press{0.02, 1, {}, {0, none}},
             Trace{{{none, {0, 0}}}}, Trace{{{0, {none, 0}}}}, Trace{{{0, {0, 0}, {0, none}}}}})
      for (const char* device : {"simulated", "simulated:falcon"})
        EXPECT_EQ(code_of(open_device(device, {.hand = hand, .motion = motion})), Code::malformed_value);
  }
  for (const Motion& motion : std::initializer_list<Motion>{Trace{}, Trace{{{1, {0, 0}}, {1, {0, 0}}}},
                                                            Lateral{0.02, 1, {}, {0, 0}}, Press{0.02, 1, {}, {2, 0}}})
    EXPECT_EQ(code_of(open_device("simulated", {.hand = hand, .motion = motion})), Code::malformed_value);
  EXPECT_TRUE(open_device("simulated", {.hand = hand, .motion = Trace{{{0, {0, 0}}}}}));
}

TEST(OpeningDevices, RefusesWhatMakesNoSense) {
  for (const char* no_name : {"", " ", "a\nb"}) EXPECT_EQ(code_of(open_device(no_name)), Code::malformed_value);
  EXPECT_EQ(code_of(open_device("\xff")), Code::invalid_encoding);
  EXPECT_EQ(code_of(open_device(std::string_view("falcon\0", 7))), Code::invalid_encoding);
  EXPECT_EQ(code_of(open_device("falcom")), Code::unknown_device);
  EXPECT_EQ(code_of(open_device("simulated:")), Code::unknown_device);
  EXPECT_EQ(code_of(open_device("simulated:falcom")), Code::unknown_device);
  EXPECT_EQ(code_of(open_device("simulated", {.built_for = "falcom", .hand = hand})), Code::unknown_device);
  EXPECT_EQ(code_of(open_device("simulated:falcon", {.built_for = "sandpaper", .hand = hand})), Code::other_device);
  EXPECT_EQ(code_of(open_device("99-9.9")), Code::absent_device);
  EXPECT_EQ(code_of(open_device("0001:0001")), Code::absent_device);
  for (const double force : {0.0, -1.0, std::nan("")})
    EXPECT_EQ(code_of(open_device("simulated", {.max_force = force, .hand = hand})), Code::malformed_value);
  for (const int priority : {0, -1, 100})
    EXPECT_EQ(code_of(open_device("simulated", {.priority = priority, .hand = hand})), Code::malformed_value);
  EXPECT_EQ(code_of(open_device("simulated", {.hand = {.mass = -10}})), Code::malformed_value);
  EXPECT_EQ(open_device("falcom").error().place.name, "spelling");
  EXPECT_NE(open_device("").error().mend.find("simulated"), std::string::npos) << "and no name of a material";
}

}  // namespace
}  // namespace wale::opening_devices_test
