// From files of trials to fits: which files belong together, adjustment, descriptions, and the groups of sorts.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "calibration/experiment/bids.hpp"
#include "calibration/experiment/trial_table.hpp"
#include "calibration/fit/chart.hpp"
#include "calibration/fit/study_fit.hpp"
#include "tests/experiments/texts.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::experiments_test {
namespace {

void write_text(const std::string& path, const std::string& text) {
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

/// The log of a session with two trials, by these words and times of the design.
std::string log_of(const std::string& participant, const std::string& question, double seconds,
                   const std::string& factor = "amplitude") {
  const std::string at = R"("time":"2026-11-24T20:31:00.000Z","seconds":1.0,)";
  std::string text = "{\"line\":1," + at + R"("event":"begin","format":1,"participant":")" + participant +
                     R"(","seed":7,"device":"sandpaper","file":"t.wale","versions":{"wale":"0.1.0"},"experiment":"bench","grade":"simulated"})" "\n";
  text += "{\"line\":2," + at + R"("event":"design","name":"bench","task":"magnitude_estimation","method":"constant_stimuli","questions":[{"name":"response","says":")" +
          question + R"("}],"closing":[],"presentation_seconds":)" + fmt::format("{}", seconds) + R"(,"practice":0,"block":2,"text":"wale 1"})" "\n";
  int line = 3;
  for (const auto& [name, value] : {std::pair("weak", 0.2), std::pair("strong", 2.0)})
    text += fmt::format(R"({{"line":{},{}"event":"stimulus","name":"{}","levels":{{"{}":{{"value":{},"unit":"N","text":"-"}}}}}})" "\n",
                        line++, at, name, factor, value);
  for (const auto& [name, number] : {std::pair("weak", 1), std::pair("strong", 2)}) {
    text += fmt::format(R"({{"line":{},{}"event":"shown","what":"stimulus","name":"{}","number":{}}})" "\n", line++, at, name, number);
    text += fmt::format(R"({{"line":{},{}"event":"answer","question":"response","about":"{}","answer":"{}"}})" "\n", line++, at, number, 5 * number);
  }
  return text;
}

/// The same session as a table of BIDS; the path of its table.
std::string bids_of(const TemporaryFolder& folder, const std::string& name, const std::string& log) {
  const auto record = read_session_log(log, name);
  const auto table = trial_table(*record, name);
  const auto files = beh_files(*table, 0);
  for (const BidsFile& each : *files) write_text(folder / (name + "/" + each.path), each.text);
  return folder / (name + "/" + files->front().path);
}

