// Recording and replaying runs, and feeling a file while it is edited.

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <thread>

#include "tests/command_line/child.hpp"

namespace wale::command_line::recording_test {
namespace {

const std::vector<std::string> quick{"--virtual-time", "--seconds", "2"};

Outcome feel(std::vector<std::string> words) {
  words.insert(words.begin(), "feel");
  words.insert(words.end(), quick.begin(), quick.end());
  return wale(words);
}

TEST(Record, ARecordingReplaysTheSame) {
  const TemporaryFolder folder;
  const std::string file = folder / "corduroy.wrec";
  const Outcome felt = feel({corduroy, "--set", "wale=4mm", "--max-force", "1.5 N", "--record", file});
  ASSERT_EQ(felt.status, 0) << felt.err;
  const Outcome replayed = wale({"replay", file});
  EXPECT_EQ(replayed.status, 0) << replayed.err;
  EXPECT_TRUE(contains(replayed.out, "a run on the sandpaper, simulated, lateral, 2 s of virtual time"))
      << replayed.out;
  EXPECT_TRUE(contains(replayed.out, "  ticks        1800 run, 0 missed, at 900 Hz\n")) << replayed.out;
  EXPECT_TRUE(contains(replayed.out, "  program      corduroy ")) << replayed.out;
  EXPECT_TRUE(contains(replayed.out, "  replay       the same, bit for bit\n")) << replayed.out;
  const auto json = wale({"replay", file, "--json"}).json();
  EXPECT_EQ(json["replay"]["same"], true);
  EXPECT_EQ(json["complete"], true);
  EXPECT_EQ(json["ticks"]["run"], 1800);
  EXPECT_EQ(json["changes"]["placed"], 1);
}

TEST(Record, IsWrittenAsATableAndAsSound) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.wrec", csv = folder / "a.csv", direct = folder / "b.csv", wav = folder / "a.wav";
  ASSERT_EQ(feel({corduroy, "--record", file}).status, 0);
  ASSERT_EQ(feel({corduroy, "--record", direct}).status, 0);
  const Outcome replayed = wale({"replay", file, "--csv", csv, "--wav", wav});
  ASSERT_EQ(replayed.status, 0) << replayed.err;
  // Both runs are the same in virtual time, so each line of the long table begins with the line of the short one.
  std::istringstream lines(bytes_of(csv)), direct_lines(bytes_of(direct));
  std::size_t count = 0;
  for (std::string line, begin; std::getline(direct_lines, begin); ++count) {
    ASSERT_TRUE(std::getline(lines, line));
    ASSERT_TRUE(line.starts_with(begin + ",")) << line;
  }
  EXPECT_EQ(count, 1801u);
  EXPECT_EQ(bytes_of(wav).substr(0, 4), "RIFF");
  EXPECT_EQ(bytes_of(wav).size(), 58u + 2 * 44100 * 8);
  // The table of a recording serves as the trace of a hand.
  EXPECT_EQ(feel({corduroy, "--hand", csv}).status, 0);
}

TEST(Record, ShippedMaterialsOfEveryKindReplayTheSame) {
  const TemporaryFolder folder;
  for (const char* material : {"fabric/velvet", "earth/sand", "mechanism/toggle", "mechanism/wall", "mechanism/spring",
                               "stone/slate", "fluid/oil", "glass/wet_glass", "metal/grille"}) {
    const std::string path = std::string(WALE_SOURCE_DIR) + "/library/" + material + ".wale",
                      file = folder / (fs::path(path).stem().string() + ".wrec");
    const Outcome felt = feel({path, "--hand", "circular", "--record", file});
    ASSERT_EQ(felt.status, 0) << felt.err;
    EXPECT_EQ(wale({"replay", file}).status, 0) << material;
  }
}

TEST(Record, ExistingFilesMissingFoldersAndOtherNamesAreRefused) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.wrec";
  ASSERT_EQ(feel({corduroy, "--record", file}).status, 0);
  const std::string before = bytes_of(file);
  const Outcome again = feel({corduroy, "--record", file});
  EXPECT_EQ(again.status, 1);
  EXPECT_TRUE(contains(again.err, "the file exists already")) << again.err;
  EXPECT_EQ(bytes_of(file), before);
  const std::string in_no_folder = folder / "none/a.wrec";
  const Outcome nowhere = feel({corduroy, "--record", in_no_folder});
  EXPECT_EQ(nowhere.status, 1);
  EXPECT_TRUE(contains(nowhere.err, ": " + in_no_folder + ": there is no such folder\n")) << nowhere.err;
  const Outcome odd = feel({corduroy, "--record", folder / "a.record"});
  EXPECT_EQ(odd.status, 2);
  EXPECT_TRUE(contains(odd.err, "NAME.wrec")) << odd.err;
}

TEST(Record, ATableThatCannotBeWrittenIsRefusedBeforeTheRun) {
  const TemporaryFolder folder;
  // The run would never end.
  const std::string file = folder / "none/a.csv";
  Child running({"feel", corduroy, "--device", "simulated", "--seconds", "inf", "--record", file}, folder / "out",
                folder / "err");
  int status = 0;
  ASSERT_TRUE(eventually([&] { return running.has_ended(status); }));
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_TRUE(contains(bytes_of(folder / "err"), "error[W0505]: " + file + ": ")) << bytes_of(folder / "err");
}

