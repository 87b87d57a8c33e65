// Responses of motors in declarations: how they are written, which figures are refused, and how they bound and correct
// the force of a plugged device.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "calibration/command/device_declaration.hpp"
#include "calibration/feel/trusted_declarations.hpp"
#include "runtime/device/force_limits.hpp"
#include "runtime/device/hid_pid/force_gate.hpp"
#include "runtime/device/hot_plugged_device.hpp"
#include "runtime/device/shipped_devices.hpp"
#include "schema/device_table.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::responding_test {
namespace {

std::string text_with(const std::string& settings, const std::string& usb = "usb \"1209:ffb0\"; ") {
  return "wale 1\nexport device stick { " + usb +
         "workspace disc(100 mm); position 1024 counts; force 10 N, 1000 counts; rate 500 Hz; speed 1 m/s; "
         "slew 100 N/s; velocity_filter 15, 1 counts; patch 60 mm, 60 mm, 5 mm\n" +
         settings + "\n}\n";
}

Result<DeclaredDevice> declared(const std::string& settings) {
  const auto file = check_device_file({.name = "devices.wale", .bytes = text_with(settings)});
  if (!file) return file.error();
  return file->exported.front().declared;
}

std::string refusal(const std::string& settings) {
  const auto read = declared(settings);
  return read ? "it is read" : read.error().sentence;
}

const char* const all_settings =
    "gain right 0.92, within 0.9 .. 0.94, left 0.88\ngain away 1.1, toward 1.2\n"
    "dead_band right 0.3 N, within 0.2 N .. 0.4 N, left 0.2 N, away 0.1 N\n"
    "nonlinearity right quadratic -0.1, within -0.12 .. -0.08, right cubic 0.05\nnonlinearity left cubic -0.04\n"
    "saturation toward 8.5 N\noffset right 0.1 N, within 0.05 N .. 0.15 N, away -0.2 N\n"
    "mass 0.3 kg, within 0.28 kg .. 0.32 kg\ndelay 2 ms, within 1 ms .. 3 ms, 4 ms";

TEST(Responding, ADeclarationSaysHowEachWayResponds) {
  const auto device = declared(all_settings);
  ASSERT_TRUE(device) << in_words(device.error());
  const DeviceWiring& wiring = device->wiring;
  EXPECT_NEAR(wiring.gain[0] * wiring.response[0].gain, 0.92, 1e-12);
  EXPECT_NEAR(wiring.gain[0] * wiring.response[1].gain, 0.88, 1e-12);
  EXPECT_NEAR(wiring.gain[1] * wiring.response[3].gain, 1.2, 1e-12);
  EXPECT_EQ(wiring.response[0].dead_band, 0.3);
  EXPECT_EQ(wiring.response[3].dead_band, 0);
  EXPECT_EQ(wiring.response[0].quadratic, -0.1);
  EXPECT_EQ(wiring.response[0].cubic, 0.05);
  EXPECT_EQ(wiring.response[1].cubic, -0.04);
  EXPECT_EQ(wiring.response[3].most, 8.5);
  EXPECT_EQ(wiring.offset, (std::array<double, 2>{0.1, -0.2}));
  EXPECT_EQ(device->profile.delay_y, 4e-3);
  const auto interval = [&](const std::string& figure) {
    const auto found = std::ranges::find(device->intervals, figure, &FigureInterval::figure);
    return found == device->intervals.end() ? std::pair(0.0, 0.0) : std::pair(found->low, found->high);
  };
  EXPECT_EQ(interval("gain right"), std::pair(0.9, 0.94));
  EXPECT_EQ(interval("dead_band right"), std::pair(0.2, 0.4));
  EXPECT_EQ(interval("nonlinearity right quadratic"), std::pair(-0.12, -0.08));
  EXPECT_EQ(interval("mass"), std::pair(0.28, 0.32));
  EXPECT_EQ(interval("delay x"), std::pair(1e-3, 3e-3));
  EXPECT_EQ(device->intervals.size(), 6u);
  const auto both = declared("dead_band 0.1 N, 0.2 N\ngain 0.9\nnonlinearity quadratic 0.1");
  ASSERT_TRUE(both) << in_words(both.error());
  EXPECT_EQ(both->wiring.gain, (std::array<double, 2>{0.9, 0.9}));
  EXPECT_EQ(both->wiring.response[1].dead_band, 0.1);
  EXPECT_EQ(both->wiring.response[2].dead_band, 0.2);
  EXPECT_EQ(both->wiring.response[3].quadratic, 0.1);
}

TEST(Responding, FiguresThatNoDeviceHasAreRefused) {
  EXPECT_NE(refusal("gain right 102").find("a gain must be from 0.1 to 10"), std::string::npos);
  EXPECT_NE(refusal("gain right -1").find("a gain must be"), std::string::npos);
  EXPECT_NE(refusal("dead_band 2.6 N").find("a quarter of the device's force"), std::string::npos);
  EXPECT_NE(refusal("dead_band left -0.1 N").find("a dead band must be from 0 N"), std::string::npos);
  EXPECT_NE(refusal("nonlinearity right quadratic 1.1").find("too strong"), std::string::npos);
  EXPECT_NE(refusal("nonlinearity quadratic -0.9, cubic -0.9").find("too strong"), std::string::npos);
  EXPECT_NE(refusal("saturation 0.4 N").find("a saturation must be from 0.5 N"), std::string::npos);
  EXPECT_NE(refusal("saturation 0 N").find("a saturation must be"), std::string::npos);
  EXPECT_NE(refusal("offset right 1.1 N").find("a tenth of the device's force"), std::string::npos);
  EXPECT_NE(refusal("offset left 0.1 N").find("to the right and away"), std::string::npos);
  EXPECT_NE(refusal("gain rigth 0.9").find("`rigth` is none of right"), std::string::npos);
  EXPECT_NE(refusal("gain right 0.9, right 0.8").find("set twice for right"), std::string::npos);
  EXPECT_NE(refusal("gain 0.9\ngain left 0.8").find("set twice for left"), std::string::npos);
  EXPECT_NE(refusal("gain 0.9, 0.8, 0.7").find("more values than axes"), std::string::npos);
  EXPECT_NE(refusal("gain right 0.9, within 1 .. 0.8").find("lower and an upper end"), std::string::npos);
  EXPECT_NE(refusal("nonlinearity right 0.1").find("quadratic or cubic"), std::string::npos);
  EXPECT_NE(refusal("dead_band right 0.1 mm"), "it is read");
  EXPECT_NE(refusal("grade simulated").find("cannot scale a plugged device"), std::string::npos);
  EXPECT_TRUE(check_device_file({.name = "d", .bytes = text_with("grade simulated", "")}));
}

TEST(Responding, WhatIsWrittenIsReadAgain) {
  const auto device = declared(all_settings);
  ASSERT_TRUE(device);
  const std::string text = command::device_declaration(*device, {});
  const auto again = check_device_file({.name = "d", .bytes = text});
  ASSERT_TRUE(again) << in_words(again.error()) << text;
  const DeclaredDevice& same = again->exported.front().declared;
  EXPECT_EQ(same.profile, device->profile) << text;
  EXPECT_EQ(same.intervals.size(), device->intervals.size()) << text;
  for (const std::size_t axis : {0u, 1u})
    for (double command = -10; command <= 10; command += 0.25)
      EXPECT_NEAR(same.wiring.response_of(axis, 10).force(command), device->wiring.response_of(axis, 10).force(command),
                  1e-5)
          << text;
}

TEST(Responding, NeitherShippedDevicesNorTheirTableHoldResponses) {
  for (const DeclaredDevice& device : *shipped_devices()) {
    EXPECT_FALSE(device.wiring.is_corrected()) << device.profile.name;
    EXPECT_TRUE(device.intervals.empty());
  }
  const auto device = declared(all_settings);
  ASSERT_TRUE(device);
  const auto table = read_device_table(write_device_table(std::span(&*device, 1)));
  ASSERT_TRUE(table);
  EXPECT_FALSE(table->front().wiring.is_corrected());
}

/// A device whose motors respond as a declaration says, and that remembers what it was told.
class Plant final : public PluggedDevice {
 public:
  explicit Plant(const DeclaredDevice& truth) : profile_(truth.profile), wiring_(truth.wiring) {}

  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long) noexcept override {}
  Reading sample() noexcept override { return {}; }
  Force command(Force force) noexcept override {
    told = force;
    return force;
  }
  std::string reason() const override { return {}; }
  std::vector<std::pair<std::string, long>> tally() const override { return {}; }
  std::string manner() const override { return {}; }