TEST(Studies, TablesOfTwoDesignsAreRefusedAsLogsAre) {
  const TemporaryFolder folder;
  const auto file = [&](const std::string& name, const std::string& text) {
    write_text(folder / name, text);
    return folder / name;
  };
  const std::string plain = log_of("A", "How rough?", 3);
  const std::string log = file("a.trials", plain), table = bids_of(folder, "a", plain);
  const auto sentence_of = [](const std::vector<std::string>& paths) {
    const auto study = read_study(paths, "");
    return study ? std::string("read") : study.error().sentence;
  };
  EXPECT_EQ(sentence_of({log, bids_of(folder, "b", log_of("B", "How rough?", 3))}), "read");
  EXPECT_EQ(sentence_of({table, bids_of(folder, "b", log_of("B", "How rough?", 3))}), "read");
  for (const std::string& first : {log, table})
    for (const auto& [other, words] :
         {std::pair(log_of("C", "How hard?", 3), "in its questions"), std::pair(log_of("C", "How rough?", 1), "in its time of a presentation"),
          std::pair(log_of("C", "How rough?", 3, "speed"), "`speed` was varied here, and `amplitude` in")}) {
      EXPECT_NE(sentence_of({first, bids_of(folder, "c", other)}).find(words), std::string::npos)
          << sentence_of({first, bids_of(folder, "c", other)});
      EXPECT_NE(sentence_of({first, file("c.trials", other)}).find(words), std::string::npos);
    }
  // Tables of other programs say less: BIDS has the question, PsychoPy the name of the experiment.
  const std::string foreign = bids_of(folder, "d", log_of("D", "How hard?", 3));
  const std::string sidecar = foreign.substr(0, foreign.size() - 4) + ".json";
  std::ifstream stream(sidecar);
  std::string json(std::istreambuf_iterator<char>(stream), {});
  json.replace(json.find("WaleDesign"), 10, "Unknown");
  write_text(sidecar, json);
  EXPECT_NE(sentence_of({table, foreign}).find("the question was \"How hard?\" here and \"How rough?\" in"), std::string::npos);
  const std::string rows = "participant,amp,answer,expName\nA,1,2,one\nA,2,4,one\n";
  const std::string one = file("one.csv", rows), two = file("two.csv", "participant,amp,answer,expName\nB,1,2,two\n"),
                    more = file("more.csv", "participant,amp,answer,expName,mood\nB,1,2,one,1\n");
  EXPECT_EQ(sentence_of({one, two}), "this row is of the experiment `two`, and those before are of `one`");
  const auto study = read_study({one, more}, "");
  ASSERT_TRUE(study);
  ASSERT_EQ(study->notes.size(), 1u);
  EXPECT_NE(study->notes[0].find("`mood` is in one of them only"), std::string::npos) << study->notes[0];
}

Result<StudyFit> fit_of(const std::string& text, FitRequest request, std::string* record = nullptr) {
  const TemporaryFolder folder;
  write_text(folder / "t.csv", text);
  auto study = read_study({folder / "t.csv"}, "");
  if (!study) return study.error();
  auto fit = fit_study(*study, request);
  if (fit && record != nullptr) {
    const auto made = record_of(*study, *fit, request);
    EXPECT_TRUE(made) << made.error().sentence;
    if (made) *record = *made;
  }
  return fit;
}

// What a log contains speaks louder than the word that somebody wrote into it.
TEST(Studies, AreGradedByTheWorstThatTheirFilesContain) {
  const TemporaryFolder folder;
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  const std::string note = R"({"line":9,"time":"2026-11-24T20:31:00.000Z","seconds":1.0,"event":"note","text":"observer planted:noise=0.2"})" "\n";
  const auto grade_of = [&](const std::string& grade, bool is_planted, bool by_bids) {
    std::vector<std::string> paths;
    for (const char* who : {"A", "B"}) {
      const std::string text = with(log_of(who, "How rough?", 3), R"(,"grade":"simulated")", grade) + (is_planted ? note : "");
      write_text(folder / who, text);
      paths.push_back(by_bids ? bids_of(folder, std::string("bids") + who, text) : folder / who);
    }
    const auto study = read_study(paths, "");
    if (!study) return study.error().sentence;
    const auto fit = fit_study(*study, {.task = "rating"});
    return fit ? fit->evidence : fit.error().sentence;
  };
  for (const bool by_bids : {false, true}) {
    EXPECT_EQ(grade_of(R"(,"grade":"measured")", false, by_bids), "measured");
    EXPECT_EQ(grade_of(R"(,"grade":"measured")", true, by_bids), "simulated");
    EXPECT_EQ(grade_of("", true, by_bids), "simulated");
    EXPECT_EQ(grade_of("", false, by_bids), "estimated");
  }
  EXPECT_EQ(grade_of(R"(,"grade":"pilot")", false, false), "expected measured or simulated for the grade, found `pilot`");
  // A column that was taken out of a table, and a sidecar that still says what it was.
  std::vector<std::string> paths;
  for (const char* who : {"A", "B"}) {
    paths.push_back(bids_of(folder, std::string("taken") + who, log_of(who, "How rough?", 3)));
    std::ifstream stream(paths.back());
    std::string text(std::istreambuf_iterator<char>(stream), {});
    text = with(text, "grade", "said");
    write_text(paths.back(), text);
  }
  const auto study = read_study(paths, "");
  ASSERT_TRUE(study) << study.error().sentence;
  const auto fit = fit_study(*study, {.task = "rating"});
  ASSERT_TRUE(fit) << fit.error().sentence;
  EXPECT_EQ(fit->evidence, "simulated");
}