TEST(Record, TheReportIsPrintedAlsoWhereTheTableFails) {
  // The disk has room for a table when the run begins, and none when it ends.
  const TemporaryFolder folder;
  const std::string full = folder / "full.csv";
  fs::create_symlink("/dev/full", full);
  const Outcome outcome = feel({corduroy, "--record", full});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "error[W0505]: " + full + ": ")) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "corduroy on the simulated sandpaper")) << outcome.out;
}

TEST(Replay, DamagedFilesAndOtherFilesAreRefused) {
  const TemporaryFolder folder;
  const std::string file = folder / "a.wrec";
  ASSERT_EQ(feel({corduroy, "--record", file}).status, 0);
  std::string bytes = bytes_of(file);
  // Tick 1000 begins with its number plus 1, then its period.
  std::string begin(16, '\0');
  begin[0] = static_cast<char>(1001 & 0xff), begin[1] = 1001 >> 8;
  begin[8] = static_cast<char>(1000 & 0xff), begin[9] = 1000 >> 8;
  const std::size_t at = bytes.find(begin);
  ASSERT_NE(at, std::string::npos);
  bytes[at + 50] = static_cast<char>(bytes[at + 50] ^ 0x40);
  const std::string damaged = folder.write("damaged.wrec", bytes);
  const Outcome outcome = wale({"replay", damaged});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(contains(outcome.err, "tick 1000 (byte " + std::to_string(at) + ") is damaged")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "no more than 1000 ticks") && contains(outcome.err, "--ticks")) << outcome.err;
  EXPECT_EQ(wale({"replay", damaged, "--ticks", "1000"}).status, 0);
  const std::string empty = folder.write("empty.wrec", "");
  EXPECT_TRUE(contains(wale({"replay", empty}).err, empty + ": the file is empty")) << "no byte of it is at fault";
  EXPECT_TRUE(contains(wale({"replay", corduroy}).err, corduroy + ": expected a recording, found a Wale file"));
  const std::string program = folder / "corduroy.wpp";
  ASSERT_EQ(wale({"build", corduroy, "-o", program}).status, 0);
  EXPECT_TRUE(contains(wale({"replay", program}).err, program + ": expected a recording, found a patch program"));
  const std::string missing = folder / "none.wrec";
  EXPECT_EQ(wale({"replay", missing}).err, "wale: error[W0501]: " + missing +
                                               ": the file cannot be read: no such file\n"
                                               "  = help: name a recording, a .wrec file, that this user may read\n");
  EXPECT_EQ(wale({"replay"}).status, 2);
}

TEST(Blind, AllowsALargestForce) {
  const Outcome outcome = wale({"feel", corduroy, "--against", "denim", "--blind", "--trials", "1", "--device",
                                "simulated", "--seconds", "0.1", "--max-force", "0.5 N"},
                               "1\n");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
}

TEST(Watch, ActivatesEverySavedVersionUntilInterrupted) {
  const TemporaryFolder folder;
  const std::string file = folder.write("c.wale", bytes_of(corduroy)), err = folder / "err", out = folder / "out",
                    recording = folder / "a.wrec";
  Child running({"feel", file, "--watch", "--json", "--record", recording}, out, err);
  // Versions from before the first tick are in no tick of the recording.
  const auto is_felt = [&] {
    if (!fs::exists(recording)) return false;
    const Outcome so_far = wale({"replay", recording, "--json"});
    return so_far.out.starts_with("{") && so_far.json()["ticks"]["run"] > 0;
  };
  ASSERT_TRUE(eventually(is_felt)) << bytes_of(err);
  folder.write("c.wale", corduroy_with("2.5 mm in", "3.5 mm in"));
  ASSERT_TRUE(eventually([&] { return contains(bytes_of(err), "wale: the new version of `corduroy` is active\n"); }))
      << bytes_of(err);
  folder.write("c.wale", corduroy_with("2.5 mm in", "2.5 N in"));
  ASSERT_TRUE(eventually([&] { return contains(bytes_of(err), "wale: the previous version stays active\n"); }));
  EXPECT_TRUE(contains(bytes_of(err), "error[W0")) << bytes_of(err);
  folder.write("other.wale", corduroy_with("2.5 mm in", "4.5 mm in"));
  fs::rename(folder / "other.wale", folder / "c.wale");
  const auto swaps = [&] {
    const std::string said = bytes_of(err);
    return said.find("the new version") != said.rfind("the new version");
  };
  ASSERT_TRUE(eventually(swaps)) << bytes_of(err);
  running.tell(SIGINT);
  EXPECT_EQ(running.wait(), 0) << bytes_of(err);
  EXPECT_EQ(nlohmann::json::parse(bytes_of(out))["material"], "corduroy");
  const Outcome replayed = wale({"replay", recording, "--json"});
  EXPECT_EQ(replayed.status, 0) << replayed.err << replayed.out;
  EXPECT_EQ(replayed.json()["changes"]["swapped"], 2);
  EXPECT_EQ(replayed.json()["programs"].size(), 3u);
  EXPECT_EQ(replayed.json()["complete"], true);
}

TEST(Watch, EndsAfterTheGivenSeconds) {
  EXPECT_EQ(wale({"feel", corduroy, "--watch", "--seconds", "0.3"}).status, 0);
  EXPECT_EQ(wale({"feel", corduroy, "--watch", "--blind", "--against", corduroy}).status, 2);
}

}  // namespace
}  // namespace wale::command_line::recording_test
