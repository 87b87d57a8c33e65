// Recordings: their content, and that a replay gives the same forces bit for bit.

#include "wale/recording.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <functional>

#include "runtime/record/record_writer.hpp"
#include "runtime/stage/player.hpp"
#include "tests/runtime/placed.hpp"
#include "tests/runtime/programs.hpp"
#include "tests/runtime/recorded.hpp"
#include "tests/schema/example_program.hpp"
#include "wale/simulated.hpp"
#include "wale/simulated_pad.hpp"

namespace wale::recording_test {
namespace {

using namespace recorded;
using namespace recording_format;

TEST(Recording, HoldsTheRun) {
  const TemporaryFolder folder;
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Circular{0.075, 1, {0.03, 0}});
  Stage stage(joystick, {.max_force = 1.5, .record = RecordTo{folder / "a.wrec", "simulated, circular"}});
  Patch patch = *stage.add(corduroy(1.934f), {.at = {0.001f, 0}});
  ASSERT_TRUE(patch.set("wale", 0.003f));
  const RunResult done = run(stage, {.seconds = 7, .virtual_time = true});
  EXPECT_FALSE(done.record_problem);
  const Recording recording = opened(folder / "a.wrec");
  EXPECT_EQ(recording.header().device, sandpaper());
  EXPECT_EQ(recording.header().most_newton, 1.5);
  EXPECT_TRUE(recording.header().virtual_time);
  EXPECT_EQ(recording.header().hand, "simulated, circular");
  EXPECT_TRUE(recording.complete());
  ASSERT_EQ(recording.ticks(), 6300u);
  long limited = 0, slewed = 0;
  for (std::size_t i = 0; i < recording.ticks(); ++i) {
    const RecordedTick tick = recording.tick(i);
    const TickRecord& kept = done.record.ticks[i];
    ASSERT_EQ(tick.period, static_cast<long>(i));
    ASSERT_EQ(tick.elapsed, i == 0 ? 0u : 1u);
    ASSERT_EQ(glm::vec2(glm::dvec2(tick.counts) * sandpaper().position_step()), kept.position);
    ASSERT_EQ(tick.velocity, kept.velocity);
    ASSERT_EQ(tick.force, kept.force);
    ASSERT_EQ(tick.interaction, kept.interaction);
    ASSERT_EQ(tick.inside, kept.inside);
    ASSERT_EQ(tick.patch, kept.inside ? 0u : RecordedTick::no_patch);
    ASSERT_EQ(tick.revision, 1u);
    limited += (tick.guards & static_cast<std::uint32_t>(GuardBit::user_limit)) != 0;
    slewed += (tick.guards & static_cast<std::uint32_t>(GuardBit::slew)) != 0;
  }
  EXPECT_EQ(limited, done.guards.user_limit);
  EXPECT_EQ(slewed, done.guards.slew);
  EXPECT_GT(limited, 0);
  ASSERT_EQ(recording.programs().size(), 1u);
  EXPECT_TRUE(
      std::ranges::equal(recording.programs()[0].bytes, write_patch_program(patch.bank()->program().description())));
  ASSERT_EQ(recording.events().size(), 3u);
  EXPECT_EQ(recording.events()[0].kind, RecordedEvent::Kind::put);
  EXPECT_EQ(recording.events()[0].position, glm::vec2(0.001f, 0));
  EXPECT_EQ(recording.events()[0].parameters, std::vector<float>{0.003f});
  EXPECT_EQ(recording.events()[1].kind, RecordedEvent::Kind::publish);
  EXPECT_EQ(recording.events()[2].kind, RecordedEvent::Kind::end);
  expect_same(recording);
}

TEST(Recording, ReplaysPatchesParametersAndSwapsAtTheirTicks) {
  const TemporaryFolder folder;
  Puppet device(roaming);
  Stage stage(device, {.record = RecordTo{folder / "a.wrec", {}}});
  Patch patch = *stage.add(corduroy(1.934f));
  Patch another =
      *stage.add(bead(500), {.at = {0.02f, 0}, .size = PatchSize{.width = 0.05f, .height = 0.04f}, .layer = 1});
  Patch third =
      *stage.add(oil(3), {.at = {-0.05f, 0.01f}, .size = PatchSize{.width = 0.06f, .height = 0.06f}, .layer = 1});
  Patch fourth;
  const auto act = [&](const Now& now) {
    const auto done = [](const Result<>& result) { EXPECT_TRUE(result) << in_words(result.error()); };
    const long deed = now.ticks_run / 90;
    if (deed == 60) {
      StageEdit edit = stage.edit();
      for (const Patch& each : {patch, another, third}) edit.remove(each);
      if (fourth.exists()) edit.remove(fourth);
      patch = *edit.add(bead(100), {.at = {0.01f, 0.005f}, .size = PatchSize{.width = 0.1f, .height = 0.1f}});
      done(edit.commit());
    }
    if (deed == 70) done(patch.replace(spring(30)));
    if (deed >= 60) return;
    if (deed % 3 == 0) done(patch.set("wale", 0.001f + 0.0001f * static_cast<float>(deed % 40)));
    if (deed % 7 == 0) done(another.replace(bead(300 + static_cast<float>(deed))));
    if (deed % 7 == 0) done(another.replace(bead(301 + static_cast<float>(deed))));  // twice before a tick
    if (deed == 20) done(third.replace(spring(40)));
    if (deed == 21) done(third.set("stiffness", 60));
    if (deed == 40) fourth = *stage.add(push(1.5f), {.size = PatchSize{.width = 0.01f, .height = 0.2f}, .layer = 2});
  };
  const RunResult done = run(stage, {.seconds = 9, .virtual_time = true, .progress = act});
  const Recording recording = opened(folder / "a.wrec");
  std::uint32_t revision = 1;
  long sets = 0, swaps = 0;
  for (const RecordedEvent& event : recording.events()) {
    sets += event.kind == RecordedEvent::Kind::set;
    swaps += event.kind == RecordedEvent::Kind::put && event.renewed && event.ticks > 0;
    if (event.kind != RecordedEvent::Kind::publish || event.revision == 1) continue;
    ++revision;
    ASSERT_LT(event.ticks, recording.ticks());
    EXPECT_EQ(event.ticks % 90, 0u);
    EXPECT_EQ(recording.tick(event.ticks).revision, revision) << "active in the next tick";
    EXPECT_EQ(recording.tick(event.ticks - 1).revision, revision - 1);
  }
  EXPECT_EQ(sets, 19 + 1);
  EXPECT_EQ(swaps, 8 + 2 + 2) << "replaced every 7 progresses, twice otherwise; and two patches were added";
  std::vector<long> under(5);
  for (std::size_t i = 0; i < recording.ticks(); ++i)
    if (recording.tick(i).inside) ++under.at(recording.tick(i).patch);
  for (const long ticks : under) EXPECT_GT(ticks, 50);
  EXPECT_GT(done.guards.slew, 100);
  expect_same(recording);
}

TEST(Recording, ReplaysStaleAndLostDevicesAndEveryGuard) {
  const TemporaryFolder folder;
  Puppet device([](long sample) {
    Reading reading = roaming(sample);
    if (sample % 1000 > 990) reading.contact = Contact::stale;
    if (sample > 3000 && sample < 3100) reading.contact = Contact::lost;
    return reading;
  });
  device.profile_.force_newton = 3;
  Stage stage(device, {.max_force = 2.5, .record = RecordTo{folder / "a.wrec", {}}});
  // A spring above the user's limit and too stiff for the device, a source of energy, and a force that is not a number.
  Assembly none({2, 0});
  const RegisterNumber state = none.state("state", -1, 1);
  none.evolve(state, none.constant(1), none.tick(Operation::divide, none.constant(1), none.constant(1)));
  none.push(0, none.tick(Operation::multiply, none.constant(0), state), none.constant(0));
  none.push(1, none.constant(1), none.constant(0));
  none.program.device = device.profile_;
  Patch patch = *stage.add(built_for(spring(8000, 2.9f), device.profile_));
  Patch another = *stage.add(built_for(oil(-8, 2.9f), device.profile_),
                             {.at = {0.03f, 0}, .size = PatchSize{.width = 0.06f, .height = 0.16f}, .layer = 1});
  Patch nothing =
      *stage.add(none.load(), {.at = {-0.05f, 0}, .size = PatchSize{.width = 0.02f, .height = 0.16f}, .layer = 1});
  const RunResult done = run(stage, {.seconds = 8, .virtual_time = true});
  EXPECT_EQ(done.guards.lost, 99);
  EXPECT_GT(done.guards.stale, 0);
  EXPECT_GT(done.guards.user_limit, 0);
  EXPECT_GT(done.guards.energy, 0);
  EXPECT_GT(done.guards.passivity, 0);
  EXPECT_GT(done.guards.restored, 0);
  const Recording recording = opened(folder / "a.wrec");
  for (const auto& [guard, count] : {std::pair{GuardBit::lost, done.guards.lost},
                                     {GuardBit::stale, done.guards.stale},
                                     {GuardBit::energy, done.guards.energy},
                                     {GuardBit::passivity, done.guards.passivity}}) {
    long ticks = 0;
    for (std::size_t i = 0; i < recording.ticks(); ++i)
      ticks += (recording.tick(i).guards & static_cast<std::uint32_t>(guard)) != 0;
    EXPECT_EQ(ticks, count) << static_cast<int>(guard);
  }
  expect_same(recording);
}

TEST(Recording, ReplaysMovesAndHotMotors) {
  const TemporaryFolder folder;
  Puppet device(roaming);
  device.profile_.continuous_newton = 0.5;
  device.profile_.heating_seconds = 1;
  Stage stage(device, {.record = RecordTo{folder / "a.wrec", {}}});
  Patch patch = *stage.add(spring(200, 2));
  Patch another = *stage.add(push(1.5f), {.size = PatchSize{.width = 0.04f, .height = 0.04f}, .layer = 1});
  long moves = 0;
  RunOptions options{.seconds = 8, .virtual_time = true};
  options.progress = [&](const Now&) {
    ++moves;
    ASSERT_TRUE(another.move({0.03f * std::sin(0.5f * static_cast<float>(moves)), 0}));
  };
  const RunResult done = run(stage, options);
  EXPECT_GT(done.guards.heat, 0);
  const Recording recording = opened(folder / "a.wrec");
  EXPECT_EQ(std::ranges::count(recording.events(), RecordedEvent::Kind::move, &RecordedEvent::kind), moves - 1)
      << "no tick came after the last";
  long hot = 0;
  std::vector<long> under(2);
  for (std::size_t i = 0; i < recording.ticks(); ++i) {
    const RecordedTick tick = recording.tick(i);
    hot += (tick.guards & static_cast<std::uint32_t>(GuardBit::heat)) != 0;
    if (tick.inside) ++under.at(tick.patch);
  }
  EXPECT_EQ(hot, done.guards.heat);
  for (const long ticks : under) EXPECT_GT(ticks, 50);
  expect_same(recording);
}

TEST(Recording, ReplaysPads) {
  const TemporaryFolder folder;
  const Program ribs = *Program::load(example::pad(PositionSource::touch));
  SimulatedPad pad(ribs.description().device, Lateral{0.02, 1});
  Stage stage(pad, {.record = RecordTo{folder / "a.wrec", {}}});
  Patch patch = *stage.add(ribs);
  run(stage, {.seconds = 2, .virtual_time = true});
  const Recording recording = opened(folder / "a.wrec");
  EXPECT_EQ(recording.header().device, ribs.description().device);
  expect_same(recording);
}

/// Beats of a loop that is sometimes late, recorded without a stage.
TEST(Recording, ReplaysSkippedPeriodsAndOverruns) {
  const TemporaryFolder folder;
  Puppet device(roaming);
  const Program program = bead(400);
  GuardCounts guards;
  {
    const auto begun =
        RecordWriter::begin(folder / "a.wrec", {.device = device.profile(), .most_newton = HUGE_VAL}, true);
    RecordWriter& writer = **begun;
    writer.put({.size = program.default_size(), .parameters = program.default_parameters()}, program);
    writer.publish(1);
    Exchange<PlacedPatches> patches;
    patches.publish(placed(program, 1));
    Record record;
    Player player(device, patches, record, 4000, HUGE_VAL, false, &writer);
    for (long tick = 0, period = 0; tick < 4000; ++tick) {
      const long skipped = tick % 100 == 99 ? 30 : tick % 10 == 9 ? 2 : 0;
      const long last = period;
      period += (tick == 0 ? 0 : 1) + skipped;
      player.serve({period, period - last, skipped, 1000 * tick});
    }
    guards = player.guards();
    writer.end();
    EXPECT_FALSE(writer.ended_early());
  }
  EXPECT_EQ(guards.overrun, 40);
  const Recording recording = opened(folder / "a.wrec");
  ASSERT_EQ(recording.ticks(), 4000u);
  EXPECT_EQ(recording.tick(99).skipped, 30u);
  EXPECT_EQ(recording.tick(99).elapsed, 31u);
  EXPECT_EQ(recording.tick(3999).lateness, 3999000);
  expect_same(recording);
}

/// A file of version 1, made by the last Wale that wrote them; runs of 64 zeros or more are left out of it.
std::vector<std::byte> version_1() {
  const std::vector<std::byte> parts = bytes_of(WALE_SOURCE_DIR "/tests/runtime/recordings/version_1.parts");
  const auto number = [&](auto value, std::size_t at) {
    std::memcpy(&value, parts.data() + at, sizeof value);
    return value;
  };
  std::vector<std::byte> whole(number(std::uint64_t{}, 0));
  for (std::size_t at = 8; at < parts.size();) {
    const std::uint32_t place = number(std::uint32_t{}, at), size = number(std::uint32_t{}, at + 4);
    std::memcpy(whole.data() + place, parts.data() + at + 8, size);
    at += 8 + size;
  }
  return whole;
}

TEST(Recording, OfVersion1ReplaysBitForBit) {
  const auto recording = Recording::read(version_1(), "version 1");
  ASSERT_TRUE(recording) << refused(recording);
  EXPECT_EQ(recording->ticks(), 450u);
  EXPECT_EQ(recording->header().most_newton, 1.5);
  for (const auto kind : {RecordedEvent::Kind::place, RecordedEvent::Kind::add, RecordedEvent::Kind::replace,
                          RecordedEvent::Kind::set, RecordedEvent::Kind::move})
    EXPECT_GT(std::ranges::count(recording->events(), kind, &RecordedEvent::kind), 0) << static_cast<int>(kind);
  expect_same(*recording);
}

TEST(Recording, WhoseFileAnotherProgramTakesAwayIsTold) {
  const struct {
    std::function<void(const std::string&)> take;
    std::string said;
  } ways[] = {{[](const std::string& file) { std::filesystem::remove(file); }, "removed"},
              {[](const std::string& file) {
                 std::filesystem::permissions(file, std::filesystem::perms(0644));  // it is read-only during the run
                 std::filesystem::resize_file(file, 5000);
               },
               "cut"},
              {[](const std::string& file) { std::filesystem::rename(file, file + "2"); }, "renamed"}};
  for (const auto& [take, said] : ways) {
    const TemporaryFolder folder;
    const std::string file = folder / "a.wrec";
    const Puppet device(roaming);
    const auto begun = RecordWriter::begin(file, {.device = device.profile(), .most_newton = HUGE_VAL}, true);
    EXPECT_FALSE((*begun)->ended_early());
    take(file);
    const auto error = (*begun)->ended_early();
    ASSERT_TRUE(error) << said;
    EXPECT_EQ(error->code, Code::unwritable_file);
    EXPECT_NE(error->sentence.find(said), std::string::npos) << error->sentence;
  }
}

TEST(Recording, ARealTimeRunReplaysToo) {
  const TemporaryFolder folder;
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Lateral{0.04, 1});
  Stage stage(joystick, {.record = RecordTo{folder / "a.wrec", {}}});
  Patch patch = *stage.add(corduroy(1.934f));
  const auto turn = [&](const Now&) {
    EXPECT_TRUE(patch.set("wale", 0.002f));
    EXPECT_TRUE(patch.replace(corduroy(1.5f)));
  };
  const RunResult done = run(stage, {.seconds = 0.6, .progress = turn});
  const Recording recording = opened(folder / "a.wrec");
  EXPECT_EQ(static_cast<long>(recording.ticks()), done.ticks_run);
  EXPECT_TRUE(recording.complete());
  expect_same(recording);
}

