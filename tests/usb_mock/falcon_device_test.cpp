#include "runtime/device/falcon/falcon_device.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <atomic>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <string>

#include "runtime/device/driver.hpp"
#include "schema/without_place.hpp"
#include "tests/runtime/programs.hpp"
#include "tests/temporary_folder.hpp"
#include "tests/usb/allocations.hpp"
#include "tests/usb/falcon_model.hpp"
#include "tests/usb/profiles.hpp"
#include "tests/usb_mock/usb_driver.hpp"
#include "wale/stage.hpp"

// Runs unmodified libusb and the whole Falcon driver with a mock Falcon. The tests assert counts, order and bytes.

namespace wale::test::falcon_device {
namespace {

constexpr std::size_t firmware_bytes = 5000;

/// Arbitrary bytes of the same length as firmware.
std::string bytes_of_firmware() {
  std::string bytes;
  for (std::size_t i = 0; i < firmware_bytes; ++i) bytes.push_back(static_cast<char>(i * 31 >> 3));
  return bytes;
}

/// Overrides an environment variable for its lifetime.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    if (const char* before = getenv(name)) before_ = before;
    if (value != nullptr)
      setenv(name, value, 1);
    else
      unsetenv(name);
  }
  ~Environment() {
    if (before_)
      setenv(name_, before_->c_str(), 1);
    else
      unsetenv(name_);
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

class FalconDriver : public MockedUsb {
 protected:
  Result<std::unique_ptr<FalconDevice>> open(int port, FalconOptions options) {
    if (options.firmware == falcon_firmware_path()) options.firmware = firmware_;
    return FalconDevice::open(context(), found(port), trusted(falcon_profile()), options);
  }

  std::unique_ptr<FalconDevice> opened(int port, const FalconOptions& options = falcon_in_mock_time()) {
    auto result = open(port, options);
    if (!result) {
      ADD_FAILURE() << in_words(result.error());
      return nullptr;
    }
    return *std::move(result);
  }

  std::string refusal(int port, const FalconOptions& options = falcon_in_mock_time()) {
    auto result = open(port, options);
    return result ? "opened" : in_words_without_place(result.error());
  }

  TemporaryFolder folder_;
  std::string firmware_ = folder_.write("firmware.bin", bytes_of_firmware());
};

template <class Mock>
glm::ivec3 torques(Mock& mock) {
  return mock->with_model([](FalconModel& model) { return model.torques; });
}

TEST_F(FalconDriver, RunsFromStartToEnd) {
  const auto mock = mock_.plug(FalconModel(), 1);
  EXPECT_TRUE(is_falcon(found(1)));
  auto device = opened(1);
  ASSERT_NE(device, nullptr);
  EXPECT_EQ(device->counts().firmware_chunks, static_cast<long>((firmware_bytes + 61) / 62));
  mock->with_model([](FalconModel& model) {
    EXPECT_EQ(model.firmware.size(), firmware_bytes);
    EXPECT_EQ(model.firmware[1000], static_cast<std::uint8_t>(1000 * 31 >> 3));
    EXPECT_TRUE(model.is_homed);
    model.hand = {0.01, -0.02, 0.125};  // the hand is beside the plane, the driver holds the handle in the plane
    model.logs = false;
  });

  constexpr long ticks = 4000;
  long good = 0;
  run_ticks(mock_, ticks, [&](long tick) {
    const long before = allocations;
    device->elapse(1);
    good += device->sample().contact == Contact::good;
    const Force exerted = device->command({0.5f + static_cast<float>(tick) / ticks, -1});
    ASSERT_EQ(allocations, before);
    ASSERT_LT(glm::length(exerted), 2);
  });
  EXPECT_GT(good, ticks / 2);
  const auto counts = device->counts();
  EXPECT_GT(counts.answers, 300);
  EXPECT_LE(std::abs(counts.answers - counts.commands_sent), 6)
      << "commands and answers take turns; five commands are from probing";
  EXPECT_EQ(counts.skipped_bytes, 0);

  // The device reports the place of the handle in the plane. The force on the hand has the commanded direction.
  run_until(mock_, [&] {
    device->command({1.5f, -1});
    const Reading reading = device->sample();
    const glm::dvec3 place = mock->with_model([](FalconModel& model) { return model.place; });
    const glm::dvec3 force = mock->with_model([](FalconModel& model) { return model.force(); });
    const double step = falcon_profile().position_step();
    return std::abs(reading.counts.x * step - place.x) < 2e-4 && std::abs(reading.counts.y * step - place.y) < 2e-4 &&
           std::abs(force.x - 1.5) < 0.02 && std::abs(force.y + 1) < 0.02 && std::abs(place.z - 0.12) < 0.002;
  });

  device.reset();
  mock->with_model([](FalconModel& model) {
    EXPECT_EQ(model.torques, glm::ivec3(0));
    EXPECT_EQ(model.wrong_packets, 0);
    EXPECT_EQ(model.torques_before_home, 0);
    EXPECT_EQ(model.lights, 0);
  });
  EXPECT_EQ(mock->claims, 1);
  EXPECT_EQ(mock->releases, 1);
  EXPECT_EQ(mock->drivers_back, 1) << "the kernel's driver is attached again";
  EXPECT_EQ(mock->unknown_ioctls, 0);
}

TEST_F(FalconDriver, WaitsUntilAPersonHomesIt) {
  FalconModel model({}, true);
  model.homes_after = -1;
  const auto mock = mock_.plug(std::move(model), 1);
  FalconOptions options = falcon_in_mock_time();
  std::string asked;
  options.ask = [&](const std::string& what) {
    asked = what;
    EXPECT_EQ(torques(mock), glm::ivec3(0));
    mock->with_model([](FalconModel& each) { each.homes_after = 0; });
  };
  EXPECT_NE(opened(1, options), nullptr);
  EXPECT_EQ(asked, "push the Falcon's handle all the way in, then pull it all the way out");
  mock->with_model([](FalconModel& each) {
    each.homes_after = -1;
    each.is_homed = false;
  });
  const std::string not_homed =
      "0403:cb48: its encoders have not found their zeros; push the handle all the way in and pull it all the way out";
  std::atomic<bool> stop{false};
  options.stop = &stop;
  options.homing_patience = 1e9;
  options.ask = [&](const std::string&) { stop = true; };
  EXPECT_EQ(refusal(1, options), not_homed) << "the caller has given up";
  options.stop = nullptr;
  options.ask = {};
  options.homing_patience = 0.05;
  EXPECT_EQ(refusal(1, options), not_homed);
}

TEST_F(FalconDriver, TheErrorOfMissingFirmwareNamesItsSource) {
  mock_.plug(FalconModel(), 1);
  FalconOptions options = falcon_in_mock_time();
  options.firmware = "/nowhere/falcon.bin";
  const std::string reason = refusal(1, options);
  for (const char* part : {"0403:cb48: it runs no firmware", "/nowhere/falcon.bin", "libnifalcon",
                           "WALE_FALCON_FIRMWARE=FILE", "not part of Wale"}) {
    EXPECT_NE(reason.find(part), std::string::npos) << reason;
  }
  const auto running = mock_.plug(FalconModel({}, true), 2);
  EXPECT_NE(opened(2, options), nullptr) << "a Falcon with firmware needs no file";
}

TEST(FalconFirmware, TheEnvironmentNamesItsFile) {
  const TemporaryFolder home, data;
  const Environment at_home("HOME", home.path().c_str()), nowhere("XDG_DATA_HOME", nullptr),
      none("WALE_FALCON_FIRMWARE", nullptr);
  EXPECT_EQ(falcon_firmware_path(), home / ".local/share/wale/falcon_firmware.bin");
  const Environment elsewhere("XDG_DATA_HOME", data.path().c_str());
  EXPECT_EQ(falcon_firmware_path(), data / "wale/falcon_firmware.bin");
  const Environment mine("WALE_FALCON_FIRMWARE", "/mine.bin");
  EXPECT_EQ(falcon_firmware_path(), "/mine.bin");
}

TEST_F(FalconDriver, IsUnpluggedWhileRunningAndPluggedInAgain) {
  std::atomic<int> arrived{0}, left{0};
  ASSERT_TRUE(context()->watch([&](const UsbEvent& event) { ++(event.arrived ? arrived : left); }));
  const auto mock = mock_.plug(FalconModel({}, true), 1);
  await([&] { return arrived == 1; });
  const auto device = opened(1);
  ASSERT_NE(device, nullptr);
  run_ticks(mock_, 300, [&](long) {
    device->sample();
    device->command({2, 1});
  });
  mock_.unplug(mock);
  await([&] { return device->was_lost(); });
  EXPECT_EQ(device->reason(), "it was unplugged");
  EXPECT_EQ(device->sample().contact, Contact::lost);
  EXPECT_EQ(device->command({2, 1}), Force(0));
  await([&] { return left == 1; });

  const auto again = mock_.plug(FalconModel(), 1);  // without power it lost its firmware
  await([&] { return arrived == 2; });
  const auto second = opened(1);
  ASSERT_NE(second, nullptr);
  run_until(mock_, [&] {
    second->sample();
    second->command({2, 0});
    return std::abs(again->with_model([](FalconModel& model) { return model.force(); }).x - 2) < 0.02;
  });
}

TEST_F(FalconDriver, GivesTheForcesOfAStage) {
  const auto mock = mock_.plug(FalconModel({}, true), 1);
  DeviceProfile profile = sandpaper();
  auto result = FalconDevice::open(context(), found(1), trusted(profile), falcon_in_mock_time());
  ASSERT_TRUE(result) << in_words(result.error());
  const auto device = *std::move(result);
  mock->with_model([](FalconModel& model) { model.hand = {0.02, 0, 0.12}; });
  const auto ran = [&] {
    InStepDevice in_step(mock_, *device);
    Stage stage(in_step);
    Patch patch = *stage.add(built_for(spring(50), in_step.profile()));
    return stage.run({.seconds = 0.6});
  }();
  ASSERT_TRUE(ran);
  const auto& ticks = ran->record.ticks;
  double hardest = 0;
  for (const auto& tick : ticks) hardest = std::min<double>(hardest, tick.force.x);
  EXPECT_LT(hardest, -0.3) << "50 N/m against a hand of 100 N/m at 20 mm";
  await([&] { return torques(mock) == glm::ivec3(0); });
}

TEST_F(FalconDriver, FaultsEndInNoForce) {
  struct Case {
    FalconFaults faults;
    const char* reason;
  };
  const Case cases[] = {{{.mute_after = 200}, "it does not answer in time"},
                        {{.nonsense_after = 200}, "what it answers is nonsense"},
                        {{.unhomed_after = 200}, "its encoders have lost their zeros"},
                        {{.stall_after = 200}, "it takes no packets"}};
  int port = 0;
  for (const Case& fault : cases) {
    const auto mock = mock_.plug(FalconModel(fault.faults, true), ++port);
    auto device = opened(port);
    ASSERT_NE(device, nullptr) << fault.reason;
    await([&] {
      device->sample();
      device->command({2, 1});
      return device->was_lost();
    });
    EXPECT_EQ(device->reason(), fault.reason);
    device.reset();
    if (fault.faults.stall_after < 0) {
      EXPECT_EQ(torques(mock), glm::ivec3(0)) << fault.reason;
    }
    EXPECT_EQ(mock->releases, 1);
  }
}

TEST_F(FalconDriver, GivesNoForceAtImpossiblePlaces) {
  const auto mock = mock_.plug(FalconModel({.wild_after = 300}, true), 1);
  auto device = opened(1);
  ASSERT_NE(device, nullptr);
  await([&] {
    const Contact contact = device->sample().contact;
    device->command({2, 1});
    return contact == Contact::stale && mock->with_model([](FalconModel& model) { return model.answers > 320; });
  });
  EXPECT_EQ(device->command({2, 1}), Force(0));
  await([&] { return torques(mock) == glm::ivec3(0); });
  EXPECT_FALSE(device->was_lost());
}

TEST_F(FalconDriver, IsListedWithItsRequirements) {
  const auto mock = mock_.plug(FalconModel(), 1);
  found(1);
  const Environment none("WALE_FALCON_FIRMWARE", "/nowhere/falcon.bin");
  const Connections connections{context()};
  const auto listed = find_driver(drivers(), "novint-falcon")->find(connections, nullptr);
  ASSERT_EQ(listed.size(), 1u);
  EXPECT_TRUE(find_driver(drivers(), "hid-pid")->find(connections, nullptr).empty()) << "it is not of the HID class";
  EXPECT_EQ(listed[0].name, "Novint Falcon");
  EXPECT_EQ(listed[0].can, "three motors, used as two axes in a plane, 4096 steps of torque to each side");
  ASSERT_TRUE(listed[0].obstacle);
  EXPECT_EQ(listed[0].obstacle->code, Code::unreadable_file);
  EXPECT_EQ(listed[0].obstacle->sentence, "there is no firmware at /nowhere/falcon.bin");
  const Environment there("WALE_FALCON_FIRMWARE", firmware_.c_str());
  EXPECT_FALSE(find_driver(drivers(), "novint-falcon")->find(connections, nullptr)[0].obstacle);
  EXPECT_TRUE(mock->with_model([](FalconModel& model) { return model.log.empty(); }));
}

}  // namespace
}  // namespace wale::test::falcon_device
