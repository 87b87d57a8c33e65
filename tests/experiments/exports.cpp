// Tables of trials, and their form in BIDS, written and read back.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "calibration/experiment/bids.hpp"
#include "tests/experiments/texts.hpp"
#include "tests/temporary_folder.hpp"
#include "wale/simulated.hpp"
#include "wale/stage.hpp"

namespace wale::experiments_test {
namespace {

/// A log as a session leaves it, line by line.
const std::string log_text = R"({"line":1,"time":"2026-11-24T20:31:00.000Z","seconds":0.0,"event":"begin","format":1,"participant":"S48","seed":7,"device":"sandpaper","file":"t.wale","versions":{"wale":"0.1.0"},"experiment":"my_test","grade":"simulated"}
{"line":2,"time":"2026-11-24T20:31:00.100Z","seconds":0.1,"event":"design","name":"my_test","task":"magnitude_estimation","method":"constant_stimuli","questions":[{"name":"response","says":"How rough?"},{"name":"sure","says":"How sure?"}],"closing":[],"presentation_seconds":3.0,"practice":1,"block":2,"text":"wale 1"}
{"line":3,"time":"2026-11-24T20:31:00.110Z","seconds":0.11,"event":"stimulus","name":"weak","levels":{"Amplitude":{"value":0.2,"unit":"N","text":"0.2 N"},"waveform":{"text":"sine"}}}
{"line":4,"time":"2026-11-24T20:31:00.120Z","seconds":0.12,"event":"stimulus","name":"strong","levels":{"Amplitude":{"value":2.0,"unit":"N","text":"2 N"},"waveform":{"text":"sine"}}}
{"line":5,"time":"2026-11-24T20:31:01.000Z","seconds":1.0,"event":"shown","what":"stimulus","name":"strong","number":1}
{"line":6,"time":"2026-11-24T20:31:05.000Z","seconds":5.0,"event":"answer","question":"response","about":"1","answer":"20"}
{"line":7,"time":"2026-11-24T20:31:06.000Z","seconds":6.0,"event":"answer","question":"sure","about":"1","answer":"n/a"}
{"line":8,"time":"2026-11-24T20:31:07.000Z","seconds":7.0,"event":"shown","what":"stimulus","name":"weak","number":2,"recording":"a.recordings/t0002.wrec"}
{"line":9,"time":"2026-11-24T20:31:11.500Z","seconds":11.5,"event":"answer","question":"response","about":"2","answer":"25"}
{"line":10,"time":"2026-11-24T20:31:12.000Z","seconds":12.0,"event":"taken back","answers":[9]}
{"line":11,"time":"2026-11-24T20:31:12.100Z","seconds":12.1,"event":"shown","what":"stimulus","name":"weak","number":2}
{"line":12,"time":"2026-11-24T20:31:16.100Z","seconds":16.1,"event":"answer","question":"response","about":"2","answer":"2.5"}
{"line":13,"time":"2026-11-24T20:31:18.000Z","seconds":18.0,"event":"answer","question":"sure","about":"2","answer":"80"}
{"line":14,"time":"2026-11-24T20:31:19.000Z","seconds":19.0,"event":"shown","what":"stimulus","name":"strong","number":3}
)";

const std::string golden_table =
    "participant\trun\ttrial\ttrial_type\tonset\tstimulus\tamplitude\twaveform\tresponse\tresponse_time\tsure\ttaken_back\t"
    "interrupted\texcluded\tdevice\tgrade\tstim_file\n"
    "S48\t0\t1\tpractice\t1\tstrong\t2\tsine\t20\t4\t n/a\t0\t0\tn/a\tsandpaper\tsimulated\tn/a\n"
    "S48\t1\t2\tmain\t7\tweak\t0.2\tsine\t2.5\t4\t80\t1\t0\tn/a\tsandpaper\tsimulated\tn/a\n"
    "S48\t1\t3\tmain\t19\tstrong\t2\tsine\tn/a\tn/a\tn/a\t0\t0\tn/a\tsandpaper\tsimulated\tn/a\n";

TrialTable table_of(const std::string& text) {
  const auto record = read_session_log(text, "a.trials");
  EXPECT_TRUE(record);
  const auto table = trial_table(*record, "a.trials");
  EXPECT_TRUE(table) << table.error().sentence;
  return table ? *table : TrialTable{};
}

TEST(TrialTables, AreThatOfTheLog) {
  const auto files = beh_files(table_of(log_text), 0);
  ASSERT_TRUE(files);
  ASSERT_EQ(files->size(), 2u);
  EXPECT_EQ(files->at(0).path, "sub-S48/beh/sub-S48_task-mytest_beh.tsv");
  EXPECT_EQ(files->at(0).text, golden_table);
  const auto sidecar = nlohmann::json::parse(files->at(1).text);
  EXPECT_EQ(sidecar["TaskName"], "mytest");
  EXPECT_EQ(sidecar["amplitude"]["Units"], "N");
  EXPECT_EQ(sidecar["response_time"]["Units"], "s");
  EXPECT_EQ(sidecar["grade"]["Levels"].size(), 2u);
  // Every column is described.
  for (const auto& each : table_of(log_text).columns) EXPECT_FALSE(sidecar[each.name]["Description"].empty()) << each.name;
}

TEST(TrialTables, AreReadBackAsTheyWere) {
  const TrialTable table = table_of(log_text);
  const auto files = beh_files(table, 2);
  ASSERT_TRUE(files);
  EXPECT_TRUE(files->at(0).path.ends_with("sub-S48_task-mytest_run-2_beh.tsv"));
  const auto back = read_beh(files->at(0).text, files->at(1).text, "x");
  ASSERT_TRUE(back) << back.error().sentence;
  EXPECT_EQ(*back, table);
  // Also with the line ends and the mark of a spreadsheet.
  std::string windows = "\xEF\xBB\xBF";
  for (const char c : files->at(0).text) windows += c == '\n' ? "\r\n" : std::string(1, c);
  const auto again = read_beh(windows, files->at(1).text, "x");
  ASSERT_TRUE(again);
  EXPECT_EQ(*again, table);
}

/// Nobody waits for a planted observer, so its times would mean nothing.
TEST(TrialTables, OfPlantedObserversHaveNoTimes) {
  const std::string note =
      "{\"line\":15,\"time\":\"2026-11-24T20:31:20.000Z\",\"seconds\":20.0,\"event\":\"note\",\"text\":\"observer planted\"}\n";
  const TrialTable table = table_of(log_text + note);
  EXPECT_EQ(table.rows.at(0).at(*table.column("response_time")), "");
  EXPECT_EQ(table_of(log_text).rows.at(0).at(*table.column("response_time")), "4");
}

TEST(TrialTables, MalformedOnesAreToldWithFileAndLine) {
  const std::string sidecar = R"({"TaskName":"t"})";
  const auto refused = [&](const std::string& table, const std::string& json, std::uint64_t line, const std::string& sentence) {
    const auto read = read_beh(table, json, "x_beh.tsv");
    ASSERT_FALSE(read) << table;
    EXPECT_EQ(read.error().code, Code::damaged_file);
    EXPECT_EQ(read.error().place.name, "x_beh.tsv");
    EXPECT_EQ(read.error().place.number, line) << table;
    EXPECT_EQ(read.error().sentence, sentence);
  };
  refused("", sidecar, 1, "the table is empty");
  refused("a\tb\n1\n", sidecar, 2, "expected 2 cells, found 1");
  refused("a\tb\n1\t2\n1\t2\t3\n", sidecar, 3, "expected 2 cells, found 3");
  refused("a\ta\n", sidecar, 1, "there are two columns `a`");
  refused("a\t\n", sidecar, 1, "a column has no name");
  refused("a\n\xff\n", sidecar, 1, "expected text in UTF-8, found other bytes");
  refused("a\n", "[1]", 0, "its sidecar is no JSON object");
  refused("a\n", "{", 0, "its sidecar is no JSON object");
  refused("a\n", "{}", 0, "its sidecar has no TaskName");
}

TEST(TrialTables, LogsOfSomethingElseAreRefused) {
  const auto refused = [](const std::string& text) {
    const auto record = read_session_log(text, "a");
    EXPECT_TRUE(record);
    const auto table = trial_table(*record, "a");
    EXPECT_FALSE(table);
    return table ? std::string() : table.error().sentence;
  };
  EXPECT_EQ(refused(log_text.substr(0, log_text.find('\n') + 1)), "this log is of no experiment");
  std::string other = log_text;
  other.replace(other.find("\"about\":\"1\""), 11, "\"about\":\"9\"");
  EXPECT_EQ(refused(other), "trial 9 was answered and not presented");
  std::string swapped = log_text;
  const std::string second = "\"name\":\"strong\",\"number\":3";
  swapped.replace(swapped.find(second), second.size(), "\"name\":\"weak\",\"number\":1");
  EXPECT_EQ(refused(swapped), "trial 1 is about `strong` and about `weak`");
}

TEST(Bids, LabelsAreLettersAndDigits) {
  EXPECT_EQ(bids_label("minsky1995_chapter5"), "minsky1995chapter5");
  TrialTable table = table_of(log_text);
  table.participant = "--";
  EXPECT_EQ(beh_files(table, 0).error().code, Code::malformed_value);
  const auto files = dataset_files({table_of(log_text), table_of(log_text)}, "study", "0.1.0");
  const auto description = nlohmann::json::parse(files.at(0).text);
  EXPECT_EQ(files.at(0).path, "dataset_description.json");
  EXPECT_EQ(description["Name"], "study");
  EXPECT_EQ(description["BIDSVersion"], "1.9.0");
  EXPECT_EQ(files.at(1).text, "participant_id\tgrade\nsub-S48\tsimulated\n") << "each participant once";
}

TEST(Bids, MotionHasAColumnForEachChannel) {
  const TemporaryFolder folder;
  const Design made(design("stimulus bench(amplitude: a)\nfactor a 0.8 N, 2 N\ntask rating"));
  const auto ready = made.ready();
  const DeviceProfile& profile = ready.stimuli[0].description().device;
  SimulatedJoystick joystick(profile, {0.55, 6.5, 135}, Lateral{0.04, 1});
  const std::string file = folder / "t.wrec";
  {
    Stage stage(joystick, {.record = RecordTo{file, "simulated, lateral"}});
    ASSERT_TRUE(stage.add(ready.stimuli[0]));
    ASSERT_TRUE(stage.run({.seconds = 0.5, .virtual_time = true}));
  }
  const auto recording = Recording::open(file);
  ASSERT_TRUE(recording);
  const auto files = motion_files(table_of(log_text), 0, {{2, 1, 7.0, *recording}});
  ASSERT_TRUE(files);
  ASSERT_EQ(files->size(), 3u);
  EXPECT_EQ(files->at(0).path, "sub-S48/motion/sub-S48_task-mytest_tracksys-handle_motion.tsv");
  const auto channels = std::ranges::count(files->at(2).text, '\n') - 1;
  const std::string first = files->at(0).text.substr(0, files->at(0).text.find('\n'));
  EXPECT_EQ(std::ranges::count(first, '\t') + 1, channels);
  EXPECT_TRUE(first.starts_with("7\t")) << "the time since the session began, and no header";
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(files->at(0).text, '\n')), recording->ticks());
  const auto sidecar = nlohmann::json::parse(files->at(1).text);
  EXPECT_EQ(sidecar["SamplingFrequency"], profile.rate);
  EXPECT_EQ(sidecar["MotionChannelCount"], channels);
  EXPECT_TRUE(motion_files(table_of(log_text), 0, {})->empty());
}

}  // namespace
}  // namespace wale::experiments_test