  /// N at the handle, if motors lie as in the wiring.
  glm::dvec2 at_handle() const {
    return {wiring_.response_of(0, profile_.force_newton).force(told.x),
            wiring_.response_of(1, profile_.force_newton).force(told.y)};
  }

  Force told{0};

 private:
  DeviceProfile profile_;
  DeviceWiring wiring_;
};

TEST(Responding, AForceComesOutAsItWasAskedFor) {
  const auto truth = declared(all_settings);
  ASSERT_TRUE(truth);
  auto plant = std::make_unique<Plant>(*truth);
  const Plant& told = *plant;
  HotPluggedDevice device(std::move(plant), truth->wiring, [] { return OpenedDevice(Error{Code::absent_device, ""}); });
  for (double x = -6; x <= 6; x += 0.37)
    for (double y = -6; y <= 6; y += 0.41) {
      const Force exerted = device.command(Force(x, y));
      const glm::dvec2 felt = told.at_handle();
      EXPECT_NEAR(exerted.x, felt.x, 1e-4) << "it says what it exerts";
      EXPECT_NEAR(exerted.y, felt.y, 1e-4);
      if (std::abs(x) > 0.3) {
        EXPECT_NEAR(felt.x, x, 1e-5) << x;
      }
      if (std::abs(y) > 0.5) {
        EXPECT_NEAR(felt.y, y, 1e-5) << y;
      }
    }
  device.command(Force(0));
  EXPECT_EQ(told.told, Force(0)) << "no force is no command";
  device.command(Force(std::nanf(""), 1e9f));
  EXPECT_EQ(told.told.x, 0);
  EXPECT_LE(told.told.y, 10);
}

