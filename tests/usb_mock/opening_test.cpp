// Listing and opening a mock device by the public headers alone, as a program does.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>

#include "tests/temporary_folder.hpp"
#include "tests/usb_mock/running_wale.hpp"
#include "tests/usb_mock/usb_driver.hpp"
#include "tests/usb_mock/usb_mock.hpp"
#include "wale/wale.hpp"

namespace wale::test::opening {
namespace {

/// The folder of this account's settings, until the end of the test.
class Settings {
 public:
  explicit Settings(const std::string& folder) {
    if (const char* before = std::getenv("XDG_CONFIG_HOME")) before_ = before;
    setenv("XDG_CONFIG_HOME", folder.c_str(), 1);
  }
  ~Settings() { before_ ? setenv("XDG_CONFIG_HOME", before_->c_str(), 1) : unsetenv("XDG_CONFIG_HOME"); }
  Settings(const Settings&) = delete;
  Settings& operator=(const Settings&) = delete;

 private:
  std::optional<std::string> before_;
};

/// The shipped declaration of OpenFFBoard as an owner's, with half its force.
std::string owners_text() {
  std::string text = text_of(std::string(WALE_SOURCE_DIR) + "/calibration/devices/usb_joysticks.wale");
  const std::size_t begin = text.find("device openffboard"), end = text.find("\n}\n", begin);
  text = "wale 1\nexport device my_" + text.substr(begin + std::string("device ").size(), end + 3 - begin);
  text.resize(text.find("\n}\n") + 3);
  const std::string force = "20 N";
  return text.replace(text.find(force), force.size(), "10 N");
}

DeviceInfo info_at(const std::string& port, const TrustedDevices& trusted = {}) {
  std::optional<DeviceInfo> found;
  await([&] {
    for (const DeviceInfo& each : devices(trusted))
      if (each.spelling == port) found = each;
    return found.has_value();
  });
  return *found;
}

TEST(Opening, AProgramFindsOpensAndFeelsAStickAndLeavesItAsItShould) {
  const TemporaryFolder nothing;
  const Settings settings(nothing.path().string());
  UsbMock mock;
  const auto stick = mock.plug(PidModel(openffboard()), 1);
  const DeviceInfo info = info_at("1-1");
  EXPECT_EQ(info.kind, DeviceKind::real);
  EXPECT_EQ(info.numbers, "1209:ffb0");
  ASSERT_TRUE(info.profile);
  EXPECT_EQ(info.profile->name, "openffboard");
  EXPECT_FALSE(info.obstacle);

  auto refused = open_device("auto", {.keeper = "/nonexistent/wale-keeper"});
  ASSERT_FALSE(refused) << "nothing pushes without a keeper";
  EXPECT_EQ(refused.error().code, Code::no_keeper);
  const auto simulated = open_device("auto", {.built_for = "falcon", .hand = {.mass = 0.1}});
  ASSERT_TRUE(simulated) << "`auto` simulates what is not plugged in";
  EXPECT_EQ((*simulated)->profile().name, "falcon");
  const auto other = open_device("usb", {.built_for = "falcon", .keeper = WALE_KEEPER});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, Code::other_device);

  constexpr double allowed = 0.5, full = 20;  // N; the model counts in shares of the declared force
  const Library library;
  auto device = library.open_device(info.spelling, {.max_force = allowed, .keeper = WALE_KEEPER});
  ASSERT_TRUE(device) << in_words(device.error());
  EXPECT_EQ((*device)->profile().name, "openffboard");
  const auto strong = library.compile("wale 1\nmaterial strong { physical { force = vector(8 N, 6 N) } }\n",
                                      {.device = (*device)->profile().name});
  ASSERT_TRUE(strong) << in_words(strong.error());
  {
    Stage stage(*std::move(device));
    ASSERT_TRUE(stage.add(strong->program));
    ASSERT_TRUE(stage.start());
    await([&] { return stick->with_model([](PidModel& model) { return model.most_force; }) * full > 0.9 * allowed; });
    ASSERT_TRUE(stage.stop());
  }
  stick->with_model([](PidModel& model) {
    EXPECT_EQ(model.force(), glm::dvec2(0));
    EXPECT_LE(model.most_force * full, allowed * (1 + 1e-9));
    EXPECT_EQ(model.log.back(), "OUT 0C 02") << "the actuators are off";
    return 0;
  });
}

TEST(Opening, WhatTheOwnerDeclaresIsNeverPassedBy) {
  const TemporaryFolder folder;
  folder.write("wale/devices.wale", owners_text());
  const Settings settings(folder.path().string());
  UsbMock mock;
  const auto stick = mock.plug(PidModel(openffboard()), 1);
  info_at("1-1");

  const auto alone = open_device("auto", {.keeper = WALE_KEEPER});
  ASSERT_FALSE(alone) << "the runtime alone cannot read how the motors of this stick lie";
  EXPECT_EQ(alone.error().code, Code::untrusted_device);

  const Library library;
  const auto trusted = library.trusted_devices();
  ASSERT_TRUE(trusted) << in_words(trusted.error());
  EXPECT_EQ(info_at("1-1", *trusted).profile->name, "my_openffboard");
  {
    const auto device = library.open_device("auto", {.keeper = WALE_KEEPER});
    ASSERT_TRUE(device) << in_words(device.error());
    EXPECT_EQ((*device)->profile().name, "my_openffboard");
    EXPECT_EQ((*device)->profile().force_newton, 10);
    EXPECT_TRUE(library.find("denim", {.device = "my_openffboard"}));
    EXPECT_TRUE(library.level("roughness", "coarse", {.device = "my_openffboard"}));
  }
  {
    const auto device = open_device("auto", {.trusted = TrustedDevices{}, .keeper = WALE_KEEPER});
    ASSERT_TRUE(device) << in_words(device.error());
    EXPECT_EQ((*device)->profile().name, "openffboard") << "it was disregarded on purpose";
  }

  folder.write("wale/devices.wale", "wale 1\nexport device mine {");
  const Library of_a_broken_file;
  EXPECT_FALSE(of_a_broken_file.trusted_devices());
  EXPECT_FALSE(of_a_broken_file.open_device("auto", {.keeper = WALE_KEEPER}));
  EXPECT_TRUE(of_a_broken_file.find("denim")) << "shipped devices do not depend on it";
}

}  // namespace
}  // namespace wale::test::opening
