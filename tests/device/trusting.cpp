// What may scale a real device: the shipped declarations, those of the owner's file, those of a named file; and what a
// program must agree with.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "calibration/feel/trusted_declarations.hpp"
#include "runtime/device/driver.hpp"
#include "runtime/device/force_limits.hpp"
#include "schema/built_for.hpp"
#include "schema/owners_devices_file.hpp"
#include "tests/runtime/programs.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::trusting_test {
namespace {

static_assert(!std::is_default_constructible_v<TrustedDevice>);
static_assert(!std::is_convertible_v<DeclaredDevice, TrustedDevice>);
static_assert(!std::is_constructible_v<TrustedDevice, DeclaredDevice, std::string>);
static_assert(!std::is_invocable_v<decltype(Driver::open), const Connections&, const PluggedIn&, const DeviceProfile&,
                                   const DeviceOptions&>);

std::string device_text(const std::string& name, const std::string& force) {
  return "export device " + name + " { usb \"1209:ffb0\"; workspace disc(100 mm); position 1024 counts; force " +
         force +
         ", 512 counts; rate 500 Hz; speed 1 m/s; slew 100 N/s; velocity_filter 15, 1 counts; "
         "patch 60 mm, 60 mm, 5 mm }\n";
}

TEST(Trusting, NamedFilesGoFirstThenTheOwnersThenTheShippedOnes) {
  const TemporaryFolder folder;
  const std::string named = folder.write("named.wale", "wale 1\n" + device_text("named", "5 N"));
  const std::string own = folder.write("wale/devices.wale", "wale 1\n" + device_text("own", "6 N"));
  const auto trusted = trusted_declarations({named}, own);
  ASSERT_TRUE(trusted) << in_words(trusted.error());
  ASSERT_GT(trusted->devices.size(), 2u);
  EXPECT_EQ(trusted->devices[0].profile().name, "named");
  EXPECT_EQ(trusted->devices[0].file(), named);
  EXPECT_EQ(trusted->devices[1].profile().name, "own");
  EXPECT_EQ(trusted->devices[2].file(), "") << "Wale's own";
  EXPECT_EQ(trusted->files.size(), 2u);
  const auto none = trusted_declarations({}, folder / "absent.wale");
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->files.empty());
}

TEST(Trusting, WhatAnOwnersFileImportsIsNotTrusted) {
  const TemporaryFolder folder;
  folder.write("others.wale", "wale 1\n" + device_text("of_others", "5 N"));
  const std::string own = folder.write("own.wale", "wale 1\nimport others\n" + device_text("own", "6 N"));
  const auto trusted = trusted_declarations({own}, "");
  ASSERT_TRUE(trusted) << in_words(trusted.error());
  EXPECT_TRUE(std::ranges::none_of(trusted->devices,
                                   [](const TrustedDevice& each) { return each.profile().name == "of_others"; }));
}

TEST(Trusting, AFileThatIsWrongIsRefusedAtItsLine) {
  const TemporaryFolder folder;
  const std::string wrong = folder.write("wrong.wale", "wale 1\n\n" + device_text("openffboard", "5 N"));
  const auto trusted = trusted_declarations({wrong}, "");
  ASSERT_FALSE(trusted) << "a shipped name";
  EXPECT_EQ(trusted.error().code, Code::declared_twice);
  EXPECT_EQ(trusted.error().place.name, wrong);
  EXPECT_EQ(trusted.error().place.number, 3u);
  const auto of_owner = trusted_declarations({}, wrong);
  ASSERT_TRUE(of_owner && of_owner->owners_problem) << "one's own is left out, and the caller decides";
  EXPECT_EQ(of_owner->owners_problem->place.name, wrong);
  EXPECT_EQ(of_owner->devices.size(), trusted_declarations({}, "")->devices.size());
  const std::string empty = folder.write("empty.wale", "wale 1\n");
  EXPECT_EQ(trusted_declarations({empty}, "").error().code, Code::unknown_device);
  EXPECT_TRUE(trusted_declarations({}, empty)) << "one's own may still be empty";
  EXPECT_EQ(trusted_declarations({folder / "absent.wale"}, "").error().code, Code::unreadable_file);
}

TEST(Trusting, TheOwnersFileIsWhereXdgSays) {
  EXPECT_EQ(owners_devices_file("/etc/me", "/house"), "/etc/me/wale/devices.wale");
  EXPECT_EQ(owners_devices_file(nullptr, "/house"), "/house/.config/wale/devices.wale");
  EXPECT_EQ(owners_devices_file("", "/house"), "/house/.config/wale/devices.wale");
  EXPECT_EQ(owners_devices_file("relative", "/house"), "/house/.config/wale/devices.wale");
  EXPECT_EQ(owners_devices_file(nullptr, nullptr), "");
}

TEST(Trusting, AGainBelongsToItsMotorWhereverItPushes) {
  DeclaredDevice declared;
  declared.profile = sandpaper();
  declared.wiring.motors = {{{1, -1}, {0, 1}}};  // its y motor pushes to the left
  declared.wiring.gain = {0.5, 2};
  const TrustedDevice device = TrustedDevice::by_owner(declared, "mine.wale");
  const ForceLimits limits = force_limits(device, 3);
  EXPECT_EQ(limits.gain, glm::dvec2(2, 0.5));
  EXPECT_EQ(limits.full(), glm::dvec2(2, 0.5) * declared.profile.force_newton);
  EXPECT_EQ(limits.most_newton, 3);
  EXPECT_EQ(device.as_built().wiring().gain, (std::array<double, 2>{2, 0.5}));
  EXPECT_EQ(device.as_built().wiring().motors, DeviceWiring{}.motors);
}

TEST(Trusting, AProgramHasTheFiguresOfTheDeclarationOrIsRefusedWithBoth) {
  const PatchProgram program = spring(100).description();
  const DeviceProfile declared = program.device;
  EXPECT_TRUE(is_built_for(program, declared));
  const auto refused = [&](auto change, const char* said) {
    DeviceProfile other = declared;
    change(other);
    const auto built = is_built_for(program, other);
    ASSERT_FALSE(built) << said;
    EXPECT_EQ(built.error().code, Code::other_figures);
    EXPECT_NE(built.error().sentence.find(said), std::string::npos) << built.error().sentence;
    EXPECT_NE(built.error().sentence.find(" declared"), std::string::npos);
  };
  refused([](DeviceProfile& device) { device.force_newton = 0.001; }, "force 10 N in the program, 0.001 N declared");
  refused([](DeviceProfile& device) { device.force_counts += 1; }, "force counts ");
  refused([](DeviceProfile& device) { device.rate = 1000; }, "rate ");
  refused([](DeviceProfile& device) { device.workspace_diameter *= 2; }, "workspace ");
  refused([](DeviceProfile& device) { device.position_counts *= 2; }, "position counts ");
  refused([](DeviceProfile& device) { device.speed_limit *= 2; }, "speed ");
  refused([](DeviceProfile& device) { device.velocity_window += 1; }, "window of the velocity filter ");
  refused([](DeviceProfile& device) { device.velocity_noise_counts += 1; }, "noise of the velocity filter ");
  refused([](DeviceProfile& device) { device.force_newton = std::nan(""); }, "force ");
  DeviceProfile other = declared;
  other.slew = 1;
  other.continuous_newton = 1;
  other.mass = 7;
  EXPECT_TRUE(is_built_for(program, other)) << "no program depends on these";
  other.name = "another";
  EXPECT_EQ(is_built_for(program, other).error().code, Code::other_device);
}

}  // namespace
}  // namespace wale::trusting_test
