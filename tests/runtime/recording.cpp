// Recordings: what is in them, that they are whole after a crash, and that a replay gives the same forces bit for bit.

#include "wale/recording.hpp"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include "runtime/record/format.hpp"
#include "runtime/record/record_writer.hpp"
#include "runtime/stage/player.hpp"
#include "tests/runtime/figures.hpp"
#include "tests/runtime/programs.hpp"
#include "tests/schema/example_program.hpp"
#include "wale/simulated.hpp"
#include "wale/simulated_pad.hpp"
#include "wale/stage.hpp"

namespace wale::recording_test {
namespace {

namespace fs = std::filesystem;
using namespace recording_format;

/// A folder of its own for one test, gone with it.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "wale-recording-XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

std::vector<std::byte> bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

Recording opened(const std::string& path) {
  auto recording = Recording::open(path);
  if (const auto* refusal = std::get_if<Refusal>(&recording)) throw std::runtime_error(refusal->reason);
  return std::get<Recording>(std::move(recording));
}

std::string refused(const std::variant<Recording, Refusal>& recording) {
  const auto* refusal = std::get_if<Refusal>(&recording);
  return refusal != nullptr ? refusal->reason : "not refused";
}

RunResult run(Stage& stage, const RunOptions& options) {
  auto result = stage.run(options);
  if (const auto* refusal = std::get_if<Refusal>(&result)) throw std::runtime_error(refusal->reason);
  return std::get<RunResult>(std::move(result));
}

void expect_same(const Recording& recording) {
  const auto result = replay(recording);
  ASSERT_TRUE(std::holds_alternative<Replay>(result)) << std::get<Refusal>(result).reason;
  const auto& replayed = std::get<Replay>(result);
  EXPECT_EQ(replayed.ticks, recording.ticks());
  EXPECT_EQ(replayed.differing, 0u);
  if (replayed.first)
    ADD_FAILURE() << "tick " << replayed.first->tick << ": " << replayed.first->what << " was "
                  << replayed.first->recorded << " and is " << replayed.first->replayed;
}

/// A device whose reading the test makes up, and which tells what is done with it.
class Puppet : public Device {
 public:
  explicit Puppet(std::function<Reading(long sample)> reading) : reading_(std::move(reading)) {}
  const DeviceProfile& profile() const noexcept override { return profile_; }
  void elapse(long) noexcept override {}
  Reading sample() noexcept override { return reading_(samples_++); }
  Force command(Force force) noexcept override { return force * 0.75f; }  // a weak actuator, so that the two differ

  DeviceProfile profile_ = sandpaper();

 private:
  std::function<Reading(long)> reading_;
  long samples_ = 0;
};

/// Over the workspace and beyond its patches, at up to 1 m/s.
Reading roaming(long sample) {
  const double t = static_cast<double>(sample) / 900;
  const auto place = [](double amplitude, double phase) {
    return static_cast<int>(std::lround(amplitude * std::sin(phase)));
  };
  return {.counts = {place(1800, 2.1 * t), place(900, 7.7 * t)}, .button = sample % 700 > 600};
}

TEST(Recording, HoldsWhatTheRunHad) {
  const Folder folder;
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Circular{0.075, 1, {0.03, 0}});
  Stage stage(joystick);
  stage.place(corduroy(1.934f), {0.001f, 0});
  ASSERT_FALSE(stage.set("wale", 0.003f));
  const RunResult done = run(stage, {.seconds = 7,
                                     .most_newton = 1.5,
                                     .virtual_time = true,
                                     .record_to = RecordTo{folder / "a.wrec", "simulated, circular"}});
  EXPECT_EQ(done.record_problem, "");
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
      std::ranges::equal(recording.programs()[0].bytes, write_patch_program(stage.bank()->program().description())));
  ASSERT_EQ(recording.events().size(), 3u);
  EXPECT_EQ(recording.events()[0].kind, RecordedEvent::Kind::add);
  EXPECT_EQ(recording.events()[0].position, glm::vec2(0.001f, 0));
  EXPECT_EQ(recording.events()[0].parameters, std::vector<float>{0.003f});
  EXPECT_EQ(recording.events()[1].kind, RecordedEvent::Kind::publish);
  EXPECT_EQ(recording.events()[2].kind, RecordedEvent::Kind::end);
  expect_same(recording);
}

