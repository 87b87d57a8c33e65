// Recording files: after a crash, on a full disk, damaged, and where none can be made.

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>

#include "schema/without_place.hpp"
#include "tests/runtime/programs.hpp"
#include "tests/runtime/recorded.hpp"

namespace wale::recording_files_test {
namespace {

using namespace recorded;
using namespace recording_format;

/// The ticks that a process served, and their forces, until it was killed in tick `last`.
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
    Stage stage(device, {.record = RecordTo{file, {}}});
    Patch patch = *stage.add(built_for(corduroy(1.934f), device.profile()));
    const auto turn = [&](const Now& now) {
      EXPECT_TRUE(patch.set("wale", 0.001f + 0.001f * static_cast<float>(now.ticks_run % 4)));
    };
    (void)stage.run({.seconds = 60, .virtual_time = virtual_time, .progress = turn});
    _exit(0);  // not reached
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  Killed result{shared->served.load(), {shared->forces.begin(), shared->forces.begin() + shared->served.load()}};
  munmap(memory, sizeof(Shared));
  return result;
}

TEST(RecordingFile, IsCompleteUpToTheLastTickWhenItsProcessIsKilled) {
  const TemporaryFolder folder;
  for (const bool virtual_time : {true, false}) {
    for (const std::size_t last : {std::size_t{1}, ticks_per_chunk, ticks_per_chunk + 1, 2 * ticks_per_chunk + 777}) {
      const std::string file = folder / (std::to_string(last) + (virtual_time ? "v.wrec" : "r.wrec"));
      const Killed process = killed(file, virtual_time, last);
      ASSERT_EQ(process.served, last);
      const Recording recording = opened(file);
      EXPECT_FALSE(recording.complete());
      // The process was killed in tick `last`, counted from 0.
      ASSERT_EQ(recording.ticks(), last);
      for (std::size_t i = 0; i < last; ++i) ASSERT_EQ(recording.tick(i).commanded, process.forces[i]) << i;
      expect_same(recording);
    }
  }
}

std::vector<std::byte> some_recording() {
  const TemporaryFolder folder;
  Puppet device(roaming);
  Stage stage(device, {.record = RecordTo{folder / "a.wrec", {}}});
  Patch patch = *stage.add(corduroy(1.934f));
  const auto turn = [&](const Now&) { EXPECT_TRUE(patch.set("wale", 0.002f)); };
  run(stage, {.seconds = 4, .virtual_time = true, .progress = turn});
  return bytes_of(folder / "a.wrec");
}

bool equal(const Recording& a, const Recording& b, std::size_t ticks) {
  for (std::size_t i = 0; i < ticks; ++i) {
    const TickEntry one = encode(a.tick(i), i), other = encode(b.tick(i), i);
    if (std::memcmp(&one, &other, sizeof one) != 0) return false;
  }
  return true;
}

TEST(RecordingFile, AFlippedByteIsFoundOrChangesNothing) {
  const std::vector<std::byte> bytes = some_recording();
  const Recording whole = *Recording::read(bytes, "whole");
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
    if (!read) {
      ++found;
      ASSERT_EQ(read.error().place.name, "flipped") << read.error().sentence;
      ASSERT_FALSE(read.error().sentence.empty());
      continue;
    }
    ++none;
    const Recording& same = *read;
    ASSERT_EQ(same.ticks(), whole.ticks()) << at;
    ASSERT_TRUE(same.complete()) << at;
    ASSERT_EQ(same.events().size(), whole.events().size()) << at;
    ASSERT_TRUE(equal(same, whole, whole.ticks())) << at;
  }
  EXPECT_GT(found, 1000);
  EXPECT_GT(none, 100) << "padding";
}

TEST(RecordingFile, TicksBeforeADamageCanBeRead) {
  std::vector<std::byte> bytes = some_recording();
  const Recording whole = *Recording::read(bytes, "whole");
  std::size_t at = 0;
  for (std::size_t i = first_chunk; i + 8 <= bytes.size(); i += 8) {  // the place of tick 1234
    TickEntry entry;
    if (i + sizeof entry > bytes.size()) break;
    std::memcpy(&entry, bytes.data() + i, sizeof entry);
    if (entry.sequence == 1235 && entry.period == 1234) at = i;
  }
  ASSERT_NE(at, 0u);
  bytes[at + 40] ^= std::byte{1};
  EXPECT_EQ(refused(Recording::read(bytes, "a.wrec")),
            "tick 1234 (byte " + std::to_string(at) +
                ") is damaged; the 1234 ticks before it are intact: open it for no more than 1234 ticks (`most_ticks`)");
  const auto before = Recording::read(bytes, "a.wrec", 1234);
  ASSERT_TRUE(before) << refused(before);
  EXPECT_EQ(before->ticks(), 1234u);
  EXPECT_FALSE(before->complete());
  EXPECT_TRUE(equal(*before, whole, 1234));
  expect_same(*before);
}

