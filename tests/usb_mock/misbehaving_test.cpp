#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "runtime/device/hid_pid/hid_pid_device.hpp"
#include "tests/usb/profiles.hpp"
#include "tests/usb_mock/usb_driver.hpp"

// Joysticks that break the protocol or answer late, through unmodified libusb. Forces stay in order and within bounds,
// or the device ends without force and with a reason.

namespace wale::test::misbehaving {
namespace {

class MisbehavingUsb : public MockedUsb {
 protected:
  Result<std::unique_ptr<HidPidDevice>> open(int port, unsigned timeout = unhurried) {
    HidPidDevice::Options options = in_mock_time();
    options.timeout = timeout;
    return HidPidDevice::open(context(), found(port), trusted(joystick_profile()), options);
  }
  std::unique_ptr<HidPidDevice> opened(int port, unsigned timeout = unhurried) {
    auto result = open(port, timeout);
    if (!result) {
      ADD_FAILURE() << result.error().sentence;
      return nullptr;
    }
    return *std::move(result);
  }
  std::string refusal(int port) {
    auto result = open(port);
    return result ? "opened" : result.error().sentence;
  }
};

/// The nonzero counts of the Set Constant Force packets to a block, through either endpoint.
std::vector<int> forces_to(int block, const std::vector<std::string>& log) {
  std::vector<int> forces;
  for (const std::string& line : log) {
    if (line.size() != 15 || line.substr(4, 2) != "05") continue;
    const auto bytes = from_hex(line.substr(4));
    const int counts = static_cast<std::int16_t>(bytes[2] | bytes[3] << 8);
    if (bytes[1] == block && counts != 0) forces.push_back(counts);
  }
  return forces;
}

void expect_rising(const std::vector<int>& forces) {
  for (std::size_t i = 1; i < forces.size(); ++i) {
    ASSERT_GT(forces[i], forces[i - 1]) << "no old force after a newer one, and none twice: packet " << i;
  }
}

template <class Mock>
glm::dvec2 force_of(Mock& mock) {
  return mock->with_model([](PidModel& model) { return model.force(); });
}

/// A force to the right, in steps of 1 / 32767 of the device's full force.
Force steps(long count) { return {static_cast<float>(static_cast<double>(count) / 32767 * 10), 0}; }

/// Pushes to the right. The force grows by one step per tick.
void push_harder_and_harder(UsbMock& mock, HidPidDevice& device, long ticks) {
  run_ticks(mock, ticks, [&](long tick) {
    device.sample();
    device.command(steps(tick + 1));
  });
}

/// Keeps the last force until the model exerts it.
template <class Mock>
void push_until_felt(UsbMock& usb, Mock& mock, HidPidDevice& device, long count) {
  run_until(usb, [&] {
    device.command(steps(count));
    return std::abs(force_of(mock).x - static_cast<double>(count) / 32767) < 1e-9;
  });
}

TEST_F(MisbehavingUsb, TenThousandTicksWithDelaysAndSomeNonsense) {
  const auto mock = mock_.plug(PidModel(openffboard(), {.nonsense_every = 7, .short_every = 5, .late = 3}), 1);
  auto device = opened(1);
  ASSERT_NE(device, nullptr);
  constexpr long ticks = 10'000;
  push_harder_and_harder(mock_, *device, ticks);
  push_until_felt(mock_, mock, *device, ticks);
  EXPECT_FALSE(device->was_lost()) << device->reason();
  const auto counts = device->counts();
  const auto log = mock->with_model([](PidModel& model) { return model.log; });
  const auto forces = forces_to(1, log);
  expect_rising(forces);
  EXPECT_EQ(static_cast<long>(forces.size()), counts.forces_sent[0]);
  EXPECT_GT(counts.overwritten, 0);
  EXPECT_LE(counts.forces_sent[0], ticks / 3 + 10)
      << "each packet takes three frames, so most forces are never sent and none queue";
  EXPECT_GT(counts.bad_inputs, 50);
  EXPECT_GT(counts.inputs, counts.bad_inputs);
  EXPECT_GT(counts.refreshes, 10);
  EXPECT_EQ(mock->with_model([](PidModel& model) { return model.wrong_reports; }), 0);
  device.reset();
  EXPECT_EQ(force_of(mock), glm::dvec2(0));
  EXPECT_EQ(mock->releases, 1);
}

TEST_F(MisbehavingUsb, ADeviceThatBecomesTooSlowIsLost) {
  const auto mock = mock_.plug(PidModel(openffboard()), 1);
  auto device = opened(1, 1000);
  ASSERT_NE(device, nullptr);
  push_harder_and_harder(mock_, *device, 100);
  mock->with_model([](PidModel& model) { model.faults.late = 100'000; });
  float newton = 1;
  await([&] {
    device->command({newton += 0.001f, 0});
    return device->was_lost();
  });
  EXPECT_EQ(device->reason(), "it does not answer in time");
  mock->with_model([](PidModel& model) { model.faults.late = 0; });
  device.reset();
  await([&] { return force_of(mock) == glm::dvec2(0); });  // the driver has stopped the effects, or they have ended
}

TEST_F(MisbehavingUsb, WithoutAnOutEndpointAllReportsUseTheControlEndpoint) {
  const auto mock = mock_.plug(PidModel(openffboard(), {.has_no_out = true}), 1);
  auto device = opened(1);
  ASSERT_NE(device, nullptr);
  push_harder_and_harder(mock_, *device, 500);
  push_until_felt(mock_, mock, *device, 500);
  const auto log = mock->with_model([](PidModel& model) { return model.log; });
  for (const std::string& line : log) EXPECT_NE(line.substr(0, 3), "OUT");
  expect_rising(forces_to(1, log));
  device.reset();
  mock->with_model([](PidModel& model) {
    EXPECT_EQ(model.log.back(), "SET 0C 02");
    EXPECT_EQ(model.wrong_reports, 0);
    EXPECT_EQ(model.force(), glm::dvec2(0));
  });
}

TEST_F(MisbehavingUsb, FalseDescriptionsAreFoundDuringSetUp) {
  struct Case {
    PidModel model;
    const char* reason;
  };
  PidModel another(rhino());  // its answers are of another family than its descriptor
  another.descriptor = report_descriptor(openffboard());
  PidModel magnitude(openffboard());
  // The magnitude's range of 16 bits, 16 01 80 26 FF 7F, as that of 8 bits: 75 10 after it becomes 75 08.
  const std::uint8_t usage[] = {0x09, 0x70};
  const auto at =
      std::search(magnitude.descriptor.begin(), magnitude.descriptor.end(), std::begin(usage), std::end(usage));
  const auto size = std::find(at, magnitude.descriptor.end(), 0x75);
  *(size + 1) = 8;
  const Case cases[] = {
      {PidModel(openffboard(), {.says_more_bytes = 40}), "its report descriptor is cut short"},
      {another, "it refuses a report that its descriptor declares"},
      {magnitude, "magnitude of its Set Constant Force report, -32767 .. 32767, does not fit in 8 bits"},
      {PidModel(openffboard(), {.wild_block = true}), "its answer about a new effect is malformed"},
      {PidModel(openffboard(), {.block_zero = true}), "its answer about a new effect is malformed"},
      {PidModel(openffboard(), {.same_block = true}), "its answer about a new effect is malformed"},
      {PidModel(openffboard(), {.pending_loads = 1000}), "it does not report whether it has created an effect"},
  };
  int port = 0;
  for (const Case& lie : cases) {
    const auto mock = mock_.plug(lie.model, ++port);
    const std::string reason = refusal(port);
    EXPECT_NE(reason.find(lie.reason), std::string::npos) << reason;
    EXPECT_EQ(force_of(mock), glm::dvec2(0));
    EXPECT_EQ(mock->claims, mock->releases);
  }
}

TEST_F(MisbehavingUsb, PositionsStayWithinTheDeclaredRange) {
  mock_.plug(PidModel(openffboard(), {.beyond_its_range = true}), 1);
  const auto device = opened(1);
  ASSERT_NE(device, nullptr);
  await([&] { return device->counts().inputs > 20; });
  EXPECT_EQ(device->sample().counts, glm::ivec2(-32767, 32767)) << "half of the profile's 65534 counts";
}

TEST_F(MisbehavingUsb, AStallDisturbsNeitherAnotherDeviceNorALaterOne) {
  const auto bad = mock_.plug(PidModel(openffboard(), {.stall_outputs_after = 60}), 1);
  const auto good = mock_.plug(PidModel(openffboard()), 2);
  auto first = opened(1), second = opened(2);
  ASSERT_TRUE(first != nullptr && second != nullptr);
  run_ticks(mock_, 2000, [&](long tick) {
    first->command(steps(tick + 1));
    second->command(steps(tick + 1));
  });
  push_until_felt(mock_, good, *second, 2000);
  await([&] { return first->was_lost(); });
  EXPECT_FALSE(second->was_lost());
  expect_rising(forces_to(1, good->with_model([](PidModel& model) { return model.log; })));
  first.reset();
  EXPECT_EQ(force_of(bad), glm::dvec2(0)) << "stopped through the control endpoint";
  bad->with_model([](PidModel& model) { model.faults = {}; });
  first = opened(1);
  ASSERT_NE(first, nullptr) << "usable again";
  run_until(mock_, [&] {
    first->command({5, 0});
    return std::abs(force_of(bad).x - 0.5) < 1e-3;
  });
}

}  // namespace
}  // namespace wale::test::misbehaving