TEST(Recording, ReplaysPatchesParametersAndSwapsAtTheirTicks) {
  const Folder folder;
  Puppet device(roaming);
  Stage stage(device);
  stage.place(corduroy(1.934f));
  stage.add(bead(500), {0.02f, 0}, {.width = 0.05f, .height = 0.04f}, 1);
  stage.add(oil(3), {-0.05f, 0.01f}, {.width = 0.06f, .height = 0.06f}, 1);
  const auto act = [&](const Progress& now) {
    const auto done = [](std::optional<Refusal> refusal) { EXPECT_FALSE(refusal) << refusal->reason; };
    const long deed = now.ticks_run / 90;
    if (deed == 60) stage.place(bead(100), {0.01f, 0.005f}, {.width = 0.1f, .height = 0.1f});
    if (deed == 70) done(stage.replace(0, spring(30)));
    if (deed >= 60) return;
    if (deed % 3 == 0) done(stage.set(0, "wale", 0.001f + 0.0001f * static_cast<float>(deed % 40)));
    if (deed % 7 == 0) done(stage.replace(1, bead(300 + static_cast<float>(deed))));
    if (deed % 7 == 0) done(stage.replace(1, bead(301 + static_cast<float>(deed))));  // twice before a tick
    if (deed == 20) done(stage.replace(2, spring(40)));
    if (deed == 21) done(stage.set(2, "stiffness", 60));
    if (deed == 40) stage.add(push(1.5f), {0, 0}, {.width = 0.01f, .height = 0.2f}, 2);
  };
  const RunResult done =
      run(stage, {.seconds = 9, .virtual_time = true, .progress = act, .record_to = RecordTo{folder / "a.wrec", {}}});
  const Recording recording = opened(folder / "a.wrec");
  std::uint32_t revision = 1;
  long sets = 0, swaps = 0;
  for (const RecordedEvent& event : recording.events()) {
    sets += event.kind == RecordedEvent::Kind::set;
    swaps += event.kind == RecordedEvent::Kind::replace;
    if (event.kind != RecordedEvent::Kind::publish || event.revision == 1) continue;
    ++revision;
    ASSERT_LT(event.ticks, recording.ticks());
    EXPECT_EQ(event.ticks % 90, 0u);
    EXPECT_EQ(recording.tick(event.ticks).revision, revision) << "felt in the very next tick";
    EXPECT_EQ(recording.tick(event.ticks - 1).revision, revision - 1);
  }
  EXPECT_EQ(sets, 19 + 1);
  EXPECT_EQ(swaps, 2 * 8 + 2);
  std::vector<long> under(4);
  for (std::size_t i = 0; i < recording.ticks(); ++i)
    if (recording.tick(i).inside) ++under.at(recording.tick(i).patch);
  for (const long ticks : under) EXPECT_GT(ticks, 50);
  EXPECT_GT(done.guards.slew, 100);
  expect_same(recording);
}

