// A program holds the figures of the device that it was built for. On a plugged device whose declaration has other
// figures, forces and places would be wrong, so the program is refused.

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <map>
#include <string>

#include "calibration/feel/felt_device.hpp"
#include "tests/calibration/declared.hpp"

namespace wale::suited_device_test {
namespace {

using Change = std::function<void(DeviceProfile&)>;

/// A driver whose devices cannot be opened. Its error shows that the program was accepted.
const Driver reached{
    .name = "reached",
    .is_chosen_by_auto = false,
    .is_felt = true,
    .find = [](const Connections&, const PluggedIn*) { return std::vector<PluggedIn>{}; },
    .open = [](const Connections&, const PluggedIn&, const TrustedDevice&, const DeviceOptions&) -> OpenedDevice {
      return Error{Code::lost_device, "the driver was asked"};
    }};

const Error suited{Code::lost_device, "the driver was asked"};

PatchProgram built_for(const std::string& device) {
  return calibrating::Declared(
             "material wall { physical { force = -100 N/m * hand + lateral(grating(x, period: 5 mm), amplitude: 1 N) } "
             "}")
      .program("wall", device)
      .description();
}

/// The error of feeling a program on its device as declared, after `change` to the device's figures in the program.
Error on_plugged(PatchProgram program, const Change& change) {
  DeviceToFeel device;
  device.connections = Connections{.usb = Error{Code::unusable_device, "no USB here"}};
  device.chosen.declared = DeclaredDevice{.profile = program.device};
  device.chosen.trusted = TrustedDevice::by_owner(*device.chosen.declared, "devices.wale");
  device.chosen.plugged = PluggedIn{.driver = &reached, .port = "1-1"};
  change(program.device);
  const std::atomic<bool> stop{false};
  const auto opened = open_to_feel(
      device, program, {}, {}, [](const std::string&) {}, stop);
  return opened ? Error{} : opened.error();
}

TEST(SuitedDevice, ItsOwnProgramReachesIt) {
  for (const char* device : {"openffboard", "touch_pad"}) {
    const Error error = on_plugged(built_for(device), [](DeviceProfile&) {});
    EXPECT_EQ(error.code, suited.code) << device << ": " << error.sentence;
    EXPECT_EQ(error.sentence, suited.sentence) << device;
  }
}

TEST(SuitedDevice, OtherFiguresOfForceAndPlaceAreRefused) {
  const std::map<std::string, Change> changes{
      {"rate", [](DeviceProfile& profile) { profile.rate *= 2; }},
      {"workspace", [](DeviceProfile& profile) { profile.workspace_diameter *= 1.01; }},
      {"position counts", [](DeviceProfile& profile) { profile.position_counts += 1; }},
      {"force", [](DeviceProfile& profile) { profile.force_newton *= 3; }},
      {"force counts", [](DeviceProfile& profile) { profile.force_counts -= 1; }},
  };
  const PatchProgram program = built_for("openffboard");
  for (const auto& [figure, change] : changes) {
    const Error error = on_plugged(program, change);
    EXPECT_EQ(code_name(error.code), "W0608") << figure << ": " << error.sentence;
    const std::string expected =
        "`wall` is built for other figures of `openffboard` than its declaration has: " + figure;
    EXPECT_TRUE(error.sentence.starts_with(expected)) << error.sentence;
    EXPECT_TRUE(error.sentence.find(" in the program, ") != std::string::npos) << error.sentence;
    EXPECT_TRUE(error.sentence.ends_with(" declared")) << error.sentence;
    EXPECT_FALSE(error.mend.empty()) << figure;
  }
}

TEST(SuitedDevice, OtherFiguresOfVibrationAreRefused) {
  const std::map<std::string, Change> changes{
      {"rate", [](DeviceProfile& profile) { profile.rate *= 2; }},
      {"source of the position", [](DeviceProfile& profile) { profile.shaker->position = PositionSource::pointer; }},
      {"lowest frequency", [](DeviceProfile& profile) { profile.shaker->frequency_low += 1; }},
      {"spin up", [](DeviceProfile& profile) { profile.shaker->spin_up += 0.01; }},
      {"acceleration",
       [](DeviceProfile& profile) { profile.shaker->response.front().points.front().acceleration *= 1.1; }},
      {"frequency of a response", [](DeviceProfile& profile) { profile.shaker->response.front().frequency += 0.5; }},
      {"no vibration", [](DeviceProfile& profile) { profile.shaker.reset(); }},
  };
  const PatchProgram program = built_for("touch_pad");
  for (const auto& [figure, change] : changes) {
    const Error error = on_plugged(program, change);
    EXPECT_EQ(code_name(error.code), "W0608") << figure << ": " << error.sentence;
  }
}

// The mass, damping and friction of the handle change neither forces nor places.
TEST(SuitedDevice, FiguresThatScaleNothingMayDiffer) {
  const Error error = on_plugged(built_for("openffboard"), [](DeviceProfile& profile) {
    profile.mass += 0.1;
    profile.damping += 1;
    profile.friction += 1;
    profile.damping_known = !profile.damping_known;
  });
  EXPECT_EQ(error.code, suited.code) << error.sentence;
}

TEST(SuitedDevice, AProgramForAnotherDeviceIsRefused) {
  const Error error = on_plugged(built_for("openffboard"), [](DeviceProfile& profile) { profile.name = "sandpaper"; });
  EXPECT_EQ(code_name(error.code), "W0607") << error.sentence;
  EXPECT_EQ(error.sentence, "`wall` is built for `sandpaper`, not for `openffboard`");
}

// Without a declaration, the simulation takes the figures of the program, so nothing can disagree.
TEST(SuitedDevice, ASimulatedDeviceTakesTheFiguresOfTheProgramUnlessItWasNamed) {
  PatchProgram program = built_for("openffboard");
  const DeclaredDevice declared{.profile = program.device};
  program.device.force_newton *= 3;
  const std::atomic<bool> stop{false};
  const auto simulated = [&](const std::optional<DeclaredDevice>& named) {
    DeviceToFeel device;
    device.chosen.declared = named;
    return open_to_feel(
        device, program, {}, {.hand = "rest"}, [](const std::string&) {}, stop);
  };
  const auto opened = simulated(std::nullopt);
  ASSERT_TRUE(opened) << opened.error().sentence;
  EXPECT_EQ(opened->device->profile().force_newton, program.device.force_newton);
  const auto named = simulated(declared);
  ASSERT_FALSE(named);
  EXPECT_EQ(code_name(named.error().code), "W0608");
  EXPECT_TRUE(named.error().mend.find("`--device simulated`") != std::string::npos) << named.error().mend;
}

}  // namespace
}  // namespace wale::suited_device_test
