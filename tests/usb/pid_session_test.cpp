#include "runtime/device/hid_pid/pid_session.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/usb/pid_bus.hpp"

namespace wale::test {
namespace {

using hid::Arrangement;
using State = hid::PidSession::State;

constexpr double tick_time = 1e6 / 900;  // microseconds

/// A force that changes on both axes in every tick, within full force.
glm::dvec2 wandering(long tick) {
  const auto t = static_cast<double>(tick);
  return {0.6 * std::sin(0.37 * t), 0.6 * std::cos(0.29 * t)};
}

/// Runs ticks of 900 Hz over the frames of the bus. `force_at(tick)` is commanded.
template <class ForceAt>
void run_ticks(PidBus& bus, long ticks, ForceAt force_at) {
  const std::int64_t start = bus.now;
  for (long tick = 0; tick < ticks; ++tick) {
    const std::int64_t at = start + static_cast<std::int64_t>(static_cast<double>(tick + 1) * tick_time);
    while (bus.now + PidBus::frame_time <= at) bus.frame();
    bus.command(force_at(tick), at);
  }
}

int sent_counts(const PidBus::Sent& sent) {
  return static_cast<std::int16_t>(sent.packet.bytes[2] | sent.packet.bytes[3] << 8);
}

double tolerance(const PidFamily& family) {
  // A count of magnitude, and what a direction of 255 steps cannot say.
  return 1.0 / family.magnitude_maximum + (family.direction_maximum < 1000 ? 0.02 : 1e-3);
}

TEST(PidSession, SetsUpOpenFFBoardByteForByte) {
  PidModel model(openffboard());
  PidBus bus(model);
  bus.settle();
  ASSERT_EQ(bus.session.state(), State::running) << bus.session.reason();
  // tests/reference/usb_exchanges.md, OpenFFBoard, with finite durations: 200 ms, once.
  EXPECT_EQ(
      model.log,
      (std::vector<std::string>{
          "GET 13", "OUT 0C 08", "OUT 0C 01", "OUT 0D FF", "SET 11 01 00 00", "GET 12", "SET 11 01 00 00", "GET 12",
          "OUT 01 01 01 C8 00 00 00 00 00 00 00 FF 00 04 28 23 00 00", "OUT 05 01 00 00", "OUT 0A 01 01 01",
          "OUT 01 02 01 C8 00 00 00 00 00 00 00 FF 00 04 50 46 00 00", "OUT 05 02 00 00", "OUT 0A 02 01 01"}));
  EXPECT_EQ(bus.session.arrangement(), Arrangement::by_direction);
  EXPECT_EQ(model.wrong_reports, 0);
}

TEST(PidSession, EffectsAreEndlessOnRequest) {
  PidModel model(openffboard());
  PidBus bus(model, {.effect_duration = hid::endless});
  bus.settle();
  EXPECT_EQ(model.log[8], "OUT 01 01 01 FF FF 00 00 00 00 00 00 FF 00 04 28 23 00 00");
  EXPECT_EQ(model.log[10], "OUT 0A 01 01 FF");
  for (int i = 0; i < 2000; ++i) bus.frame();
  EXPECT_EQ(bus.session.counts().refreshes, 0);
}

TEST(PidSession, StopsByteForByte) {
  PidModel model(openffboard());
  PidBus bus(model);
  bus.settle();
  run_ticks(bus, 10, wandering);
  bus.session.stop();
  for (int i = 0; i < 3; ++i) bus.frame();  // packets under way arrive first
  model.log.erase(model.log.begin(), model.log.end() - 1);
  bus.settle();
  const std::vector<std::string> leaving{"OUT 05 01 00 00", "OUT 05 02 00 00", "OUT 0A 01 03 00",
                                         "OUT 0A 02 03 00", "OUT 0C 04",       "OUT 0B 01",
                                         "OUT 0B 02",       "OUT 0C 08",       "OUT 0C 02"};
  ASSERT_GE(model.log.size(), leaving.size());
  EXPECT_EQ(std::vector<std::string>(model.log.end() - 9, model.log.end()), leaving);
  EXPECT_EQ(bus.session.state(), State::over);
  EXPECT_FALSE(bus.session.was_lost());
  EXPECT_EQ(model.force(), glm::dvec2(0));
  EXPECT_FALSE(model.is_enabled);
  EXPECT_EQ(model.wrong_reports, 0);
}

TEST(PidSession, TenThousandTicksOfEachFamily) {
  for (const PidFamily& family : all_families()) {
    PidModel model(family);
    model.logs = false;
    PidBus bus(model);
    bus.settle();
    ASSERT_EQ(bus.session.state(), State::running) << family.name << ": " << bus.session.reason();
    const long before = model.outputs;
    const std::int64_t start = bus.now;
    run_ticks(bus, 10'000, wandering);
    for (const PidBus::Sent& sent : bus.forces) {  // only the newest command ever goes out
      const double wanted = sent.packet.bytes[1] == 1 ? sent.newest.x : sent.newest.y;
      ASSERT_LT(std::abs(sent_counts(sent) - wanted * family.magnitude_maximum), 1) << family.name;
      ASSERT_LE(std::abs(sent_counts(sent)), std::abs(wanted) * family.magnitude_maximum * (1 + 2e-6))
          << "rounded toward zero";
    }
    const auto& counts = bus.session.counts();
    EXPECT_EQ(model.wrong_reports, 0) << family.name;
    // Each period has one packet: a force, or a refresh that keeps an effect playing.
    const std::int64_t frames = (bus.now - start) / PidBus::frame_time;
    EXPECT_NEAR(static_cast<double>(counts.forces_sent[0] + counts.forces_sent[1] + counts.refreshes),
                static_cast<double>(model.outputs - before), 2)
        << family.name;
    EXPECT_LE(model.outputs - before, frames);
    EXPECT_GE(model.outputs - before, 9900) << family.name;
    EXPECT_LE(std::abs(counts.forces_sent[0] - counts.forces_sent[1]), family.magnitude_maximum > 1000 ? 10 : 400);
    EXPECT_EQ(counts.refreshes, 2 * (frames / 67)) << "each effect, each third of 200 ms, whole frames";
    EXPECT_EQ(counts.inputs, model.inputs);
    EXPECT_EQ(counts.bad_inputs, 0);
    EXPECT_LE(bus.most_in_flight, 2u);

    // When the command no longer changes, the device exerts it.
    run_ticks(bus, 5, [](long) { return glm::dvec2(0.5, -0.25); });
    EXPECT_NEAR(model.force().x, 0.5, tolerance(family)) << family.name;
    EXPECT_NEAR(model.force().y, -0.25, tolerance(family)) << family.name;
  }
}

TEST(PidSession, AxesAlternate) {
  PidModel model(openffboard());
  PidBus bus(model);
  bus.settle();
  run_ticks(bus, 1000, wandering);
  ASSERT_GT(bus.forces.size(), 900u);
  for (std::size_t i = 1; i < bus.forces.size(); ++i) {
    ASSERT_NE(bus.forces[i].packet.bytes[1], bus.forces[i - 1].packet.bytes[1]) << i;
  }
}

TEST(PidSession, AnAxisAloneHasAllPackets) {
  PidModel model(openffboard());
  PidBus bus(model);
  bus.settle();
  run_ticks(bus, 900, [](long tick) { return glm::dvec2(wandering(tick).x, 0); });
  EXPECT_GT(bus.session.counts().forces_sent[0], 850);
  EXPECT_EQ(bus.session.counts().forces_sent[1], 0);
}

TEST(PidSession, ANewerCommandReplacesThePendingOne) {
  PidModel model(openffboard());
  PidBus bus(model);
  bus.settle();
  for (int i = 0; i < 100; ++i) {  // faster than frames
    bus.command({0.001 * i, -0.001 * i}, bus.now);
  }
  EXPECT_EQ(bus.forces.size(), 2u) << "at most two are under way, and none queue behind them";
  EXPECT_EQ(bus.session.counts().overwritten, 97) << "all except the two sent and the one waiting";
  for (int i = 0; i < 4; ++i) bus.frame();
  EXPECT_NEAR(model.force().x, 0.099, 1e-4);
  EXPECT_NEAR(model.force().y, -0.099, 1e-4);
}

TEST(PidSession, ASwapLeavesNothingOfTheOldForce) {
  PidModel model(openffboard());
  PidBus bus(model);
  bus.settle();
  run_ticks(bus, 500, [](long tick) { return glm::dvec2(0.5) + 0.1 * wandering(tick); });
  const std::size_t before = bus.forces.size();
  run_ticks(bus, 500, [](long tick) { return glm::dvec2(-0.5) + 0.1 * wandering(tick); });
  for (std::size_t i = before; i < bus.forces.size(); ++i) {
    // The frame between the two has the other axis's old force, at most.
    if (i > before + 1) {
      ASSERT_LT(sent_counts(bus.forces[i]), 0) << i;
    }
  }
}

TEST(PidSession, EffectsEndWithoutFurtherPackets) {
  for (const PidFamily& family : all_families()) {
    PidModel model(family);
    PidBus bus(model);
    bus.settle();
    run_ticks(bus, 2000, [](long) { return glm::dvec2(0.5, 0.5); });
    EXPECT_NEAR(model.force().x, 0.5, tolerance(family)) << "refreshes keep the force beyond the effect's duration";
    for (int i = 0; i < 249; ++i) model.step();  // the process is killed: no frame has a packet any more
    for (int i = 0; i < 2; ++i) model.step();
    EXPECT_EQ(model.force(), glm::dvec2(0)) << family.name;
  }
}

TEST(PidSession, TheForceEndsWhenTheLoopHangs) {
  PidModel model(openffboard());
  PidBus bus(model);
  bus.settle();
  run_ticks(bus, 100, [](long) { return glm::dvec2(0.5, 0.5); });
  for (int i = 0; i < 49; ++i) bus.frame();
  EXPECT_NEAR(model.force().x, 0.5, 1e-3);
  for (int i = 0; i < 6; ++i) bus.frame();
  EXPECT_EQ(model.force(), glm::dvec2(0));
  EXPECT_EQ(bus.session.counts().silences, 1);
  run_ticks(bus, 400, [](long) { return glm::dvec2(0.25, 0); });
  EXPECT_NEAR(model.force().x, 0.25, 1e-3) << "the force returns with the loop";
}

TEST(PidSession, WithoutDirectionsEachAxisIsEnabled) {
  PidFamily family = arduino();
  family.has_direction = false;
  PidModel model(family);
  PidBus bus(model);
  bus.settle();
  ASSERT_EQ(bus.session.state(), State::running) << bus.session.reason();
  EXPECT_EQ(bus.session.arrangement(), Arrangement::by_axis);
  run_ticks(bus, 5, [](long) { return glm::dvec2(0.5, -0.25); });
  EXPECT_NEAR(model.force().x, 0.5, 1e-4);
  EXPECT_NEAR(model.force().y, -0.25, 1e-4);
}

TEST(PidSession, ASingleEffectChangesItsDirection) {
  const auto check = [](PidModel& model) {
    PidBus bus(model);
    bus.settle();
    ASSERT_EQ(bus.session.state(), State::running) << bus.session.reason();
    EXPECT_EQ(in_words(bus.session.arrangement()), "one effect, turned to the direction of the force");
    for (const glm::dvec2 force : {glm::dvec2(0.5, -0.25), glm::dvec2(-0.5, 0.25), glm::dvec2(0, 0.7), glm::dvec2(0),
                                   glm::dvec2(-0.1, -0.1), glm::dvec2(0.9, 0.9)}) {
      run_ticks(bus, 6, [&](long) { return force; });
      const double longer = std::max(1.0, std::hypot(force.x, force.y));
      EXPECT_NEAR(model.force().x, force.x / longer, 2e-4);
      EXPECT_NEAR(model.force().y, force.y / longer, 2e-4);
    }
    const long turns = bus.session.counts().directions_sent;
    run_ticks(bus, 100, [](long tick) { return wandering(tick).x * glm::dvec2(0.6, 0.8); });
    EXPECT_LE(bus.session.counts().directions_sent, turns + 1) << "a force along a line needs no new direction";
    EXPECT_EQ(model.wrong_reports, 0);
  };
  PidFamily one = openffboard();
  one.simultaneous = 1;
  PidModel says_so(one);
  check(says_so);
  PidModel is_full(openffboard(), {.room = 1});
  check(is_full);
}

TEST(PidSession, UnpluggedAndReplugged) {
  PidModel model(openffboard());
  PidBus bus(model);
  bus.settle();
  run_ticks(bus, 1000, wandering);
  bus.unplug();
  EXPECT_EQ(bus.session.state(), State::over);
  EXPECT_TRUE(bus.session.was_lost());
  EXPECT_EQ(bus.session.reason(), "it was unplugged");
  EXPECT_FALSE(bus.session.next(bus.now)) << "nothing is sent to an unplugged device";

  PidModel again(openffboard());
  PidBus second(again);
  second.settle();
  ASSERT_EQ(second.session.state(), State::running);
  run_ticks(second, 1000, wandering);
  EXPECT_GT(second.session.counts().forces_sent[0], 400);
  EXPECT_EQ(again.wrong_reports, 0);
}

TEST(PidSession, UnpluggedAtEveryStepOfSettingUpAndLeaving) {
  for (int frames = 0; frames < 24; ++frames) {
    PidModel model(openffboard());
    PidBus bus(model);
    bus.pump();
    for (int i = 0; i < frames; ++i) bus.frame();
    bus.session.stop();
    bus.pump();
    for (int i = 0; i < frames % 7; ++i) bus.frame();
    bus.unplug();
    bus.pump();
    EXPECT_EQ(bus.session.state(), State::over) << frames;
  }
}

TEST(PidSession, StoppedAtEveryStepOfSettingUp) {
  for (int frames = 0; frames < 24; ++frames) {
    PidModel model(openffboard());
    PidBus bus(model);
    bus.pump();
    for (int i = 0; i < frames; ++i) bus.frame();
    const auto was = bus.session.state();
    bus.session.stop();
    bus.settle();
    bus.settle();
    EXPECT_EQ(bus.session.state(), State::over) << frames;
    EXPECT_FALSE(bus.session.was_lost());
    EXPECT_FALSE(model.is_enabled);
    EXPECT_EQ(model.wrong_reports, 0);
    for (const PidModel::Effect& effect : model.effects) EXPECT_FALSE(effect.plays) << frames;
    if (bus.session.layout()) {
      EXPECT_EQ(std::count(model.log.begin(), model.log.end(), "OUT 0C 04"), 1) << frames;
      EXPECT_EQ(model.log.back(), "OUT 0C 02") << frames;
    }
    EXPECT_TRUE(frames < 23 || was == State::running) << "all of setting up is covered";
  }
}

TEST(PidSession, TwoDevicesAreIndependent) {
  PidModel left(openffboard()), right(rhino());
  PidBus first(left), second(right);
  for (int i = 0; i < 40; ++i) {
    first.pump(), second.pump();
    first.frame(), second.frame();
  }
  for (long tick = 0; tick < 2000; ++tick) {
    first.command({0.5, 0}, first.now);
    second.command({0, -0.5}, second.now);
    first.frame(), second.frame();
    if (tick == 1000) first.unplug();
  }
  EXPECT_TRUE(first.session.was_lost());
  EXPECT_EQ(second.session.state(), State::running);
  EXPECT_NEAR(right.force().y, -0.5, 0.02);
  EXPECT_EQ(left.wrong_reports + right.wrong_reports, 0);
}

TEST(PidSession, InputIsThePositionOfTheStick) {
  for (const PidFamily& family : all_families()) {
    PidModel model(family);
    PidBus bus(model);
    bus.settle();
    run_ticks(bus, 300, [](long) { return glm::dvec2(0.3, -0.2); });
    ASSERT_TRUE(bus.session.input());
    EXPECT_NEAR(static_cast<double>(bus.session.input()->x), model.position().x / 0.1 * 32767, 1) << family.name;
    EXPECT_NEAR(static_cast<double>(bus.session.input()->y), -model.position().y / 0.1 * 32767, 1) << family.name;
  }
}

// Devices that break the protocol.

/// Sets up and runs a session. Returns the reason for its loss, and the force that is left.
struct Ending {
  std::string reason;
  glm::dvec2 force;
  State state;
};

Ending ending_of(PidModel& model, long ticks = 1000, std::uint16_t descriptor_bytes = 0) {
  PidBus bus(model, {}, descriptor_bytes);
  bus.settle();
  if (bus.session.state() == State::running) run_ticks(bus, ticks, [](long) { return glm::dvec2(0.5, 0.5); });
  bus.settle();
  return {std::string(bus.session.reason()), model.force(), bus.session.state()};
}

void expect_ending(const Faults& faults, const std::string& reason) {
  for (const PidFamily& family : all_families()) {
    PidModel model(family, faults);
    const Ending ending = ending_of(model);
    EXPECT_EQ(ending.reason, reason) << family.name;
    EXPECT_EQ(ending.force, glm::dvec2(0)) << family.name << ": " << reason;
    EXPECT_EQ(ending.state, State::over) << family.name;
  }
}

TEST(PidFaults, Stalls) {
  expect_ending({.stall_outputs_after = 20}, "it refuses a report that its descriptor declares");
  expect_ending({.stall_outputs_after = 1}, "it refuses a report that its descriptor declares");
}

TEST(PidFaults, AnswersLate) {
  expect_ending({.silent_outputs_after = 20}, "it does not answer in time");
  expect_ending({.silent = true}, "it does not answer in time");
}

TEST(PidFaults, AnswersNonsense) {
  expect_ending({.bad_inputs_after = 500}, "its input reports do not match its descriptor");
  expect_ending({.same_block = true}, "its answer about a new effect is malformed");
  expect_ending({.block_zero = true}, "its answer about a new effect is malformed");
}

TEST(PidFaults, SendsShortPackets) {
  expect_ending({.short_inputs_after = 500}, "its input reports do not match its descriptor");
  expect_ending({.short_load = true}, "its answer about a new effect is malformed");
}

TEST(PidFaults, HasNoRoom) {
  expect_ending({.room = 0}, "it has no room for an effect: another program may hold them");
  PidFamily family = arduino();
  family.has_direction = false;
  PidModel model(family, {.room = 1});
  EXPECT_EQ(ending_of(model).reason, "it has room for one effect only, and its effects have no direction");
}

TEST(PidFaults, NeverConfirmsAnEffect) {
  PidModel soon(openffboard(), {.pending_loads = 5}), never(openffboard(), {.pending_loads = 1000});
  EXPECT_EQ(ending_of(soon).reason, "");
  EXPECT_EQ(ending_of(never).reason, "it does not report whether it has created an effect");
}

TEST(PidFaults, FallsSilent) {
  // A device that reports only changes still answers or refuses a question. A dead device does neither.
  PidModel asked(openffboard(), {.no_inputs_after = 100}),
      refuses(openffboard(), {.no_inputs_after = 100, .stalls_polls = true});
  EXPECT_EQ(ending_of(asked).reason, "");
  EXPECT_GT(asked.polls, 5);
  EXPECT_EQ(ending_of(refuses).reason, "");
  expect_ending({.no_inputs_after = 100, .deaf_to_polls = true}, "it does not answer in time");
}

TEST(PidFaults, AFewBadInputsAreForgiven) {
  PidModel model(openffboard());
  PidBus bus(model);
  bus.settle();
  run_ticks(bus, 100, wandering);
  const auto input = bus.session.input();
  for (int i = 0; i < 7; ++i) bus.session.receive(from_hex("01 02"), bus.now);
  EXPECT_EQ(bus.session.state(), State::running);
  EXPECT_EQ(bus.session.input()->x, input->x) << "the last good report stays valid";
  bus.session.receive(from_hex("02 13 00"), bus.now);  // PID state is a report of its own
  EXPECT_EQ(bus.session.counts().other_reports, 1);
  bus.session.receive(from_hex("01 02"), bus.now);
  EXPECT_TRUE(bus.session.was_lost());
}

/// PID State of OpenFFBoard: 12 says that actuators are enabled and powered, 10 only the latter.
TEST(PidRivals, AnOldStateIsFromOurOwnSetUp) {
  PidModel model(openffboard());
  PidBus bus(model, {.is_shared = true});
  bus.settle();
  for (const char* old : {"02 12 00", "02 10 00", "02 12 00"}) {
    bus.session.receive(from_hex(old), bus.now, true);
    EXPECT_EQ(bus.session.state(), State::running) << old;
  }
  bus.session.receive(from_hex("02 10 00"), bus.now);
  EXPECT_TRUE(bus.session.was_lost()) << "the last old state said that they were enabled";
}

TEST(PidFaults, HasAFalseDescriptor) {
  PidModel model(openffboard());
  EXPECT_EQ(ending_of(model, 10, static_cast<std::uint16_t>(model.descriptor.size() + 10)).reason,
            "its report descriptor is cut short");
  model.descriptor.pop_back();
  EXPECT_EQ(ending_of(model).reason, "its report descriptor is damaged at byte " +
                                         std::to_string(model.descriptor.size()) + ": a collection is not ended");
  model.descriptor = from_hex("05 01 09 04 A1 01 09 30 15 00 25 7F 75 08 95 01 81 02 C0");
  EXPECT_EQ(ending_of(model).reason, "it is not a force device: nothing in its report descriptor is of usage page 0F");
}

}  // namespace
}  // namespace wale::test
