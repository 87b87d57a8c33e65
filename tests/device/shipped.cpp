// The runtime's built-in table of devices holds the devices that the compiler reads from calibration/devices.
#include <gtest/gtest.h>

#include <string>

#include "compiler/declarations/declared_devices.hpp"
#include "compiler/modules/load_modules.hpp"
#include "runtime/device/shipped_devices.hpp"
#include "schema/device_table.hpp"

namespace wale::shipped_test {
namespace {

TEST(ShippedDevices, AreThoseThatTheCompilerReads) {
  const auto declared = declared_devices(common_modules()->declarations);
  const auto& shipped = shipped_devices();
  ASSERT_TRUE(shipped) << shipped.error().sentence;
  ASSERT_GT(declared.size(), 5u);
  ASSERT_EQ(shipped->size(), declared.size());
  for (std::size_t i = 0; i < declared.size(); ++i) {
    const DeclaredDevice &ours = (*shipped)[i], &theirs = declared[i];
    const std::string& name = theirs.profile.name;
    EXPECT_EQ(ours.profile.name, name);
    EXPECT_EQ(ours.profile, theirs.profile) << name;
    EXPECT_EQ(ours.wiring, theirs.wiring) << name;
    EXPECT_EQ(ours.of_class, theirs.of_class) << name;
    EXPECT_EQ(ours.source, theirs.source) << name;
    EXPECT_EQ(ours.assumed, theirs.assumed) << name;
    EXPECT_EQ(ours.unknown, theirs.unknown) << name;
    EXPECT_EQ(ours, theirs) << name << ": a field that this test does not name";
  }
}

TEST(ShippedDevices, AreOneTable) {
  const auto bytes = write_device_table(*shipped_devices());
  const auto embedded = shipped_device_table();
  EXPECT_EQ(bytes, std::vector<std::byte>(embedded.begin(), embedded.end()));
}

TEST(ShippedDevices, IncludeAJoystickAPadAndUsbDevices) {
  bool has_joystick = false, has_pad = false, has_usb = false;
  for (const DeclaredDevice& device : *shipped_devices()) {
    has_joystick = has_joystick || device.profile.name == "sandpaper";
    has_pad = has_pad || device.profile.shaker;
    has_usb = has_usb || !device.wiring.usb.empty();
  }
  EXPECT_TRUE(has_joystick && has_pad && has_usb);
}

}  // namespace
}  // namespace wale::shipped_test
