#include "runtime/device/falcon/falcon_session.hpp"

#include <gtest/gtest.h>

#include "tests/usb/allocations.hpp"
#include "tests/usb/falcon_bus.hpp"

namespace wale::test::falcon_session {
namespace {

using State = falcon::FalconSession::State;

/// 200 bytes with different values. They make three chunks of 62 bytes and one of 14.
std::vector<std::uint8_t> firmware() {
  std::vector<std::uint8_t> bytes;
  for (int i = 0; i < 200; ++i) bytes.push_back(static_cast<std::uint8_t>(i * 7));
  return bytes;
}

falcon::FalconSessionOptions with_firmware() {
  falcon::FalconSessionOptions options;
  options.firmware = firmware();
  return options;
}

TEST(FalconSession, LoadsFirmwareAsTheProtocolSays) {
  FalconModel model;
  FalconBus bus(model, with_firmware());
  ASSERT_TRUE(bus.run_until([&] { return bus.session.state() == State::running; }));
  EXPECT_EQ(model.firmware, firmware());
  EXPECT_EQ(bus.session.counts().firmware_chunks, 4);
  EXPECT_EQ(bus.most_writes, 1);

  // tests/reference/usb_exchanges.md, Falcon. The driver first tests for firmware: five unanswered packets, no torque.
  const std::string question = "OUT <AAAAAAAAAAAADA>";
  std::vector<std::string> expected{"C 9 00 01", "C 3 00 02", "C 0 00 01", "C 0 00 02"};
  expected.insert(expected.end(), 5, question);
  for (const char* line :
       {"C 0 00 01",    "C 0 00 02",    "C 9 00 10",    "C 3 41 38", "C 4 00 08", "C 2 00 00", "C 1 02 00",
        "C 1 01 00",    "C 1 01 01",    "OUT 0A 43 0D", "C 1 01 00", "C 3 00 15", "OUT 41",    "OUT 62 bytes",
        "OUT 62 bytes", "OUT 62 bytes", "OUT 14 bytes", "C 9 00 01", "C 3 00 02", "C 0 00 01", "C 0 00 02"}) {
    expected.push_back(line);
  }
  ASSERT_GT(model.log.size(), expected.size());
  EXPECT_EQ(std::vector<std::string>(model.log.begin(), model.log.begin() + static_cast<long>(expected.size())),
            expected);
}

TEST(FalconSession, ADeviceThatRunsFirmwareIsNotLoaded) {
  FalconModel model({}, true);
  FalconBus bus(model, {});
  ASSERT_TRUE(bus.run_until([&] { return bus.session.state() == State::running; }));
  EXPECT_EQ(bus.session.counts().firmware_chunks, 0);
  for (const std::string& line : model.log) EXPECT_NE(line, "C 3 41 38");
}

TEST(FalconSession, WithoutAFirmwareFileTheReasonAsksForOne) {
  FalconModel model;
  FalconBus bus(model, {});
  ASSERT_TRUE(bus.run_until([&] { return bus.session.state() == State::over; }));
  EXPECT_TRUE(bus.session.was_lost());
  EXPECT_TRUE(bus.session.wants_firmware());
  EXPECT_EQ(bus.session.reason(), "it runs no firmware");
}

TEST(FalconSession, NothingIsPushedBeforeAllEncodersAreHomed) {
  FalconModel model({}, true);
  model.homes_after = 300;
  FalconBus bus(model, {});
  bus.pump();
  for (int i = 0; i < 200; ++i) {
    bus.frame();
    bus.session.command({1000, 1000, 1000}, bus.now);
    ASSERT_NE(bus.session.state(), State::running);
  }
  EXPECT_EQ(bus.session.state(), State::homing);
  EXPECT_EQ(model.lights, 2) << "red";
  ASSERT_TRUE(bus.run_until([&] { return bus.session.state() == State::running; }));
  for (int i = 0; i < 10; ++i) bus.frame();
  EXPECT_EQ(model.torques, glm::ivec3(0)) << "commands from before homing have no effect";
  EXPECT_EQ(model.lights, 4) << "green";
  bus.session.command({1000, -2000, 4096}, bus.now);
  for (int i = 0; i < 3; ++i) bus.frame();
  EXPECT_EQ(model.torques, glm::ivec3(1000, -2000, 4096));
  EXPECT_EQ(model.torques_before_home, 0);
}

TEST(FalconSession, TenThousandTicksStrictlyInTurns) {
  FalconModel model({}, true);
  model.logs = false;
  FalconBus bus(model, {});
  ASSERT_TRUE(bus.run_until([&] { return bus.session.state() == State::running; }));
  const auto before = bus.session.counts();
  long most_behind = 0;
  for (int tick = 0; tick < 10'000; ++tick) {
    bus.session.command({static_cast<std::int16_t>(tick % 4096), 1, 2}, bus.now);
    bus.frame();
    if (tick > 2) most_behind = std::max<long>(most_behind, (tick % 4096 - model.torques.x + 4096) % 4096);
  }
  const auto after = bus.session.counts();
  EXPECT_EQ(after.answers - before.answers, 10'000) << "a command and its answer in each frame";
  EXPECT_LE(std::abs((after.commands_sent - before.commands_sent) - 10'000), 1);
  EXPECT_LE(most_behind, 1);
  EXPECT_EQ(after.skipped_bytes, 0);
  EXPECT_EQ(model.wrong_packets, 0);
  EXPECT_EQ(bus.most_writes, 1);
}

TEST(FalconSession, RunningAllocatesNothing) {
  FalconModel model({}, true);
  FalconBus bus(model, {});
  ASSERT_TRUE(bus.run_until([&] { return bus.session.state() == State::running; }));
  std::vector<std::uint8_t> answer{1, 0x60};
  for (const char byte : std::string("<AAAAAAAAAAAA\xb1"
                                     "A>"))
    answer.push_back(static_cast<std::uint8_t>(byte));
  falcon::Transfer write, read;  // which the bus has under way
  write.kind = falcon::Transfer::Kind::write;
  read.kind = falcon::Transfer::Kind::read;
  const long before = allocations, answers = bus.session.counts().answers;
  for (int i = 0; i < 1000; ++i) {
    bus.session.finish(write, Outcome::done, {}, bus.now);
    bus.session.finish(read, Outcome::done, answer, bus.now);
    bus.session.command({1, 2, 3}, bus.now);
    while (bus.session.next(++bus.now)) {
    }
  }
  EXPECT_EQ(allocations, before);
  EXPECT_EQ(bus.session.counts().answers, answers + 1000);
}

TEST(FalconSession, WithoutCommandsTheTorqueEnds) {
  FalconModel model({}, true);
  FalconBus bus(model, {});
  ASSERT_TRUE(bus.run_until([&] { return bus.session.state() == State::running; }));
  bus.session.command({500, 500, 500}, bus.now);
  for (int i = 0; i < 40; ++i) bus.frame();
  EXPECT_EQ(model.torques, glm::ivec3(500));
  for (int i = 0; i < 20; ++i) bus.frame();
  EXPECT_EQ(model.torques, glm::ivec3(0));
  EXPECT_EQ(bus.session.counts().command_silences, 1);
  bus.session.command({7, 0, 0}, bus.now);
  for (int i = 0; i < 3; ++i) bus.frame();
  EXPECT_EQ(model.torques, glm::ivec3(7, 0, 0));
}

TEST(FalconSession, LeavesWithoutTorque) {
  FalconModel model({}, true);
  FalconBus bus(model, {});
  ASSERT_TRUE(bus.run_until([&] { return bus.session.state() == State::running; }));
  bus.session.command({500, 500, 500}, bus.now);
  for (int i = 0; i < 5; ++i) bus.frame();
  bus.session.stop();
  ASSERT_TRUE(bus.run_until([&] { return bus.session.state() == State::over; }, 50));
  EXPECT_FALSE(bus.session.was_lost());
  EXPECT_EQ(model.torques, glm::ivec3(0));
  EXPECT_EQ(model.lights, 0);
  EXPECT_EQ(model.log.back(), "OUT <AAAAAAAAAAAAAA>");
  EXPECT_EQ(model.log[model.log.size() - 2], model.log.back());
}

TEST(FalconSession, AStopAtAnyStepLeavesNoTorque) {
  for (int frames = 0; frames < 400; frames += 7) {
    FalconModel model;
    FalconBus bus(model, with_firmware());
    bus.pump();
    for (int i = 0; i < frames; ++i) {
      bus.frame();
      bus.session.command({900, 900, 900}, bus.now);
    }
    bus.session.stop();
    ASSERT_TRUE(bus.run_until([&] { return bus.session.state() == State::over; }, 500)) << frames;
    EXPECT_EQ(model.torques, glm::ivec3(0)) << frames;
  }
}

TEST(FalconSession, AnUnpluggedDeviceEndsTheSessionAtOnce) {
  FalconModel model({}, true);
  FalconBus bus(model, {});
  ASSERT_TRUE(bus.run_until([&] { return bus.session.state() == State::running; }));
  bus.unplug();
  EXPECT_EQ(bus.session.state(), State::over);
  EXPECT_TRUE(bus.session.was_lost());
  EXPECT_EQ(bus.session.reason(), "it was unplugged");
}

TEST(FalconSession, ToleratesMissingAndTruncatedAnswers) {
  FalconModel model({.swallow = 10, .cut = 17}, true);
  FalconBus bus(model, {});
  ASSERT_TRUE(bus.run_until([&] { return bus.session.state() == State::running; }));
  for (int i = 0; i < 2000; ++i) {
    bus.session.command({100, 100, 100}, bus.now);
    bus.frame();
    ASSERT_EQ(bus.session.state(), State::running);
  }
  EXPECT_GT(bus.session.counts().silences, 20);
  EXPECT_GT(bus.session.counts().skipped_bytes, 20);
  EXPECT_EQ(model.torques, glm::ivec3(100));
}

TEST(FalconSession, GreetingMayComeInPieces) {
  FalconModel model({.says_more_first = true});
  FalconBus bus(model, with_firmware());
  ASSERT_TRUE(bus.run_until([&] { return bus.session.state() == State::homing; }));
  EXPECT_EQ(model.firmware, firmware());
}

TEST(FalconSession, EachFaultHasItsReasonAndEndsWithoutTorque) {
  struct Case {
    FalconFaults faults;
    bool runs = false;
    const char* reason = "";
  };
  const Case cases[] = {
      {{.has_no_loader = true}, false, "its loader does not answer"},
      {{.wrong_echo_at = 100}, false, "its loader does not repeat what it is given"},
      {{.firmware_is_dead = true}, false, "it does not answer with this firmware"},
      {{.refuses_controls = true}, true, "it refuses to be set up"},
      {{.deaf = true}, true, "it does not answer in time"},
      {{.stall_after = 0}, true, "it takes no packets"},
      {{.mute_after = 100}, true, "it does not answer in time"},
      {{.nonsense_after = 100}, true, "what it answers is nonsense"},
      {{.unhomed_after = 100}, true, "its encoders have lost their zeros"},
      {{.stall_after = 100}, true, "it takes no packets"},
  };
  for (const Case& fault : cases) {
    FalconModel model(fault.faults, fault.runs);
    FalconBus bus(model, with_firmware());
    bus.pump();
    for (int i = 0; i < 10'000 && bus.session.state() != State::over; ++i) {
      bus.frame();
      bus.session.command({300, 300, 300}, bus.now);
    }
    EXPECT_EQ(bus.session.state(), State::over) << fault.reason;
    EXPECT_EQ(bus.session.reason(), fault.reason);
    // A device that takes no more packets cannot be told to release its motors.
    if (fault.faults.stall_after < 0) {
      EXPECT_EQ(model.torques, glm::ivec3(0)) << fault.reason;
    }
  }
}

}  // namespace
}  // namespace wale::test::falcon_session