TEST(Recording, ReplaysStaleAndLostDevicesAndEveryGuard) {
  const Folder folder;
  Puppet device([](long sample) {
    Reading reading = roaming(sample);
    if (sample % 1000 > 990) reading.contact = Contact::stale;
    if (sample > 3000 && sample < 3100) reading.contact = Contact::lost;
    return reading;
  });
  device.profile_.force_newton = 3;
  Stage stage(device);
  // A spring beyond what the user allows, a source of energy, a force that is none, a wall too stiff for its device.
  Assembly none({2, 0});
  const RegisterNumber state = none.state("state", -1, 1);
  none.evolve(state, none.constant(1), none.tick(Operation::divide, none.constant(1), none.constant(1)));
  none.push(0, none.tick(Operation::multiply, none.constant(0), state), none.constant(0));
  none.push(1, none.constant(1), none.constant(0));
  stage.place(spring(8000, 2.9f));
  stage.add(oil(-8, 2.9f), {0.03f, 0}, {.width = 0.06f, .height = 0.16f}, 1);
  stage.add(none.load(), {-0.05f, 0}, {.width = 0.02f, .height = 0.16f}, 1);
  const RunResult done = run(
      stage, {.seconds = 8, .most_newton = 2.5, .virtual_time = true, .record_to = RecordTo{folder / "a.wrec", {}}});
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

TEST(Recording, ReplaysPads) {
  const Folder folder;
  const Program ribs = std::get<Program>(Program::load(example::pad(PositionSource::touch)));
  SimulatedPad pad(ribs.description().device, Lateral{0.02, 1});
  Stage stage(pad);
  stage.place(ribs);
  run(stage, {.seconds = 2, .virtual_time = true, .record_to = RecordTo{folder / "a.wrec", {}}});
  const Recording recording = opened(folder / "a.wrec");
  EXPECT_EQ(recording.header().device, ribs.description().device);
  expect_same(recording);
}

/// Beats as a loop that is not always in time serves them, recorded without a stage.
TEST(Recording, ReplaysSkippedPeriodsAndOverruns) {
  const Folder folder;
  Puppet device(roaming);
  const Program program = bead(400);
  GuardCounts guards;
  {
    RecordWriter writer(folder / "a.wrec", {.device = device.profile(), .most_newton = HUGE_VAL}, true);
    writer.add(program, {0, 0}, program.default_size(), 0, program.default_parameters());
    writer.publish(1);
    Exchange<PlacedPatches> patches;
    PlacedPatches placed({Bank(program), {0, 0}, std::make_shared<Memory>(program)});
    placed.revision = 1;
    patches.publish(placed);
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
    EXPECT_EQ(writer.ended_early(), "");
  }
  EXPECT_EQ(guards.overrun, 40);
  const Recording recording = opened(folder / "a.wrec");
  ASSERT_EQ(recording.ticks(), 4000u);
  EXPECT_EQ(recording.tick(99).skipped, 30u);
  EXPECT_EQ(recording.tick(99).elapsed, 31u);
  EXPECT_EQ(recording.tick(3999).lateness, 3999000);
  expect_same(recording);
}

TEST(Recording, ARealTimeRunReplaysToo) {
  const Folder folder;
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Lateral{0.04, 1});
  Stage stage(joystick);
  stage.place(corduroy(1.934f));
  const auto turn = [&](const Progress&) {
    EXPECT_FALSE(stage.set("wale", 0.002f));
    EXPECT_FALSE(stage.replace(0, corduroy(1.5f)));
  };
  const RunResult done = run(stage, {.seconds = 0.6, .progress = turn, .record_to = RecordTo{folder / "a.wrec", {}}});
  const Recording recording = opened(folder / "a.wrec");
  EXPECT_EQ(static_cast<long>(recording.ticks()), done.ticks_run);
  EXPECT_TRUE(recording.complete());
  expect_same(recording);
}

TEST(Recording, WhatDiffersIsToldWithItsTick) {
  const Folder folder;
  SimulatedJoystick joystick(sandpaper(), normal_hand(), Lateral{0.04, 1});
  Stage stage(joystick);
  stage.place(corduroy(1.934f));
  run(stage, {.seconds = 1, .virtual_time = true, .record_to = RecordTo{folder / "a.wrec", {}}});
  // As if the machine had computed another force on tick 700: with a check that is right.
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
  ASSERT_TRUE(std::holds_alternative<Recording>(recording)) << refused(recording);
  const Replay replayed = std::get<Replay>(replay(std::get<Recording>(recording)));
  EXPECT_EQ(replayed.ticks, 900u);
  EXPECT_EQ(replayed.differing, 1u);
  ASSERT_TRUE(replayed.first);
  EXPECT_EQ(replayed.first->tick, 700u);
  EXPECT_EQ(replayed.first->what, "commanded output");
  EXPECT_EQ(replayed.first->recorded, right + 0.25f);
  EXPECT_EQ(replayed.first->replayed, right);
  EXPECT_NEAR(replayed.largest_force, 0.25, 1e-6);
}

/// What a process leaves behind that is killed while it serves its tick number `last`, of which `forces` saw all
/// before.
struct Killed {
  std::size_t served = 0;
  std::vector<Force> forces;
};

