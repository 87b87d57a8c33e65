#include "runtime/device/hid_pid/hid_pid_device.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "runtime/device/driver.hpp"
#include "schema/without_place.hpp"
#include "tests/runtime/programs.hpp"
#include "tests/usb/allocations.hpp"
#include "tests/usb/profiles.hpp"
#include "tests/usb_mock/usb_driver.hpp"
#include "wale/stage.hpp"

// Runs unmodified libusb and the whole driver with mock devices. The tests assert counts, order and bytes, never
// durations.

namespace wale::test {
namespace {

using namespace std::chrono_literals;

constexpr char push_until_killed[] = "--push-until-killed";

class UsbDriver : public MockedUsb {
 protected:
  std::unique_ptr<HidPidDevice> opened(int port, const HidPidDevice::Options& options = in_mock_time()) const {
    auto result = HidPidDevice::open(context(), found(port), trusted(joystick_profile()), options);
    if (!result) {
      ADD_FAILURE() << result.error().sentence;
      return nullptr;
    }
    return *std::move(result);
  }

  std::string refusal(int port, unsigned timeout = unhurried) const {
    HidPidDevice::Options options = in_mock_time();
    options.timeout = options.set_up_timeout = timeout;
    auto result = HidPidDevice::open(context(), found(port), trusted(joystick_profile()), options);
    return result ? "opened" : in_words_without_place(result.error());
  }
};

/// The Set Constant Force packets of OpenFFBoard in a log, as block and counts.
struct Sent {
  int block = 0, counts = 0;
};
std::vector<Sent> forces_in(const std::vector<std::string>& log) {
  std::vector<Sent> sent;
  for (const std::string& line : log) {
    if (line.rfind("OUT 05 ", 0) != 0) continue;
    const auto bytes = from_hex(line.substr(4));
    sent.push_back({bytes[1], static_cast<std::int16_t>(bytes[2] | bytes[3] << 8)});
  }
  return sent;
}

TEST_F(UsbDriver, FindsADeviceAndItsProperties) {
  mock_.plug(PidModel(openffboard()), 1);
  const UsbDeviceInfo info = found(1);
  EXPECT_EQ(in_words(info.vendor, info.product), "1209:ffb0");
  const auto bytes = static_cast<std::uint16_t>(report_descriptor(openffboard()).size());
  EXPECT_EQ(info.hid, (std::vector<UsbHidInterface>{{0, bytes, 0x83, 0x02, 64, 1, 1}}));
}

TEST_F(UsbDriver, ListsDevicesWithoutSendingReports) {
  const auto felt = mock_.plug(PidModel(openffboard()), 1);
  PidModel stick(arduino());
  stick.descriptor = from_hex("05 01 09 04 A1 01 09 30 15 00 25 7F 75 08 95 01 81 02 C0");
  const auto plain = mock_.plug(std::move(stick), 2), taken = mock_.plug(PidModel(rhino()), 3);
  taken->is_claimed_elsewhere = true;
  found(3);
  const auto listed = plugged_in({context()});
  ASSERT_EQ(listed.size(), 3u);
  EXPECT_EQ(listed[0].name, "OpenFFBoard");
  EXPECT_EQ(listed[0].can, "two axes by direction, 32767 steps of force to each side");
  EXPECT_FALSE(listed[0].obstacle);
  EXPECT_EQ(listed[0].transport, "libusb (not by hidraw: the kernel's driver has made no hidraw node for it)");
  EXPECT_EQ(listed[0].held_by, std::vector<std::string>{});
  ASSERT_TRUE(listed[1].obstacle && listed[2].obstacle);
  EXPECT_EQ(listed[1].obstacle->code, Code::no_force_device);
  EXPECT_EQ(listed[1].obstacle->sentence,
            "it is not a force device: nothing in its report descriptor is of usage page 0F");
  EXPECT_EQ(listed[2].obstacle->sentence, "another program has claimed it");
  EXPECT_EQ(felt->claims, felt->releases);
  EXPECT_EQ(felt->drivers_back, 0);
  EXPECT_TRUE(felt->with_model([](PidModel& model) { return model.log.empty(); })) << "no report, only descriptors";
}

TEST(UsbRefusal, PermissionComesWithTheRuleToInstall) {
  UsbDeviceInfo info;
  info.vendor = 0x1209;
  info.product = 0xffb0;
  constexpr int access = -3;  // LIBUSB_ERROR_ACCESS
  const Error error = why_not_usable(access, info);
  EXPECT_EQ(error.code, Code::no_permission);
  EXPECT_EQ(in_words_without_place(error),
            "no permission to open it; as root, write the lines\n"
            "  SUBSYSTEM==\"usb\", ATTR{idVendor}==\"1209\", ATTR{idProduct}==\"ffb0\", TAG+=\"uaccess\"\n"
            "  SUBSYSTEM==\"hidraw\", ATTRS{idVendor}==\"1209\", ATTRS{idProduct}==\"ffb0\", TAG+=\"uaccess\"\n"
            "to /etc/udev/rules.d/70-wale.rules, then plug it in again");
}

TEST_F(UsbDriver, RunsFromStartToEnd) {
  const auto joystick = mock_.plug(PidModel(openffboard()), 1);
  auto device = opened(1);
  ASSERT_NE(device, nullptr);
  EXPECT_EQ(device->arrangement(), hid::Arrangement::by_direction);
  EXPECT_EQ(joystick->claims, 1);
  // tests/reference/usb_exchanges.md, OpenFFBoard, with durations of 200 ms.
  const auto set_up = joystick->with_model([](PidModel& model) { return model.log; });
  const std::vector<std::string> expected{
      "GET 13",          "OUT 0C 08",       "OUT 0C 01",
      "OUT 0D FF",       "SET 11 01 00 00", "GET 12",
      "SET 11 01 00 00", "GET 12",          "OUT 01 01 01 C8 00 00 00 00 00 00 00 FF 00 04 28 23 00 00",
      "OUT 05 01 00 00", "OUT 0A 01 01 01", "OUT 01 02 01 C8 00 00 00 00 00 00 00 FF 00 04 50 46 00 00",
      "OUT 05 02 00 00", "OUT 0A 02 01 01"};
  ASSERT_GE(set_up.size(), expected.size());
  EXPECT_EQ(std::vector<std::string>(set_up.begin(), set_up.begin() + static_cast<long>(expected.size())), expected);

  // Each force identifies its tick: x grows with each tick, and so does y, which points to the user and changes sign.
  constexpr long ticks = 10'000;
  const Force last(static_cast<float>(ticks / 32767.0 * 10));
  run_ticks(mock_, ticks, [&](long tick) {
    const auto newton = static_cast<float>(static_cast<double>(tick + 1) / 32767 * 10);
    const long before = allocations;
    device->elapse(1);
    device->sample();
    const Force exerted = device->command({newton, newton});
    ASSERT_EQ(allocations, before);
    ASSERT_NEAR(exerted.x, newton, 10.0 / 32767 / 2);
  });
  run_until(mock_, [&] {
    device->command(last);
    return joystick->with_model([&](PidModel& model) {
      return model.effects[1].magnitude == ticks / 32767.0 && model.effects[2].magnitude == -ticks / 32767.0;
    });
  });
  const auto sent = forces_in(joystick->with_model([](PidModel& model) { return model.log; }));
  const auto counts = device->counts();
  EXPECT_EQ(counts.forces_sent[0] + counts.forces_sent[1] + 2, static_cast<long>(sent.size()))
      << "two packets are from setting up";
  EXPECT_GT(sent.size(), 100u);
  int newest[3] = {0, 0, 0};
  for (std::size_t i = 2; i < sent.size(); ++i) {
    const int size = sent[i].block == 1 ? sent[i].counts : -sent[i].counts;
    ASSERT_GT(size, newest[sent[i].block]) << "no old force after a newer one, and none twice";
    newest[sent[i].block] = size;
    ASSERT_NE(sent[i].block, sent[i - 1].block) << "axes alternate when both have a new force";
  }
  EXPECT_GT(counts.refreshes, 10);
  EXPECT_EQ(counts.bad_inputs, 0);
  EXPECT_GT(counts.inputs, 100);

  // The device reports the place of the stick.
  run_until(mock_, [&] {
    device->command(last);
    const Reading reading = device->sample();
    const glm::dvec2 position = joystick->with_model([](PidModel& model) { return model.position(); });
    return std::abs(reading.counts.x * joystick_profile().position_step() - position.x) < 0.002 &&
           std::abs(reading.counts.y * joystick_profile().position_step() - position.y) < 0.002;
  });

  device.reset();
  joystick->with_model([](PidModel& model) {
    EXPECT_EQ(std::vector<std::string>(model.log.end() - 9, model.log.end()),
              (std::vector<std::string>{"OUT 05 01 00 00", "OUT 05 02 00 00", "OUT 0A 01 03 00", "OUT 0A 02 03 00",
                                        "OUT 0C 04", "OUT 0B 01", "OUT 0B 02", "OUT 0C 08", "OUT 0C 02"}));
    EXPECT_EQ(model.wrong_reports, 0);
    EXPECT_EQ(model.force(), glm::dvec2(0));
  });
  EXPECT_EQ(joystick->releases, 1);
  EXPECT_EQ(joystick->drivers_back, 1) << "the kernel's driver is attached again";
  EXPECT_EQ(joystick->unknown_ioctls, 0);
}

TEST_F(UsbDriver, GivesTheForcesOfAStageAndOfASwap) {
  const auto joystick = mock_.plug(PidModel(openffboard()), 1);
  auto result = HidPidDevice::open(context(), found(1), trusted(sandpaper()), in_mock_time());
  const auto device = *std::move(result);
  long calls = 0;
  const auto ran = [&] {
    InStepDevice in_step(mock_, *device);
    Stage stage(in_step);
    Patch patch = *stage.add(built_for(spring(50), in_step.profile()));
    RunOptions options{.seconds = 0.8};
    options.progress = [&](const Now&) {
      if (++calls != 3) return;
      EXPECT_TRUE(patch.replace(built_for(oil(5), in_step.profile())));
    };
    return stage.run(options);
  }();
  ASSERT_TRUE(ran);
  EXPECT_GE(calls, 3);
  await([&] { return joystick->with_model([](PidModel& model) { return model.force(); }) == glm::dvec2(0); });

  // The forces sent along x are commanded forces of ticks, in order. Some ticks are left out.
  const auto& ticks = ran->record.ticks;
  const auto sent = forces_in(joystick->with_model([](PidModel& model) { return model.log; }));
  std::size_t tick = 0;
  long found_again = 0;
  for (std::size_t i = 2; i < sent.size(); ++i) {
    if (sent[i].block != 1 || sent[i].counts == 0) continue;
    while (tick < ticks.size() && std::lround(ticks[tick].force.x / 10 * 32767) != sent[i].counts) ++tick;
    ASSERT_LT(tick, ticks.size()) << "no later tick commanded this force: packet " << i;
    ++found_again;
  }
  EXPECT_GT(found_again, 50);
  EXPECT_EQ(joystick->with_model([](PidModel& model) { return model.wrong_reports; }), 0);
}

TEST_F(UsbDriver, TheForceOfAKilledProcessEnds) {
  const auto joystick = mock_.plug(PidModel(openffboard()), 1);
  found(1);
  const auto force = [&] { return joystick->with_model([](PidModel& model) { return model.force(); }); };
  const std::string self = std::filesystem::read_symlink("/proc/self/exe");
  pid_t child = 0;
  const char* words[] = {self.c_str(), push_until_killed, nullptr};
  ASSERT_EQ(posix_spawn(&child, self.c_str(), nullptr, nullptr, const_cast<char**>(words), environ), 0);
  await([&] { return force().x > 0.29; });
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  joystick->close_all();
  await([&] { return force() == glm::dvec2(0); });
  EXPECT_TRUE(joystick->with_model([](PidModel& model) { return model.effects[1].plays; }))
      << "the effect was not stopped";
}

TEST_F(UsbDriver, EachFamilyIsFelt) {
  int port = 0;
  for (const PidFamily& family : all_families()) {
    const auto joystick = mock_.plug(PidModel(family), ++port);
    const auto device = opened(port);
    ASSERT_NE(device, nullptr) << family.name;
    run_until(mock_, [&] {
      device->command({5, 2.5});
      const glm::dvec2 force = joystick->with_model([](PidModel& model) { return model.force(); });
      return std::abs(force.x - 0.5) < 0.02 && std::abs(force.y + 0.25) < 0.02;  // HID's y is to the user
    });
    EXPECT_EQ(joystick->with_model([](PidModel& model) { return model.wrong_reports; }), 0) << family.name;
  }
}

TEST_F(UsbDriver, IsUnpluggedWhileRunningAndPluggedInAgain) {
  std::atomic<int> arrived{0}, left{0};
  ASSERT_TRUE(context()->watch([&](const UsbEvent& event) {
    EXPECT_EQ(event.vendor, 0x1209);
    ++(event.arrived ? arrived : left);
  }));
  const auto joystick = mock_.plug(PidModel(openffboard()), 1);
  await([&] { return arrived == 1; });
  const auto device = opened(1);
  ASSERT_NE(device, nullptr);
  run_ticks(mock_, 200, [&](long tick) { device->command({static_cast<float>(tick) / 100, 1}); });
  EXPECT_FALSE(device->was_lost());
  mock_.unplug(joystick);
  await([&] { return device->was_lost(); });
  EXPECT_EQ(device->reason(), "it was unplugged");
  EXPECT_EQ(device->command({1, 1}), Force(0));
  await([&] { return left == 1; });

  const auto again = mock_.plug(PidModel(openffboard()), 1);
  await([&] { return arrived == 2; });
  const auto second = opened(1);
  ASSERT_NE(second, nullptr);
  run_until(mock_, [&] {
    second->command({2, 0});
    return std::abs(again->with_model([](PidModel& model) { return model.force(); }).x - 0.2) < 1e-3;
  });
}

TEST_F(UsbDriver, RunsTwoDevicesAtOnce) {
  const auto left = mock_.plug(PidModel(openffboard()), 1), right = mock_.plug(PidModel(rhino()), 2);
  auto first = opened(1);
  const auto second = opened(2);
  ASSERT_TRUE(first != nullptr && second != nullptr);
  run_ticks(mock_, 300, [&](long) {
    first->command({4, 0});
    second->command({0, -4});
    if (first != nullptr && mock_.frames() % 100 == 0) second->sample();
  });
  run_until(mock_, [&] {
    first->command({4, 0});
    second->command({0, -4});
    return std::abs(left->with_model([](PidModel& model) { return model.force(); }).x - 0.4) < 1e-3 &&
           std::abs(right->with_model([](PidModel& model) { return model.force(); }).y - 0.4) < 0.02;
  });
  first.reset();
  EXPECT_EQ(left->with_model([](PidModel& model) { return model.force(); }), glm::dvec2(0));
  EXPECT_FALSE(second->was_lost());
  run_until(mock_, [&] {
    second->command({0, 4});
    return std::abs(right->with_model([](PidModel& model) { return model.force(); }).y + 0.4) < 0.02;
  });
}

TEST_F(UsbDriver, OwnersMayEndInAnyOrder) {
  const auto joystick = mock_.plug(PidModel(openffboard()), 1);
  std::unique_ptr<HidPidDevice> device;
  {
    auto own = UsbContext::open();
    auto result = HidPidDevice::open(*own, found(1), trusted(joystick_profile()), in_mock_time());
    device = *std::move(result);
  }
  device->command({1, 1});  // outlives its context's last other owner
  device.reset();
  opened(1).reset();  // at once
  const auto third = opened(1);
  mock_.unplug(joystick);  // a device is released while it is unplugged
}

// Devices that break the protocol.

TEST_F(UsbDriver, SaysWhyItCannotBeUsed) {
  const auto refused = [&](PidModel model, int port) {
    mock_.plug(std::move(model), port);
    return refusal(port);
  };
  const auto taken = mock_.plug(PidModel(openffboard()), 1);
  taken->is_claimed_elsewhere = true;
  EXPECT_EQ(refusal(1), "1209:ffb0: another program has claimed it");
  PidModel stick(openffboard());
  stick.descriptor = from_hex("05 01 09 04 A1 01 09 30 15 00 25 7F 75 08 95 01 81 02 C0");
  EXPECT_EQ(refused(stick, 2),
            "1209:ffb0: it is not a force device: nothing in its report descriptor is of usage page 0F");
  PidModel damaged(openffboard());
  damaged.descriptor.back() = 0xa4;
  EXPECT_EQ(refused(damaged, 3), "1209:ffb0: its report descriptor is damaged at byte " +
                                     std::to_string(damaged.descriptor.size()) + ": a collection is not ended");
  EXPECT_EQ(refused(PidModel(arduino(), {.room = 0}), 4),
            "2341:8036: it has no room for an effect: another program may hold them");
  mock_.plug(PidModel(arduino(), {.silent = true}), 5);
  EXPECT_EQ(refusal(5, 100), "2341:8036: it does not answer in time");
  EXPECT_EQ(refused(PidModel(arduino(), {.short_load = true}), 6),
            "2341:8036: its answer about a new effect is malformed");
  EXPECT_EQ(refused(PidModel(arduino(), {.no_inputs_after = 0, .stalls_polls = true}), 7),
            "2341:8036: it sends no position");
  EXPECT_EQ(taken->releases, 0);
}

TEST_F(UsbDriver, FaultsWhileRunningEndInNoForce) {
  struct Case {
    Faults faults;
    const char* reason;
    unsigned timeout = unhurried;
  };
  const Case cases[] = {
      {{.stall_outputs_after = 100}, "it refuses a report that its descriptor declares"},
      {{.silent_outputs_after = 100}, "it does not answer in time", 100},
      {{.bad_inputs_after = 100}, "its input reports do not match its descriptor"},
      {{.short_inputs_after = 100}, "its input reports do not match its descriptor"},
      {{.no_inputs_after = 100, .deaf_to_polls = true}, "it does not answer in time", 100},
  };
  int port = 0;
  for (const Case& fault : cases) {
    const auto joystick = mock_.plug(PidModel(openffboard(), fault.faults), ++port);
    HidPidDevice::Options options = in_mock_time();
    options.timeout = fault.timeout;
    auto device = opened(port, options);
    ASSERT_NE(device, nullptr);
    long tick = 0;
    await([&] {
      ++tick;
      device->command({3.0f + static_cast<float>(tick % 100) / 100, 3});
      return device->was_lost();
    });
    EXPECT_EQ(device->reason(), fault.reason);
    device.reset();
    EXPECT_EQ(joystick->with_model([](PidModel& model) { return model.force(); }), glm::dvec2(0)) << fault.reason;
    EXPECT_EQ(joystick->releases, 1);
  }
}

/// Opens the joystick at port 1 in a separate process, and pushes to the right with 3 N.
[[noreturn]] void push_for_ever(std::optional<PidTransportKind> transport) {
  const auto context = *UsbContext::open();
  HidPidDevice::Options options;
  options.transport = transport;
  for (const UsbDeviceInfo& info : context->devices()) {
    auto result = HidPidDevice::open(context, info, trusted(joystick_profile()), options);
    const auto device = *std::move(result);
    while (true) {
      device->command({3, 0});
      std::this_thread::sleep_for(1ms);
    }
  }
  std::exit(1);
}

}  // namespace
}  // namespace wale::test

int main(int count, char** words) {
  if (count >= 2 && words[1] == std::string_view(wale::test::push_until_killed)) {
    wale::test::push_for_ever(count == 3 ? wale::read_transport_kind(words[2]) : std::nullopt);
  }
  testing::InitGoogleTest(&count, words);
  UMockdevTestbed* testbed = umockdev_testbed_new();
  const bool is_mocked = umockdev_in_mock_environment();
  g_object_unref(testbed);
  if (!is_mocked) {
    std::fprintf(stderr, "to be run as: umockdev-wrapper %s\n", words[0]);
    return 2;
  }
  return RUN_ALL_TESTS();
}