/// The whole ticks among the first `size` bytes of a file, found by their sequence numbers without its chunks.
std::size_t whole_ticks(const std::vector<std::byte>& bytes, std::size_t size) {
  std::size_t found = 0;
  for (std::size_t at = first_chunk; at + sizeof(TickEntry) <= size; at += 8) {
    TickEntry entry;
    std::memcpy(&entry, bytes.data() + at, sizeof entry);
    if (entry.sequence == found + 1 && entry.check == check_of(entry)) ++found;
  }
  return found;
}

TEST(RecordingFile, OfACutFileAllWholeTicksBeforeTheCutCanBeRead) {
  const std::vector<std::byte> bytes = some_recording();
  const Recording whole = *Recording::read(bytes, "whole");
  std::vector<std::size_t> sizes{bytes.size() - 1, bytes.size() - 5, 500'000};
  for (std::size_t size = 0; size < bytes.size(); size += 14'999) sizes.push_back(size);
  for (const std::size_t size : sizes) {
    const std::vector<std::byte> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    const auto read = Recording::read(cut, "cut");
    ASSERT_FALSE(read) << size;
    if (size < first_chunk) continue;
    const std::size_t ticks = whole_ticks(bytes, size);
    const std::string left = ticks == 0
                                 ? "no tick of it can be read; record again"
                                 : "the " + std::to_string(ticks) +
                                       " ticks before it are intact: open it for no more than " + std::to_string(ticks) +
                                       " ticks (`most_ticks`)";
    const bool at_a_chunk = (size - first_chunk) % chunk_size == 0;
    if (!at_a_chunk) {
      EXPECT_EQ(refused(read), "the file is cut short at byte " + std::to_string(size) + "; " + left);
    }
    if (ticks == 0) continue;
    const auto before = Recording::read(cut, "cut", ticks);
    ASSERT_TRUE(before) << refused(before);
    ASSERT_EQ(before->ticks(), ticks);
    EXPECT_TRUE(equal(*before, whole, ticks));
  }
  EXPECT_EQ(whole_ticks(bytes, bytes.size() - 1), 3600u);
  EXPECT_EQ(whole_ticks(bytes, 500'000), (500'000 - first_chunk - chunk_size - chunk_header_size) / sizeof(TickEntry));
}

TEST(RecordingFile, TicksBeforeADamagedChangeOfTheStageCanBeRead) {
  const TemporaryFolder folder;
  Puppet device(roaming);
  Stage stage(device, {.record = RecordTo{folder / "a.wrec", {}}});
  Patch patch = *stage.add(corduroy(1.934f));
  const auto turn = [&](const Now& now) {
    EXPECT_TRUE(patch.set("wale", 0.001f + 0.001f * static_cast<float>(now.ticks_run % 4)));
  };
  run(stage, {.seconds = 4, .virtual_time = true, .progress = turn});
  std::vector<std::byte> bytes = bytes_of(folder / "a.wrec");
  const Recording whole = *Recording::read(bytes, "whole");
  // The places of the changes of the parameter: the payload of their events is patch, number and value.
  std::vector<std::size_t> places;
  for (std::size_t at = first_chunk + chunk_header_size; at + 36 <= first_chunk + chunk_size; at += event_alignment) {
    EventHeader header;
    std::memcpy(&header, bytes.data() + at, sizeof header);
    if (header.size == 13 && header.kind == static_cast<std::uint32_t>(EventCode::set)) places.push_back(at);
  }
  ASSERT_GT(places.size(), 10u);
  const std::size_t change = places.size() / 2;
  bytes[places[change] + sizeof(EventHeader) + 8] ^= std::byte{1};
  // The changes before it were published in revisions up to `intact`, whose ticks can be run.
  std::size_t changes = 0;
  std::uint32_t intact = 0;
  for (const RecordedEvent& event : whole.events()) {
    if (event.kind == RecordedEvent::Kind::set && changes++ == change) break;
    if (event.kind == RecordedEvent::Kind::publish) intact = event.revision;
  }
  std::size_t ticks = 0;
  while (whole.tick(ticks).revision <= intact) ++ticks;
  ASSERT_GT(ticks, 1000u);
  EXPECT_EQ(refused(Recording::read(bytes, "damaged")),
            "the event at byte " + std::to_string(places[change]) + " is damaged; the " + std::to_string(ticks) +
                " ticks before it are intact: open it for no more than " + std::to_string(ticks) +
                                       " ticks (`most_ticks`)");
  const auto before = Recording::read(bytes, "damaged", ticks);
  ASSERT_TRUE(before) << refused(before);
  expect_same(*before);
}

TEST(RecordingFile, BytesAfterItsEndAreNoCut) {
  const std::vector<std::byte> whole = some_recording();
  const std::size_t ticks = Recording::read(whole, "whole")->ticks();
  for (const std::size_t more : {std::size_t{1}, std::size_t{100}, chunk_size, 3 * chunk_size + 5}) {
    std::vector<std::byte> longer = whole;
    longer.insert(longer.end(), more, std::byte{'x'});
    const auto read = Recording::read(longer, "longer");
    ASSERT_FALSE(read) << more;
    EXPECT_EQ(read.error().sentence,
              "bytes follow the recording's end, from byte " + std::to_string(whole.size()) + " on");
    EXPECT_EQ(read.error().place.number, whole.size());
    EXPECT_TRUE(Recording::read(longer, "longer", ticks));
  }
}

TEST(RecordingFile, OtherFilesAreRefusedWithAReason) {
  const auto reason = [](const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return refused(Recording::read({bytes.begin(), bytes.end()}, "x"));
  };
  EXPECT_EQ(reason(""),
            "the file is empty: nothing was recorded in it; record a run into a file NAME.wrec, and open that");
  EXPECT_EQ(reason("t (s),x (m)\n0,0\n"),
            "this is not a recording: its first bytes are not those of a .wrec file; "
            "record a run into a file NAME.wrec, and open that");
  EXPECT_EQ(reason("\x89WRC\n\x1a\n"), "a transfer as text has damaged the recording; copy it as binary");
  EXPECT_EQ(reason(std::string("\x89WRC\r\n\x1a\n", 8)),
            "the file is cut short within its header, at byte 8; copy it again");
  std::vector<std::byte> newer = some_recording();
  FileHeader header;
  std::memcpy(&header, newer.data(), sizeof header);
  header.version = version + 1;
  header.check = check_of(header);
  std::memcpy(newer.data(), &header, sizeof header);
  EXPECT_EQ(refused(Recording::read(newer, "x")), "its format is 6, but this Wale reads only up to 5; update Wale");
  const TemporaryFolder folder;
  const auto missing = Recording::open(folder / "none.wrec");
  EXPECT_EQ(missing.error().sentence, "the file cannot be read: no such file");
  EXPECT_EQ(missing.error().place.name, folder / "none.wrec");
}

TEST(RecordingFile, IsWhereItsPathLedWhenTheStageWasMade) {
  const TemporaryFolder folder;
  Puppet device(roaming);
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  Stage stage(device, {.record = RecordTo{"a.wrec", "in\ntwo lines"}}), good(device, {.record = RecordTo{"b.wrec", {}}});
  ASSERT_TRUE(stage.add(oil(1)) && good.add(oil(1)));
  fs::current_path("/");
  const auto lines = stage.run({.seconds = 0.01, .virtual_time = true});
  const auto run = good.run({.seconds = 0.01, .virtual_time = true});
  fs::current_path(before);
  ASSERT_FALSE(lines);
  EXPECT_NE(lines.error().mend.find("moves the handle"), std::string::npos) << lines.error().mend;
  ASSERT_TRUE(run) << in_words(run.error());
  EXPECT_FALSE(run->record_problem);
  EXPECT_TRUE(fs::exists(folder / "b.wrec"));
}

TEST(RecordingFile, CannotReplaceAFileOrBeInAMissingFolder) {
  const TemporaryFolder folder;
  Puppet device(roaming);
  const auto attempt = [&](const std::string& file) {
    Stage stage(device, {.record = RecordTo{file, {}}});
    EXPECT_TRUE(stage.add(oil(1)));
    const auto result = stage.run({.seconds = 0.01, .virtual_time = true});
    return result ? "not refused" : in_words(result.error());
  };
  EXPECT_EQ(attempt(folder / "a.wrec"), "not refused");
  const auto before = bytes_of(folder / "a.wrec");
  EXPECT_EQ(attempt(folder / "a.wrec"),
            folder / "a.wrec" +
                ": the file exists already, and a recording never overwrites a file; delete it or choose another name");
  EXPECT_EQ(bytes_of(folder / "a.wrec"), before);
  EXPECT_EQ(attempt(folder / "none/a.wrec"), folder / "none/a.wrec" + ": there is no such folder; make it first");
  EXPECT_EQ(attempt(folder / "a.wrec/b.wrec"),
            folder / "a.wrec/b.wrec" + ": a part of the path is a file and no folder; choose another folder");
  EXPECT_EQ(attempt(folder.path().string()), folder.path().string() + ": this is a folder; name a new file in it, as in `" +
                                                 folder.path().string() + "/run.wrec`");
  EXPECT_EQ(attempt("/dev/full"),
            "/dev/full: this is a device or a pipe, and a recording is a regular file; name a file that does not exist yet");
  fs::create_symlink(folder / "nowhere", folder / "link");
  EXPECT_EQ(attempt(folder / "link"),
            folder / "link" + ": this is a link to a file that does not exist; name that file itself, or remove the link");
  const std::string long_name = folder / std::string(300, 'x');  // a file system's names have 255 bytes
  EXPECT_EQ(attempt(long_name), long_name + ": the name of the file is too long; choose a shorter one");
  device.profile_.mass = -1;
  Stage light(device, {.record = RecordTo{folder / "b.wrec", {}}});
  ASSERT_TRUE(light.add(oil(1)));
  const auto refused = light.run({.seconds = 0.01, .virtual_time = true});
  ASSERT_FALSE(refused);
  EXPECT_NE(in_words(refused.error()).find("the device's mass (kg)"), std::string::npos) << in_words(refused.error());
  EXPECT_FALSE(fs::exists(folder / "b.wrec"));
}

TEST(RecordingFile, NobodyMayWriteInItBeforeItIsComplete) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.wrec";
  const auto permissions = [&] { return static_cast<unsigned>(fs::status(file).permissions()); };
  const mode_t mask = umask(0027);
  Puppet device(roaming);
  Stage stage(device, {.record = RecordTo{file, {}}});
  ASSERT_TRUE(stage.add(oil(1)));
  std::vector<unsigned> during;
  run(stage, {.seconds = 0.5, .virtual_time = true, .progress = [&](const Now&) { during.push_back(permissions()); }});
  umask(mask);
  ASSERT_FALSE(during.empty());
  for (const unsigned each : during) EXPECT_EQ(each, 0440u);
  EXPECT_EQ(permissions(), 0640u);
}

TEST(RecordingFile, OnAFullDiskTheRunContinuesAndReportsTheRecordedTicks) {
  const TemporaryFolder folder;
  rlimit usual{};
  getrlimit(RLIMIT_FSIZE, &usual);
  rlimit small = usual;
  small.rlim_cur = first_chunk + 8 * chunk_size + 100;  // one chunk of events, seven of ticks
  for (const bool virtual_time : {true, false}) {
    Puppet device(roaming);
    if (!virtual_time) device.profile_.rate = 10000;
    const double seconds = (7 * ticks_per_chunk + 500) / device.profile_.rate;
    const std::string file = folder / (virtual_time ? "v.wrec" : "r.wrec");
    Stage stage(device, {.record = RecordTo{file, {}}});
    Patch patch = *stage.add(built_for(corduroy(1.934f), device.profile_));
    setrlimit(RLIMIT_FSIZE, &small);
    const RunResult done = run(stage, {.seconds = seconds, .virtual_time = virtual_time});
    setrlimit(RLIMIT_FSIZE, &usual);
    EXPECT_EQ(done.ticks_run + done.ticks_missed, static_cast<long>(7 * ticks_per_chunk + 500));
    if (static_cast<std::size_t>(done.ticks_run) <= 7 * ticks_per_chunk)
      continue;  // the machine was too busy and missed ticks
    ASSERT_TRUE(done.record_problem);
    EXPECT_EQ(done.record_problem->place.name, file);
    EXPECT_EQ(in_words_without_place(*done.record_problem),
              "the recording ends after " + std::to_string(7 * ticks_per_chunk) +
                  " ticks: the file would exceed the limit on its size (ulimit -f); "
                  "raise the limit or record elsewhere");
    const Recording recording = opened(file);
    EXPECT_EQ(recording.ticks(), 7 * ticks_per_chunk);
    EXPECT_FALSE(recording.complete());
    expect_same(recording);
  }
}

}  // namespace
}  // namespace wale::recording_files_test