/// By hand: the observers' geometric means of 0.8 N are 0.8, 0.9 and 1 N.
TEST(Adjustments, GivePointsOfEqualityAndAThreshold) {
  std::string text = "participant,amplitude (N),standard,response\n";
  for (const auto& [who, at] : {std::pair("A", 0.8), std::pair("B", 0.9), std::pair("C", 1.0)})
    for (const double factor : {1.25, 0.8, 1.25, 0.8}) {
      const double setting = at * factor;
      text += fmt::format("{},{},bench(amplitude: 0.8 N),{}\n", who, setting, setting);
    }
  std::string record;
  const auto fit = fit_of(text, {.task = "adjustment", .columns = {.sizes = {{"amplitude", "amplitude (N)", "N"}}}}, &record);
  ASSERT_TRUE(fit) << fit.error().sentence;
  ASSERT_EQ(fit->settings.size(), 1u);
  EXPECT_EQ(*fit->settings[0].size, 0.8);
  const auto& settings = fit->settings[0].settings;
  const double mean = std::cbrt(0.8 * 0.9 * 1.0);
  EXPECT_NEAR(settings.equal, mean, 1e-9);
  // Student's t of three: 4.3027 standard errors of log 0.8, log 0.9 and log 1, whose deviation is 0.111636.
  EXPECT_NEAR(settings.equal_interval.high / mean, std::exp(4.302653 * 0.111636 / std::sqrt(3.0)), 1e-4);
  // Four settings of log(1.25) to either side: a sum of squares of 4 log(1.25)^2 on three degrees of freedom each.
  EXPECT_NEAR(*settings.scatter, std::log(1.25) * std::sqrt(4.0 / 3), 1e-9);
  EXPECT_EQ(settings.freedom, 9);
  // chi-squared of 9: 2.7004 and 19.0228.
  EXPECT_NEAR(settings.scatter_interval.low, *settings.scatter * std::sqrt(9 / 19.0228), 1e-4);
  EXPECT_NEAR(settings.scatter_interval.high, *settings.scatter * std::sqrt(9 / 2.70039), 1e-4);
  EXPECT_NE(record.find("task        adjustment"), std::string::npos) << record;
  EXPECT_NE(record.find("weber       0.257664"), std::string::npos) << record;
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver({});
  check_source(sources, sources.add("t.wale", record), *resolver, diagnostics);
  for (const auto& each : diagnostics.all())
    if (severity_of(each.code) == Severity::error && each.message.find("device") == std::string::npos) ADD_FAILURE() << each.message;
  EXPECT_EQ(charts_of(*fit, FitModel::mixed).size(), 1u);
}

