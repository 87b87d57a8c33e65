// Declared devices as bytes: a table that is written is read back unchanged, and damaged bytes are refused.
#include "schema/device_table.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace wale::device_table_test {
namespace {

DeclaredDevice joystick() {
  DeclaredDevice device;
  device.profile = {.name = "stick",
                    .workspace_diameter = 0.1,
                    .position_counts = 4096,
                    .force_newton = 9.5,
                    .force_counts = 255,
                    .rate = 900,
                    .speed_limit = 1,
                    .slew = 200,
                    .continuous_newton = 3,
                    .heating_seconds = 20,
                    .active_watt = 2,
                    .velocity_window = 15,
                    .velocity_noise_counts = 1,
                    .patch_width = 0.08,
                    .patch_height = 0.07,
                    .patch_rim = 0.005,
                    .mass = 0.3,
                    .damping = 0.4,
                    .friction = 0.5,
                    .delay_x = 0.001,
                    .delay_y = 0.002,
                    .bandwidth_x = 120,
                    .bandwidth_y = 110,
                    .damping_known = true,
                    .friction_known = false};
  device.wiring = {.usb = {{0x1209, 0xffb0}, {0xffff, 0x2055}},
                   .is_generic = true,
                   .axes = {{{1, -1}, {0, 1}}},
                   .motors = {{{0, -1}, {1, -1}}},
                   .gain = {0.5, 2}};
  device.of_class = "joystick";
  device.source = "measured at 900 Hz, \"by hand\"";
  device.assumed = {"mass", "friction"};
  device.unknown = {"gain"};
  return device;
}

DeclaredDevice pad() {
  DeclaredDevice device;
  device.profile.name = "pad";
  device.profile.rate = 200;
  device.profile.slew = 100;
  device.profile.patch_width = device.profile.patch_height = 0.1;
  device.profile.shaker = Shaker{.position = PositionSource::none,
                                 .frequency_low = 40,
                                 .frequency_high = 250,
                                 .command_steps = 255,
                                 .spin_up = 0.03,
                                 .exploring_speed = 0.1,
                                 .response = {{60, {{0.5, 2}, {1, 5}}}, {175, {{1, 12}}}}};
  return device;
}

const std::vector<DeclaredDevice> both{joystick(), pad()};

/// The sentence with which a table of one device is refused; empty when the table is read.
std::string refused(const DeclaredDevice& device) {
  const auto read = read_device_table(write_device_table(std::vector{device}));
  if (read) return "";
  EXPECT_EQ(read.error().code, Code::damaged_file);
  EXPECT_EQ(read.error().place.name, "table of devices");
  EXPECT_NE(read.error().mend, "");
  return read.error().sentence;
}

TEST(DeviceTable, IsReadAsItWasWritten) {
  const auto read = read_device_table(write_device_table(both));
  ASSERT_TRUE(read) << read.error().sentence;
  EXPECT_EQ(*read, both);
  const auto none = read_device_table(write_device_table({}));
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->empty());
}

TEST(DeviceTable, BeginsAsDocumented) {
  const auto bytes = write_device_table(both);
  const std::vector<std::uint8_t> expected{0x89, 'W', 'D', 'T', 0x0d, 0x0a, 0x1a, 0x0a, 1,  0,
                                           2,    0,   0,   0,   5,    0,    0,    0,    's'};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(std::to_integer<int>(bytes[i]), expected[i]) << i;
}

TEST(DeviceTable, RefusesTruncatedTablesAndTrailingBytes) {
  auto bytes = write_device_table(both);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(read_device_table(std::span(bytes).first(size))) << size;
  bytes.push_back(std::byte{0});
  EXPECT_FALSE(read_device_table(bytes));
}

TEST(DeviceTable, AnyChangedByteIsRefusedOrReadAsOtherDevices) {
  const auto bytes = write_device_table(both);
  for (std::size_t at = 0; at < bytes.size(); ++at)
    for (const int change : {0x01, 0x80, 0xff}) {
      auto changed = bytes;
      changed[at] ^= std::byte(change);
      const auto read = read_device_table(changed);
      if (read) {
        EXPECT_EQ(write_device_table(*read), changed) << "at byte " << at;
      }
    }
}

TEST(DeviceTable, CountsThatOutgrowTheBytesAllocateNothing) {
  auto bytes = write_device_table({});
  for (std::size_t i = 10; i < 14; ++i) bytes[i] = std::byte{0xff};  // the number of devices
  const auto read = read_device_table(bytes);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().sentence.find("4294967295 devices"), std::string::npos) << read.error().sentence;
}

TEST(DeviceTable, RefusesFiguresThatNoDeviceHas) {
  EXPECT_EQ(refused(joystick()), "");
  const auto with = [](auto change) {
    DeclaredDevice device = joystick();
    change(device);
    return refused(device);
  };
  EXPECT_NE(with([](DeclaredDevice& device) { device.profile.rate = 0; }), "");
  EXPECT_NE(with([](DeclaredDevice& device) { device.profile.rate = 1e9; }), "");
  EXPECT_NE(with([](DeclaredDevice& device) { device.profile.workspace_diameter = 0; }), "");
  EXPECT_NE(with([](DeclaredDevice& device) { device.profile.position_counts = -1; }), "");
  EXPECT_NE(with([](DeclaredDevice& device) { device.profile.force_counts = 0; }), "");
  EXPECT_NE(with([](DeclaredDevice& device) { device.profile.mass = std::numeric_limits<double>::quiet_NaN(); }), "");
  EXPECT_NE(with([](DeclaredDevice& device) { device.profile.name = ""; }), "");
  EXPECT_NE(with([](DeclaredDevice& device) { device.wiring.gain = {0, 1}; }), "");
  EXPECT_NE(with([](DeclaredDevice& device) { device.wiring.axes = {{{0, 1}, {0, -1}}}; }), "");
  EXPECT_NE(with([](DeclaredDevice& device) { device.profile.shaker = Shaker{}; }), "");
}

}  // namespace
}  // namespace wale::device_table_test