TEST(Recording, ADifferenceIsReportedWithItsTick) {
  const TemporaryFolder folder;
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Lateral{0.04, 1});
  Stage stage(joystick, {.record = RecordTo{folder / "a.wrec", {}}});
  Patch patch = *stage.add(corduroy(1.934f));
  run(stage, {.seconds = 1, .virtual_time = true});
  // Another force at tick 700, with a correct check, as if the machine had computed it.
  std::vector<std::byte> bytes = bytes_of(folder / "a.wrec");
  std::size_t at = 0;
  for (std::size_t chunk = first_chunk; chunk < bytes.size(); chunk += chunk_size) {
    ChunkHeader header;
    std::memcpy(&header, bytes.data() + chunk, sizeof header);
    if (header.kind == ChunkKind::ticks && header.number == 0) at = chunk + chunk_header_size + 700 * sizeof(TickEntry);
  }
  ASSERT_NE(at, 0u);
  TickEntry entry;
  std::memcpy(&entry, bytes.data() + at, sizeof entry);
  const float right = entry.commanded[0];
  entry.commanded[0] += 0.25f;
  entry.check = check_of(entry);
  std::memcpy(bytes.data() + at, &entry, sizeof entry);
  const auto recording = Recording::read(bytes, "changed");
  ASSERT_TRUE(recording) << refused(recording);
  const Replay replayed = *replay(*recording);
  EXPECT_EQ(replayed.ticks, 900u);
  EXPECT_EQ(replayed.differing, 1u);
  ASSERT_TRUE(replayed.first);
  EXPECT_EQ(replayed.first->tick, 700u);
  EXPECT_EQ(replayed.first->what, "commanded output");
  EXPECT_EQ(replayed.first->recorded, right + 0.25f);
  EXPECT_EQ(replayed.first->replayed, right);
  EXPECT_NEAR(replayed.largest_force, 0.25, 1e-6);
}