/// Three people who all set two of four to either side of 1 N, on steps of 5 %: equal means, and nothing between is seen.
TEST(Adjustments, OnStepsHaveTheErrorOfAStep) {
  std::string text = "participant,amplitude (N),response\n";
  for (const char* who : {"A", "B", "C"})
    for (const double setting : {1.0, 1.05, 1.0, 1.05}) text += fmt::format("{},{},{}\n", who, setting, setting);
  const FitRequest request{.task = "adjustment", .columns = {.sizes = {{"amplitude", "amplitude (N)", "N"}}}};
  const auto fit = fit_of(text, request);
  ASSERT_TRUE(fit) << fit.error().sentence;
  const auto& settings = fit->settings[0].settings;
  const double step = std::log(1.05), error = step / std::sqrt(12.0), mean = std::sqrt(1.05);
  ASSERT_TRUE(settings.step);
  EXPECT_NEAR(*settings.step, step, 1e-9);
  EXPECT_NEAR(settings.equal, mean, 1e-9);
  EXPECT_NEAR(settings.equal_interval.high, mean * std::exp(4.302653 * error), 1e-6);
  EXPECT_NEAR(settings.equal_interval.low, mean * std::exp(-4.302653 * error), 1e-6);
  const double high = step / 2 * std::sqrt(12.0 / 9) * std::sqrt(9 / 2.70039);
  EXPECT_NEAR(fit->settings_interval.high, std::sqrt(high * high + error * error), 1e-5);
  EXPECT_EQ(std::ranges::count_if(fit->notes, [](const std::string& each) { return each.find("steps of 4.88 %") != std::string::npos; }), 1);
  // Settings that are anywhere are no steps, nor are some that are alike by chance.
  std::string free = "participant,amplitude (N),response\n";
  for (const double setting : {1.0, 1.05, 1.0, 1.13, 1.031, 1.05, 1.13, 1.031}) free += fmt::format("A,{},{}\n", setting, setting);
  const auto without = fit_of(free, request);
  ASSERT_TRUE(without);
  EXPECT_FALSE(without->settings[0].settings.step);
}

TEST(Adjustments, OneSettingEachTellsNoScatter) {
  const auto fit = fit_of("participant,amplitude (N),response\nA,1,1\nB,1.2,1.2\n",
                          {.task = "adjustment", .columns = {.sizes = {{"amplitude", "amplitude (N)", "N"}}}});
  ASSERT_TRUE(fit) << fit.error().sentence;
  EXPECT_NE(fit->no_record.find("nobody set one standard twice"), std::string::npos);
  const auto zero = fit_of("participant,amplitude (N),response\nA,1,1\nB,0,0\n",
                           {.task = "adjustment", .columns = {.sizes = {{"amplitude", "amplitude (N)", "N"}}}});
  ASSERT_FALSE(zero);
  EXPECT_EQ(zero.error().place.number, 3u);
}

/// Answers to two differences from 1 N in two intervals, by person: right ones of 40.
std::string two_intervals(const std::vector<std::vector<int>>& right, const std::vector<double>& sizes) {
  std::string text = "participant,amplitude,correct\n";
  for (std::size_t person = 0; person < right.size(); ++person)
    for (std::size_t i = 0; i < sizes.size(); ++i)
      for (int trial = 0; trial < 40; ++trial)
        text += fmt::format("P{},{},{}\n", person, sizes[i], trial < right[person][i] ? 1 : 0);
  return text;
}

TEST(Thresholds, AreRecordedOnlyWhereTheAnswersBoundThem) {
  FitRequest request{.task = "two_interval", .columns = {.sizes = {{"amplitude", "", "N"}}}};
  request.standard = 1;
  std::string record;
  const std::vector<double> sizes = {1.05, 1.1, 1.2, 1.4};
  const auto fit = fit_of(two_intervals({{23, 27, 34, 40}, {24, 28, 35, 40}, {20, 21, 19, 20}}, sizes), request, &record);
  ASSERT_TRUE(fit) << fit.error().sentence;
  EXPECT_EQ(fit->no_record, "");
  EXPECT_EQ(fit->thresholds[0].count, 2u);
  EXPECT_NE(record.find("  observers   2\n"), std::string::npos) << "one of three is left out\n" << record;
  // Two people who differ much: Student's interval of two is without ends.
  const auto unbounded = fit_of(two_intervals({{38, 40, 40, 40}, {21, 22, 23, 28}}, sizes), request);
  ASSERT_TRUE(unbounded) << unbounded.error().sentence;
  EXPECT_EQ(unbounded->no_record, "the answers do not bound the threshold on both sides");
}

