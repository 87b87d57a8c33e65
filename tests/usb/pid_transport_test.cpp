#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <thread>

#include "runtime/device/hid_pid/hid_pid_device.hpp"
#include "tests/usb/allocations.hpp"
#include "tests/usb/evdev_fake.hpp"
#include "tests/usb/hidraw_fake.hpp"
#include "tests/usb/profiles.hpp"

// The driver's own threads with nodes that need no kernel. The tests assert counts, order and bytes, never durations.

namespace wale::test {
namespace {

/// Looks once per millisecond or slower. Throws std::runtime_error after a fixed number of looks.
void until(const std::function<bool()>& holds, int line = __builtin_LINE()) {
  constexpr int most_looks = 60'000;
  for (int look = 0; look < most_looks; ++look) {
    if (holds()) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  throw std::runtime_error("awaited in vain in line " + std::to_string(line));
}

Result<std::unique_ptr<HidPidDevice>> open(NodeFake& fake) {
  return HidPidDevice::open(nullptr, fake.descriptor(), trusted(joystick_profile()), NodeFake::options());
}

std::unique_ptr<HidPidDevice> opened(NodeFake& fake) {
  auto result = open(fake);
  if (!result) throw std::runtime_error(in_words(result.error()));
  return *std::move(result);
}

PidModel telling(PidFamily family) {
  PidModel model(std::move(family));
  model.tells_state = true;
  return model;
}

std::vector<std::string> log_of(HidrawFake& fake) {
  return fake.with_model([](PidModel& model) { return model.log; });
}
glm::dvec2 force_of(HidrawFake& fake) {
  return fake.with_model([](PidModel& model) { return model.force(); });
}
bool is_near(glm::dvec2 a, glm::dvec2 b) { return std::abs(a.x - b.x) < 1e-3 && std::abs(a.y - b.y) < 1e-3; }

/// Whether a log has a Set Constant Force packet of OpenFFBoard with a force other than zero.
bool pushes(const std::vector<std::string>& log) {
  return std::ranges::any_of(
      log, [](const std::string& line) { return line.starts_with("OUT 05 ") && line.substr(10) != "00 00"; });
}

TEST(HidrawTransport, RunsFromStartToEndAndLeavesOtherEffectsAlone) {
  HidrawFake fake{PidModel(openffboard())};
  auto device = opened(fake);
  EXPECT_EQ(device->transport(), PidTransportKind::hidraw);
  EXPECT_EQ(device->manner(), "one effect for each axis, by direction, by hidraw");
  // The same as through libusb, without the reset: it would end other programs' effects.
  const std::vector<std::string> expected{"GET 13",
                                          "OUT 0C 01",
                                          "OUT 0D FF",
                                          "SET 11 01 00 00",
                                          "GET 12",
                                          "SET 11 01 00 00",
                                          "GET 12",
                                          "OUT 01 01 01 C8 00 00 00 00 00 00 00 FF 00 04 28 23 00 00",
                                          "OUT 05 01 00 00",
                                          "OUT 0A 01 01 01",
                                          "OUT 01 02 01 C8 00 00 00 00 00 00 00 FF 00 04 50 46 00 00",
                                          "OUT 05 02 00 00",
                                          "OUT 0A 02 01 01"};
  until([&] { return log_of(fake).size() >= expected.size(); });
  const auto set_up = log_of(fake);
  EXPECT_EQ(std::vector<std::string>(set_up.begin(), set_up.begin() + static_cast<long>(expected.size())), expected);
  EXPECT_FALSE(pushes(set_up)) << "forces begin at none";
  long tick = 0;
  until([&] {
    const long before = allocations;
    device->sample();
    device->command({static_cast<float>(std::min(++tick, 2000L)) / 1000, 1});
    EXPECT_EQ(allocations, before);
    return is_near(force_of(fake), {0.2, -0.1});
  });
  int newest = 0;
  for (const std::string& line : log_of(fake)) {
    if (!line.starts_with("OUT 05 01 ")) continue;
    const auto bytes = from_hex(line.substr(4));
    const int counts = static_cast<std::int16_t>(bytes[2] | bytes[3] << 8);
    EXPECT_GE(counts, newest) << "no old force after a newer one";
    newest = counts;
  }
  until([&] {
    device->command({2, 1});
    const glm::dvec2 position = fake.with_model([](PidModel& model) { return model.position(); });
    return std::abs(device->sample().counts.x * joystick_profile().position_step() - position.x) < 0.005;
  });
  device.reset();
  until([&] { return log_of(fake).back() == "OUT 0B 02"; });
  const auto log = log_of(fake);
  EXPECT_EQ(std::vector<std::string>(log.end() - 6, log.end()),
            (std::vector<std::string>{"OUT 05 01 00 00", "OUT 05 02 00 00", "OUT 0A 01 03 00", "OUT 0A 02 03 00",
                                      "OUT 0B 01", "OUT 0B 02"}))
      << "neither all effects stopped nor actuators disabled";
  fake.with_model([](PidModel& model) { EXPECT_EQ(model.wrong_reports, 0); });
}

TEST(HidrawTransport, EachFamilyIsFelt) {
  for (const PidFamily& family : all_families()) {
    HidrawFake fake{PidModel(family)};
    const auto device = opened(fake);
    until([&] {
      device->command({5, 2.5});
      const glm::dvec2 force = force_of(fake);
      return std::abs(force.x - 0.5) < 0.02 && std::abs(force.y + 0.25) < 0.02;  // HID's y is to the user
    });
    fake.with_model([&](PidModel& model) { EXPECT_EQ(model.wrong_reports, 0) << family.name; });
  }
}

TEST(HidrawTransport, NoticesARivalsResetAndBeginsAgainWithoutForce) {
  HidrawFake fake(telling(openffboard()));
  auto device = opened(fake);
  until([&] {
    device->command({3, 0});
    return is_near(force_of(fake), {0.3, 0}) && device->counts().refreshes >= 2;
  });
  fake.with_model([](PidModel& model) { model.output({0x0c, 8}); });
  until([&] {
    device->command({3, 0});
    return device->was_lost();
  });
  EXPECT_EQ(device->reason(), "another program has reset it or stopped its effects");
  EXPECT_EQ(device->command({3, 0}), Force(0));
  EXPECT_EQ(force_of(fake), glm::dvec2(0));
  fake.with_model([](PidModel& model) { model.log.clear(); });
  device.reset();
  EXPECT_TRUE(std::ranges::none_of(log_of(fake), [](const std::string& line) { return line.starts_with("OUT 0B"); }))
      << "its blocks may be another program's by now";
  device = opened(fake);
  EXPECT_FALSE(pushes(log_of(fake)));
  until([&] {
    device->command({3, 0});
    return is_near(force_of(fake), {0.3, 0});
  });
}

TEST(HidrawTransport, NoticesThatARivalHasStoppedItsEffects) {
  HidrawFake fake(telling(openffboard()));
  const auto device = opened(fake);
  until([&] {
    device->command({3, 0});
    return device->counts().refreshes >= 2;
  });
  fake.with_model([](PidModel& model) { model.output({0x0c, 4}); });
  until([&] {
    device->command({3, 0});
    // The driver takes a stop right after a start for the end of the earlier effect.
    if (!device->was_lost()) fake.with_model([](PidModel& model) { model.output({0x0c, 4}); });
    return device->was_lost();
  });
}

/// Another program's Create New Effect.
void create_as_rival(PidModel& model) { model.control({0x21, 9, 0x11, 3, 0, 0, 4, 0}, {0x11, 1, 0, 0}); }

/// Opens it, plays, and has another program stop all effects until that is noticed. What the other program does in the
/// 20 ms after that may be taken for what it did before, so these pass.
std::unique_ptr<HidPidDevice> stopped_by_rival(HidrawFake& fake) {
  auto device = opened(fake);
  until([&] {
    device->command({3, 0});
    return device->counts().refreshes >= 2;
  });
  long look = 0;
  until([&] {
    device->command({3, 0});
    // One that falls into the moments after a start is taken for the end of what was started before.
    constexpr long patience = 50;
    if (!device->was_lost() && look++ % patience == 0) {
      fake.with_model([](PidModel& model) { model.output({0x0c, 4}); });
    }
    return device->was_lost();
  });
  constexpr std::int64_t surely_later = 25'000;  // microseconds
  until([noticed = NodeFake::now()] { return NodeFake::now() - noticed > surely_later; });
  return device;
}

TEST(HidrawTransport, GivesItsBlocksBackAfterARivalsStop) {
  PidModel model(openffboard(), {.room = 3});  // of three blocks, one life holds two
  model.tells_state = true;
  HidrawFake fake(std::move(model));
  for (int life = 0; life < 4; ++life) {
    auto device = stopped_by_rival(fake);
    EXPECT_EQ(device->arrangement(), hid::Arrangement::by_direction) << "room for two";
    device.reset();
    until([&] {
      return fake.with_model(
          [](PidModel& left) { return std::ranges::none_of(left.effects, &PidModel::Effect::exists); });
    });
    EXPECT_EQ(fake.with_model([](PidModel& left) { return left.wrong_reports; }), 0);
  }
}

TEST(HidrawTransport, LeavesBlocksThatMayBeAnotherProgramsAlone) {
  {
    HidrawFake fake(telling(openffboard()));
    auto device = stopped_by_rival(fake);
    fake.with_model(create_as_rival);
    device.reset();
    const auto exists = [&](std::size_t block) {
      return fake.with_model([&](PidModel& model) { return model.effects[block].exists; });
    };
    EXPECT_TRUE(exists(1) && exists(2) && exists(3)) << "nothing tells whose block 1 and 2 are";
  }
  for (const bool is_played : {false, true}) {  // block 1 is given out again, or both are and 1 is played
    HidrawFake fake(telling(openffboard()));
    auto device = stopped_by_rival(fake);
    fake.with_model([&](PidModel& model) {
      for (const std::uint8_t block : {1, 2}) model.output({0x0b, block});
      create_as_rival(model);
      if (!is_played) return;
      create_as_rival(model);
      model.output({0x0a, 1, 1, 1});
      model.log.clear();
    });
    device.reset();
    fake.with_model([&](PidModel& model) {
      EXPECT_TRUE(model.effects[1].exists);
      EXPECT_EQ(model.effects[2].exists, is_played);
      EXPECT_EQ(model.effects[1].plays, is_played);
    });
  }
}

TEST(HidrawTransport, NoticesAResetOfADeviceThatTellsNoState) {
  PidModel model(openffboard());
  std::string descriptor = hex(model.descriptor);
  descriptor.replace(descriptor.find("09 92 A1 02"), 11, "09 F1 A1 02");  // PID State is something else here
  model.descriptor = from_hex(descriptor);
  HidrawFake fake(std::move(model));
  const auto device = opened(fake);
  until([&] {
    device->command({3, 0});
    return device->counts().looks >= 1;
  });
  fake.with_model([](PidModel& rival) {
    rival.output({0x0c, 8});
    create_as_rival(rival);  // gets block 1 again
  });
  until([&] {
    device->command({3, 0});
    return device->was_lost();
  });
  EXPECT_EQ(device->reason(), "another program has reset it or stopped its effects");
}

TEST(HidrawTransport, LeavesAnotherProgramsEffectAlone) {
  PidModel model(openffboard());
  std::string descriptor = hex(model.descriptor);
  descriptor.replace(descriptor.find("09 92 A1 02"), 11, "09 F1 A1 02");
  model.descriptor = from_hex(descriptor);
  HidrawFake fake(std::move(model));
  auto device = opened(fake);
  fake.with_model(create_as_rival);
  until([&] {
    device->command({3, 0});
    return device->counts().looks >= 3;
  });
  EXPECT_FALSE(device->was_lost());
  device.reset();
  until([&] { return fake.with_model([](PidModel& left) { return !left.effects[1].exists; }); });
  EXPECT_TRUE(fake.with_model([](PidModel& left) { return left.effects[3].exists; }));
}

TEST(HidrawTransport, UnpluggedItIsLost) {
  HidrawFake fake{PidModel(openffboard())};
  const auto device = opened(fake);
  device->command({1, 0});
  fake.unplug();
  until([&] { return device->was_lost(); });
  EXPECT_FALSE(device->reason().empty());  // a socket's errors differ from those of hidraw: tests/qemu has the words
  EXPECT_EQ(device->sample().contact, Contact::lost);
}

TEST(HidrawTransport, SaysWhyItCannotBeUsed) {
  HidrawFake full{PidModel(arduino(), {.room = 0})};
  const auto without_room = open(full);
  ASSERT_FALSE(without_room);
  EXPECT_EQ(without_room.error().code, Code::unusable_device);
  EXPECT_EQ(without_room.error().sentence, "it has no room for an effect: another program may hold them");
  PidModel stick(openffboard());
  stick.descriptor = from_hex("05 01 09 04 A1 01 09 30 15 00 25 7F 75 08 95 01 81 02 C0");
  HidrawFake plain(std::move(stick));
  const auto forceless = open(plain);
  ASSERT_FALSE(forceless);
  EXPECT_EQ(forceless.error().code, Code::no_force_device);
}

TEST(EvdevTransport, RunsFromStartToEnd) {
  EvdevFake fake;
  auto device = opened(fake);
  EXPECT_EQ(device->transport(), PidTransportKind::evdev);
  EXPECT_EQ(fake.fuzz(), 0) << "with fuzz, positions come in steps of 1/256";
  until([&] { return fake.effects().size() == 2 && fake.effects()[0].plays && fake.effects()[1].plays; });
  const std::vector<std::string> set_up = fake.log();
  const auto is_any = [&](const std::string& line) { return std::ranges::find(set_up, line) != set_up.end(); };
  EXPECT_TRUE(is_any("upload 0 level 0 toward 16384") && is_any("upload 1 level 0 toward 32768"));
  EXPECT_TRUE(is_any("gain 65535") && is_any("autocenter 0"));
  EXPECT_EQ(fake.force(), glm::dvec2(0)) << "forces begin at none";
  until([&] {
    const long before = allocations;
    device->sample();
    device->command({4, 2});
    EXPECT_EQ(allocations, before);
    return is_near(fake.force(), {0.4, -0.2});  // HID's y is to the user
  });
  EXPECT_GE(device->counts().forces_sent[0], 1);
  fake.move_to(16384, -8192);
  until([&] {
    const Reading reading = device->sample();
    return reading.counts == glm::ivec2(16384, 8192);
  });
  until([&] {
    device->command({4, 2});
    return device->counts().refreshes > 4;
  });
  EXPECT_TRUE(is_near(fake.force(), {0.4, -0.2})) << "effects last a quarter of a second, and are played again in time";
  device.reset();
  EXPECT_TRUE(fake.effects().empty());
  EXPECT_EQ(fake.fuzz(), 255) << "its value from before";
}

TEST(EvdevTransport, ASingleEffectChangesItsDirection) {
  EvdevFake fake({.most_effects = 1, .room = 1});
  const auto device = opened(fake);
  EXPECT_EQ(device->arrangement(), hid::Arrangement::combined);
  for (const Force newton : {Force(4, 2), Force(-3, 1), Force(0, -5), Force(0, 0)}) {
    until([&] {
      device->command(newton);
      return is_near(fake.force(), {newton.x / 10, -newton.y / 10});
    });
  }
}

TEST(EvdevTransport, WithRoomForOneEffectItChangesItsDirectionToo) {
  EvdevFake fake({.room = 1});
  EXPECT_EQ(opened(fake)->arrangement(), hid::Arrangement::combined);
}

TEST(EvdevTransport, WithoutCommandsTheForceEnds) {
  EvdevFake fake;
  const auto device = opened(fake);
  until([&] {
    device->command({4, 0});
    return is_near(fake.force(), {0.4, 0});
  });
  until([&] { return fake.force() == glm::dvec2(0) && device->counts().silences == 1; });
}

TEST(EvdevTransport, EventsThatTheKernelDroppedAreAskedFor) {
  EvdevFake fake;
  const auto device = opened(fake);
  fake.move_unheard(10000, 20000);
  until([&] { return device->sample().counts == glm::ivec2(10000, -20000); });
}

TEST(EvdevTransport, WhileAnotherProgramHasGrabbedTheNodeThePlaceIsAskedFor) {
  EvdevFake fake;
  const auto device = opened(fake);
  for (const int x : {10000, -5000, 300}) {
    fake.move_while_grabbed(x, 2 * x);
    until([&] { return device->sample().counts == glm::ivec2(x, -2 * x); });
  }
  fake.move_to(700, 800);  // the other program has let it go
  until([&] { return device->sample().counts == glm::ivec2(700, -800); });
  fake.move_while_grabbed(-700, 0);
  until([&] { return device->sample().counts == glm::ivec2(-700, 0); });
  EXPECT_FALSE(device->was_lost());
}

TEST(EvdevTransport, AnErasedEffectIsNoticedAlsoWhileTheForceStaysTheSame) {
  EvdevFake fake;
  auto device = opened(fake);
  until([&] {
    device->command({4, 0});
    return is_near(fake.force(), {0.4, 0});
  });
  fake.erase_through_the_same_file(1);
  until([&] {
    device->command({4, 0});
    return device->was_lost();
  });
  EXPECT_EQ(device->reason(), "another program has erased its effects");
  device.reset();
  EXPECT_TRUE(fake.effects().empty());
  device = opened(fake);
  EXPECT_EQ(fake.force(), glm::dvec2(0)) << "set up again from zero";
  until([&] {
    device->command({4, 0});
    return is_near(fake.force(), {0.4, 0});
  });
}

TEST(EvdevTransport, UnpluggedItIsLost) {
  EvdevFake fake;
  const auto device = opened(fake);
  fake.unplug();
  until([&] { return device->was_lost(); });
  EXPECT_EQ(device->sample().contact, Contact::lost);
}

TEST(EvdevTransport, SaysWhyItCannotBeUsed) {
  EvdevFake forceless({.makes_constant_force = false}), placeless({.tells_position = false}), full({.room = 0});
  const auto code_of = [](NodeFake& fake) { return open(fake).error().code; };
  EXPECT_EQ(code_of(forceless), Code::unlike_device);
  EXPECT_EQ(code_of(placeless), Code::unlike_device);
  EXPECT_EQ(code_of(full), Code::unusable_device);
}

TEST(PidTransport, AFileDescriptorOfNoDeviceIsRefused) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const auto reading = transport_of_descriptor(ends[0], NodeFake::ioctl);
  ASSERT_FALSE(reading);
  EXPECT_EQ(reading.error().sentence, "descriptor " + std::to_string(ends[0]) + " is not open for reading and writing");
  EXPECT_EQ(reading.error().mend, "open it with O_RDWR");
  for (const int end : ends) close(end);
  const auto closed = transport_of_descriptor(ends[0], NodeFake::ioctl);
  ASSERT_FALSE(closed);
  EXPECT_EQ(closed.error().code, Code::malformed_value);
  const int null = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  const auto other = transport_of_descriptor(null);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().sentence, "descriptor " + std::to_string(null) + " is of no USB device");
  close(null);
}

TEST(PidTransport, NamesAreReadBack) {
  for (const PidTransportKind kind : transports_by_preference()) EXPECT_EQ(read_transport_kind(in_words(kind)), kind);
  EXPECT_FALSE(read_transport_kind("usb"));
  EXPECT_FALSE(read_transport_kind(""));
}

}  // namespace
}  // namespace wale::test