// Mapped memory of a file that became shorter would end the process.
TEST(Recording, OfAFileThatIsShortenedMeanwhileStaysWhole) {
  const TemporaryFolder folder;
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Circular{0.075, 1, {0.03, 0}});
  Stage stage(joystick, {.record = RecordTo{folder / "a.wrec", "circular"}});
  Patch patch = *stage.add(corduroy(1.934f), {.at = {0.001f, 0}});
  run(stage, {.seconds = 1, .virtual_time = true});
  const Recording recording = opened(folder / "a.wrec");
  std::filesystem::resize_file(folder / "a.wrec", 0);
  const auto replayed = replay(recording);
  ASSERT_TRUE(replayed) << replayed.error().sentence;
  EXPECT_EQ(replayed->ticks, 900u);
  EXPECT_FALSE(replayed->first);
}

TEST(Recording, OfAFileThatIsTooLargeIsRefusedUnread) {
  const TemporaryFolder folder;
  folder.write("large.wrec", "");
  std::filesystem::resize_file(folder / "large.wrec", (std::uintmax_t{1} << 31) + 1);  // a hole: it takes no room
  const auto recording = Recording::open(folder / "large.wrec");
  ASSERT_FALSE(recording);
  EXPECT_EQ(recording.error().code, Code::unreadable_file);
  EXPECT_NE(recording.error().sentence.find("Wale reads up to 2048 MB"), std::string::npos)
      << recording.error().sentence;
}