TEST(Descriptions, AreCountedByStimulusAndCoded) {
  const std::string text =
      "participant,stimulus,response\nA,ribs,\"Rough, like sand-paper; rough!\"\nB,ribs,rough and sharp\n"
      "C,ribs,fine sand\nA,oil,slippery\nB,oil,Very slippery wet\nC,oil,\xc3\xa9pais\n";
  const auto words = fit_of(text, {.task = "description"});
  ASSERT_TRUE(words) << words.error().sentence;
  const DescriptionFit& described = *words->descriptions;
  ASSERT_EQ(described.names.size(), 2u);
  const std::size_t ribs = described.names[0] == "ribs" ? 0 : 1;
  EXPECT_EQ(described.stimuli[ribs].descriptions, 3u);
  EXPECT_EQ(described.stimuli[ribs].words.at("rough"), 2u) << "twice in one description counts once";
  EXPECT_EQ(described.stimuli[ribs].words.at("sand-paper"), 1u);
  EXPECT_EQ(described.stimuli[1 - ribs].words.at("\xc3\xa9pais"), 1u);
  FitRequest request{.task = "description"};
  request.codes = {{{"rough"}, "rough"}, {{"sharp"}, "rough"}, {{"fine", "sand"}, "fine"}, {{"fine"}, "rough"},
                   {{"slippery"}, "slippery"}};
  std::string record;
  const auto coded = fit_of(text, request, &record);
  ASSERT_TRUE(coded);
  EXPECT_EQ(coded->descriptions->stimuli[ribs].codes, (std::map<std::string, std::size_t>{{"fine", 1}, {"rough", 2}}));
  EXPECT_EQ(coded->descriptions->stimuli[1 - ribs].codes, (std::map<std::string, std::size_t>{{"slippery", 2}}));
  EXPECT_NE(record.find("case        \"rough\", kind ribs, says \"rough 2, fine 1 of 3 descriptions\""), std::string::npos) << record;
}

/// Six stimuli: three of a small amplitude. All sorts into two go by amplitude; sorts into three part the small ones.
TEST(Sorts, HaveAMapAndGroupsOfEachNumber) {
  std::string text = "participant,run,stimulus,amplitude,period,response\n";
  const auto sort = [&](const char* who, int run, const std::vector<int>& groups) {
    for (int i = 0; i < 6; ++i)
      text += fmt::format("{},{},s{},{},{},{}\n", who, run, i, i < 3 ? 1 : 8, i % 3 + 1, groups[static_cast<std::size_t>(i)]);
  };
  for (const char* who : {"A", "B", "C"}) sort(who, 1, {1, 1, 1, 2, 2, 2});
  sort("A", 2, {1, 1, 2, 3, 3, 3}), sort("B", 2, {1, 1, 2, 3, 3, 3}), sort("C", 2, {1, 2, 2, 3, 3, 3});
  const auto fit = fit_of(text, {.task = "sorting", .columns = {.sizes = {{"amplitude", "", "N"}, {"period", "", "mm"}}}});
  ASSERT_TRUE(fit) << fit.error().sentence;
  const SortingFit& sorting = *fit->sorting;
  ASSERT_EQ(sorting.by_groups.size(), 2u);
  EXPECT_EQ(sorting.by_groups[0].clusters, (analysis::Grouping{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(sorting.by_groups[0].distances, (std::vector<std::size_t>{0, 0, 0}));
  EXPECT_EQ(sorting.by_groups[1].clusters, (analysis::Grouping{0, 0, 1, 2, 2, 2}));
  EXPECT_EQ(sorting.by_groups[1].distances, (std::vector<std::size_t>{0, 0, 1})) << "C would have to move one";
  ASSERT_TRUE(sorting.map);
  const auto& at = sorting.map->points;
  EXPECT_LT((at.row(0) - at.row(1)).norm(), (at.row(0) - at.row(3)).norm());
  std::vector<std::string> files;
  for (const Chart& each : charts_of(*fit, FitModel::mixed)) {
    files.push_back(each.file);
    EXPECT_TRUE(draw_chart(each)) << each.file;
  }
  EXPECT_EQ(files, (std::vector<std::string>{"tree", "map", "groups-2", "groups-3"}));
}

}  // namespace
}  // namespace wale::experiments_test