Killed killed(const std::string& file, bool virtual_time, std::size_t last) {
  struct Shared {
    std::atomic<std::size_t> served;
    std::array<Force, 20000> forces;
  };
  void* memory = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  auto* shared = static_cast<Shared*>(memory);
  const pid_t child = fork();
  if (child == 0) {
    class Doomed : public Device {
     public:
      Doomed(Shared& shared, std::size_t last) : shared_(shared), last_(last) { joystick_profile_.rate = 10000; }
      const DeviceProfile& profile() const noexcept override { return joystick_profile_; }
      void elapse(long) noexcept override {}
      Reading sample() noexcept override {
        if (shared_.served.load() == last_) kill(getpid(), SIGKILL);
        return roaming(static_cast<long>(shared_.served.load()));
      }
      Force command(Force force) noexcept override {
        const std::size_t served = shared_.served.load();
        shared_.forces[served] = force;
        shared_.served.store(served + 1);
        return force;
      }

     private:
      DeviceProfile joystick_profile_ = sandpaper();
      Shared& shared_;
      std::size_t last_;
    } device(*shared, last);
    Stage stage(device);
    stage.place(corduroy(1.934f));
    const auto turn = [&](const Progress& now) {
      stage.set("wale", 0.001f + 0.001f * static_cast<float>(now.ticks_run % 4));
    };
    stage.run({.seconds = 60, .virtual_time = virtual_time, .progress = turn, .record_to = RecordTo{file, {}}});
    _exit(0);  // it should not have come here
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  Killed result{shared->served.load(), {shared->forces.begin(), shared->forces.begin() + shared->served.load()}};
  munmap(memory, sizeof(Shared));
  return result;
}

TEST(Recording, IsWholeUpToTheLastTickWhenItsProcessIsKilled) {
  const Folder folder;
  for (const bool virtual_time : {true, false}) {
    for (const std::size_t last : {std::size_t{1}, ticks_per_chunk, ticks_per_chunk + 1, 2 * ticks_per_chunk + 777}) {
      const std::string file = folder / (std::to_string(last) + (virtual_time ? "v.wrec" : "r.wrec"));
      const Killed process = killed(file, virtual_time, last);
      ASSERT_EQ(process.served, last);
      const Recording recording = opened(file);
      EXPECT_FALSE(recording.complete());
      // Killed in the middle of tick `last`, counted from 0.
      ASSERT_EQ(recording.ticks(), last);
      for (std::size_t i = 0; i < last; ++i) ASSERT_EQ(recording.tick(i).commanded, process.forces[i]) << i;
      expect_same(recording);
    }
  }
}

std::vector<std::byte> some_recording() {
  const Folder folder;
  Puppet device(roaming);
  Stage stage(device);
  stage.place(corduroy(1.934f));
  const auto turn = [&](const Progress&) { stage.set("wale", 0.002f); };
  run(stage, {.seconds = 4, .virtual_time = true, .progress = turn, .record_to = RecordTo{folder / "a.wrec", {}}});
  return bytes_of(folder / "a.wrec");
}

bool equal(const Recording& a, const Recording& b, std::size_t ticks) {
  for (std::size_t i = 0; i < ticks; ++i) {
    const TickEntry one = encode(a.tick(i), i), other = encode(b.tick(i), i);
    if (std::memcmp(&one, &other, sizeof one) != 0) return false;
  }
  return true;
}

TEST(Recording, AFlippedByteIsFoundOrIsNone) {
  const std::vector<std::byte> bytes = some_recording();
  const Recording whole = std::get<Recording>(Recording::read(bytes, "whole"));
  ASSERT_EQ(whole.ticks(), 3600u);
  ASSERT_GT(whole.ticks(), ticks_per_chunk);
  // Every byte of the headers, of the events and of a few ticks, and every 997th of the rest.
  long found = 0, none = 0;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    const std::size_t in_chunk = at < first_chunk ? at : (at - first_chunk) % chunk_size;
    if (in_chunk > 2500 && in_chunk % 997 != 0) continue;
    if (in_chunk > 700 && in_chunk % 7 != 0) continue;
    std::vector<std::byte> flipped = bytes;
    flipped[at] ^= std::byte{0x10};
    const auto read = Recording::read(std::move(flipped), "flipped");
    if (const auto* refusal = std::get_if<Refusal>(&read)) {
      ++found;
      ASSERT_TRUE(refusal->reason.starts_with("`flipped`: ")) << refusal->reason;
      continue;
    }
    ++none;
    const Recording& same = std::get<Recording>(read);
    ASSERT_EQ(same.ticks(), whole.ticks()) << at;
    ASSERT_TRUE(same.complete()) << at;
    ASSERT_EQ(same.events().size(), whole.events().size()) << at;
    ASSERT_TRUE(equal(same, whole, whole.ticks())) << at;
  }
  EXPECT_GT(found, 1000);
  EXPECT_GT(none, 100) << "padding";
}