TEST(Recording, ARunMayKeepOnlyItsEnd) {
  Puppet device(roaming);
  Stage stage(device);
  Patch patch = *stage.add(oil(1));
  const RunResult whole = run(stage, {.seconds = 3, .virtual_time = true});
  Puppet again(roaming);
  Stage other(again);
  ASSERT_TRUE(other.add(oil(1)));
  const RunResult end = run(other, {.seconds = 3, .virtual_time = true, .kept_seconds = 0.7});
  EXPECT_EQ(end.ticks_run, 2700);
  ASSERT_EQ(end.record.ticks.size(), 630u);
  for (std::size_t i = 0; i < 630; ++i) ASSERT_EQ(end.record.ticks[i].time, whole.record.ticks[2070 + i].time);
  const auto endless = stage.run({.seconds = HUGE_VAL, .virtual_time = true});
  ASSERT_FALSE(endless);
  EXPECT_EQ(endless.error().sentence, "a run keeps at most 18641.4 s at 900 Hz; asked for inf s");
  std::atomic<bool> stop = false;
  const auto enough = [&](const Now& now) { stop = now.ticks_run >= 1800; };
  EXPECT_EQ(
      run(stage, {.seconds = HUGE_VAL, .virtual_time = true, .progress = enough, .stop = &stop, .kept_seconds = 1})
          .ticks_run,
      1800);
}

}  // namespace
}  // namespace wale::recording_test