/// The last stage bounds the true force: whatever is commanded, and however the motors bend.
TEST(Responding, TheLimitsCountTheMostThatAnyCommandGives) {
  for (const char* settings : {all_settings, "gain 1.3\nnonlinearity quadratic -0.4\nsaturation 12 N",
                               "gain 0.8\nnonlinearity cubic 0.3\ndead_band 1 N",
                               "gain 1.2\nnonlinearity quadratic 0.4, cubic -0.3\noffset 0.5 N, 0.5 N"}) {
    const auto device = declared(settings);
    ASSERT_TRUE(device) << in_words(device.error());
    const TrustedDevice trusted = TrustedDevice::by_owner(*device, "mine.wale");
    const double peak = device->profile.force_newton;
    for (const double most : {1.0, 3.0, 8.0, HUGE_VAL}) {
      const ForceLimits limits = force_limits(trusted, most);
      for (double angle = 0; angle < 6.3; angle += 0.05)
        for (const double size : {0.05, 0.2, 0.5, 1.0, 3.0}) {
          const glm::dvec2 command = peak * hid::within(limits, {size * std::cos(angle), size * std::sin(angle)});
          const glm::dvec2 felt(device->wiring.response_of(0, peak).force(command.x),
                                device->wiring.response_of(1, peak).force(command.y));
          EXPECT_LE(std::hypot(felt.x, felt.y), std::max(most, 0.75) * (1 + 1e-9)) << settings;
          EXPECT_LE(std::max(std::abs(felt.x), std::abs(felt.y)), peak * (1 + 1e-9)) << settings;
        }
    }
    // And a device that is measured without its corrections has no wider limits.
    const ForceLimits bare = force_limits(trusted.uncorrected(), 3), with = force_limits(trusted, 3);
    EXPECT_LE(bare.gain.x, with.gain.x * (1 + 1e-12));
    EXPECT_GE(bare.gain.x * (1 + 1e-9), device->wiring.response_of(0, peak).steepest());
  }
}

}  // namespace
}  // namespace wale::responding_test