TEST(Recording, OfADamagedOneTheTicksBeforeCanBeHad) {
  std::vector<std::byte> bytes = some_recording();
  const Recording whole = std::get<Recording>(Recording::read(bytes, "whole"));
  std::size_t at = 0;
  for (std::size_t i = first_chunk; i + 8 <= bytes.size(); i += 8) {  // where tick number 1234 lies
    TickEntry entry;
    if (i + sizeof entry > bytes.size()) break;
    std::memcpy(&entry, bytes.data() + i, sizeof entry);
    if (entry.sequence == 1235 && entry.period == 1234) at = i;
  }
  ASSERT_NE(at, 0u);
  bytes[at + 40] ^= std::byte{1};
  EXPECT_EQ(refused(Recording::read(bytes, "a.wrec")),
            "`a.wrec`: tick 1234 (byte " + std::to_string(at) +
                ") is damaged; the 1234 ticks before are whole, and can be had: --ticks 1234");
  const auto before = Recording::read(bytes, "a.wrec", 1234);
  ASSERT_TRUE(std::holds_alternative<Recording>(before)) << refused(before);
  EXPECT_EQ(std::get<Recording>(before).ticks(), 1234u);
  EXPECT_FALSE(std::get<Recording>(before).complete());
  EXPECT_TRUE(equal(std::get<Recording>(before), whole, 1234));
  expect_same(std::get<Recording>(before));
}

TEST(Recording, CutShortItIsRefusedOrShorter) {
  const std::vector<std::byte> bytes = some_recording();
  const Recording whole = std::get<Recording>(Recording::read(bytes, "whole"));
  for (std::size_t size = 0; size < bytes.size(); size += 4999) {
    const auto read = Recording::read({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}, "cut");
    EXPECT_TRUE(std::holds_alternative<Refusal>(read)) << size;
  }
  const auto cut = Recording::read({bytes.begin(), bytes.end() - 5}, "cut");
  EXPECT_NE(refused(cut).find("`cut`: it is cut short within the chunk at byte"), std::string::npos) << refused(cut);
}

TEST(Recording, WhatIsNoneIsRefusedWithAReason) {
  const auto reason = [](const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return refused(Recording::read({bytes.begin(), bytes.end()}, "x"));
  };
  EXPECT_EQ(reason(""), "`x`: it is empty: nothing was recorded in it");
  EXPECT_EQ(reason("t (s),x (m)\n0,0\n"),
            "`x`: it is no recording: it does not begin as one does; `wale feel FILE --record NAME.wrec` makes one");
  EXPECT_EQ(reason("\x89WRC\n\x1a\n"), "`x`: a transfer as text has damaged it: copy it as binary");
  EXPECT_EQ(reason(std::string("\x89WRC\r\n\x1a\n", 8)),
            "`x`: it is cut short within its header, at byte 8: copy it again");
  std::vector<std::byte> newer = some_recording();
  FileHeader header;
  std::memcpy(&header, newer.data(), sizeof header);
  header.version = 2;
  header.check = check_of(header);
  std::memcpy(newer.data(), &header, sizeof header);
  EXPECT_EQ(refused(Recording::read(newer, "x")), "`x`: it is of format 2, and this Wale reads up to 1: update Wale");
  const Folder folder;
  EXPECT_EQ(refused(Recording::open(folder / "none.wrec")),
            "`" + folder / "none.wrec" + "` cannot be read: No such file or directory");
}

TEST(Recording, CannotBeMadeWhereItWouldTakeAnothersPlaceOrThereIsNone) {
  const Folder folder;
  Puppet device(roaming);
  Stage stage(device);
  stage.place(oil(1));
  const auto attempt = [&](const std::string& file) {
    const auto result = stage.run({.seconds = 0.01, .virtual_time = true, .record_to = RecordTo{file, {}}});
    const auto* refusal = std::get_if<Refusal>(&result);
    return refusal != nullptr ? refusal->reason : "not refused";
  };
  EXPECT_EQ(attempt(folder / "a.wrec"), "not refused");
  const auto before = bytes_of(folder / "a.wrec");
  EXPECT_EQ(attempt(folder / "a.wrec"),
            "cannot record in `" + folder / "a.wrec" +
                "`: it is there already, and a recording is never written over; delete it or choose another name");
  EXPECT_EQ(bytes_of(folder / "a.wrec"), before);
  EXPECT_EQ(attempt(folder / "none/a.wrec"),
            "cannot record in `" + folder / "none/a.wrec" + "`: there is no such folder; make it first");
  device.profile_.mass = -1;
  EXPECT_NE(attempt(folder / "b.wrec").find("the device's mass (kg)"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "b.wrec"));
}

TEST(Recording, OnAFullDiskTheRunGoesOnAndSaysWhatIsRecorded) {
  const Folder folder;
  rlimit usual{};
  getrlimit(RLIMIT_FSIZE, &usual);
  const auto old = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = usual;
  small.rlim_cur = first_chunk + 8 * chunk_size + 100;  // one chunk of events, seven of ticks
  for (const bool virtual_time : {true, false}) {
    Puppet device(roaming);
    if (!virtual_time) device.profile_.rate = 10000;
    const double seconds = (7 * ticks_per_chunk + 500) / device.profile_.rate;
    Stage stage(device);
    stage.place(corduroy(1.934f));
    const std::string file = folder / (virtual_time ? "v.wrec" : "r.wrec");
    setrlimit(RLIMIT_FSIZE, &small);
    const RunResult done =
        run(stage, {.seconds = seconds, .virtual_time = virtual_time, .record_to = RecordTo{file, {}}});
    setrlimit(RLIMIT_FSIZE, &usual);
    EXPECT_EQ(done.ticks_run + done.ticks_missed, static_cast<long>(7 * ticks_per_chunk + 500));
    if (static_cast<std::size_t>(done.ticks_run) <= 7 * ticks_per_chunk) continue;  // a machine too busy for the test
    EXPECT_EQ(done.record_problem, "the recording ends after " + std::to_string(7 * ticks_per_chunk) +
                                       " ticks: cannot go on recording in `" + file +
                                       "`: no file may become that large here (ulimit -f); raise the limit or record "
                                       "elsewhere");
    const Recording recording = opened(file);
    EXPECT_EQ(recording.ticks(), 7 * ticks_per_chunk);
    EXPECT_FALSE(recording.complete());
    expect_same(recording);
  }
  std::signal(SIGXFSZ, old);
}

TEST(Recording, ARunMayBeLongerThanWhatIsKeptOfIt) {
  Puppet device(roaming);
  Stage stage(device);
  stage.place(oil(1));
  const RunResult whole = run(stage, {.seconds = 3, .virtual_time = true});
  Puppet again(roaming);
  Stage other(again);
  other.place(oil(1));
  const RunResult end = run(other, {.seconds = 3, .virtual_time = true, .kept_seconds = 0.7});
  EXPECT_EQ(end.ticks_run, 2700);
  ASSERT_EQ(end.record.ticks.size(), 630u);
  for (std::size_t i = 0; i < 630; ++i) ASSERT_EQ(end.record.ticks[i].time, whole.record.ticks[2070 + i].time);
  const auto endless = stage.run({.seconds = HUGE_VAL, .virtual_time = true});
  ASSERT_TRUE(std::holds_alternative<Refusal>(endless));
  EXPECT_EQ(std::get<Refusal>(endless).reason, "a run lasts at most 18641.4 s at 900 Hz; asked for inf s");
  std::atomic<bool> stop = false;
  const auto enough = [&](const Progress& now) { stop = now.ticks_run >= 1800; };
  EXPECT_EQ(
      run(stage, {.seconds = HUGE_VAL, .virtual_time = true, .progress = enough, .stop = &stop, .kept_seconds = 1})
          .ticks_run,
      1800);
}

}  // namespace
}  // namespace wale::recording_test
