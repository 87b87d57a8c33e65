// `wale calibrate fit` and `wale experiment plan`: from trials to a map, a threshold or a rule.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/command_line/running.hpp"

namespace wale::command_line::fitting_test {
namespace {

const std::string designs = std::string(WALE_SOURCE_DIR) + "/calibration/experiments/";

/// A session of a planted observer, without recordings.
std::string session(const TemporaryFolder& folder, const std::string& design, const std::string& experiment, int person,
                    const std::string& law) {
  const std::string log = folder / (experiment + "-P" + std::to_string(person) + ".trials");
  const Outcome ran = wale({"experiment", "run", designs + design, "--experiment", experiment, "--participant",
                            "P" + std::to_string(person), "--observer", "planted:" + law, "--seed",
                            std::to_string(person), "--unrecorded", "--log", log});
  EXPECT_EQ(ran.status, 0) << ran.err;
  return log;
}

/// Trials of four observers with exponent 0.5 exactly, and a scatter that is balanced over their runs.
std::string table(const std::string& separator = ",", bool comma = false) {
  std::string text = "participant,run,trial,amplitude,response\n";
  const double sizes[] = {0.2, 0.4, 0.8, 1.6, 3.2};
  for (int person = 1; person <= 4; ++person)
    for (int run = 1; run <= 2; ++run)
      for (int i = 0; i < 5; ++i)
        text += "S" + std::to_string(person) + "," + std::to_string(run) + "," + std::to_string(i + 1) + "," +
                std::to_string(sizes[i]) + "," +
                std::to_string(10 * person * std::sqrt(sizes[i]) * std::pow(10, run == 1 ? 0.01 : -0.01)) + "\n";
  std::string out;
  for (const char c : text) out += c == ',' ? separator : c == '.' && comma ? "," : std::string(1, c);
  return out;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

const std::vector<std::string> as_magnitudes = {"--task", "magnitude_estimation", "--size", "amplitude:N"};

Outcome fit(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.begin(), {"calibrate", "fit"});
  words.insert(words.end(), more.begin(), more.end());
  return wale(words);
}

TEST(Fitting, MapOfPlantedObserversHoldsTheirExponentAndIsSimulated) {
  const TemporaryFolder folder;
  std::vector<std::string> words = {"calibrate", "fit"};
  for (int person = 1; person <= 4; ++person)
    words.push_back(
        session(folder, "crossed.wale", "crossed", person, "exponent=0.55,noise=0.2,threshold=0,feels=actuator"));
  words.insert(words.end(), {"-o", folder / "map.wale", "--plots", folder / "plots", "--json"});
  const Outcome fitted = wale(words);
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  const auto json = fitted.json();
  EXPECT_LE(json["magnitudes"]["exponent"]["low"], 0.55);
  EXPECT_GE(json["magnitudes"]["exponent"]["high"], 0.55);
  EXPECT_LT(json["magnitudes"]["exponent"]["high"].get<double>() - json["magnitudes"]["exponent"]["low"].get<double>(),
            0.2);
  EXPECT_EQ(json["evidence"], "simulated");
  EXPECT_EQ(json["exclusions"].size(), 4u * 6);  // practice
  const std::string record = bytes_of(folder / "map.wale");
  EXPECT_EQ(json["record"], record);
  EXPECT_TRUE(contains(record, "slope simulated, anchor simulated, handle simulated")) << record;
  EXPECT_TRUE(contains(record, "valid       amplitude 0.2 N .. 2 N, period 0.0012 m .. 0.005 m")) << record;
  EXPECT_TRUE(contains(record, "Programs felt:"));
  for (const char* each : {"law", "residuals", "answers", "observers"}) {
    EXPECT_TRUE(bytes_of(folder / ("plots/" + std::string(each) + ".png")).starts_with("\x89PNG"));
    EXPECT_TRUE(contains(bytes_of(folder / ("plots/" + std::string(each) + ".svg")), "<svg"));
  }
  // The same trials give the same file, also by way of BIDS, which says no programs.
  const Outcome again = wale(words);
  EXPECT_EQ(again.out, fitted.out);
  std::vector<std::string> exporting = {"experiment", "export"};
  exporting.insert(exporting.end(), words.begin() + 2, words.begin() + 6);
  exporting.insert(exporting.end(), {"-o", folder / "bids", "--without-motion"});
  ASSERT_EQ(wale(exporting).status, 0);
  // What somebody else has written stays: a README of the data set, and all of a folder that holds none.
  const std::string readme = folder.write("bids/README", "what we found\n");
  EXPECT_EQ(wale(exporting).status, 0);
  EXPECT_EQ(bytes_of(readme), "what we found\n");
  fs::create_directory(folder / "project");
  const std::string other = folder.write("project/dataset_description.json", "{\"GeneratedBy\": [{\"Name\": \"us\"}]}\n");
  std::vector<std::string> into_project = exporting;
  into_project[into_project.size() - 2] = folder / "project";
  const Outcome refused = wale(into_project);
  EXPECT_EQ(refused.status, 1);
  EXPECT_TRUE(contains(refused.err, "W0505")) << refused.err;
  EXPECT_EQ(bytes_of(other), "{\"GeneratedBy\": [{\"Name\": \"us\"}]}\n");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "project"), {}), 1);
  std::vector<std::string> of_tables;
  for (int person = 1; person <= 4; ++person)
    of_tables.push_back(folder / ("bids/sub-P" + std::to_string(person) + "/beh/sub-P" + std::to_string(person) +
                                  "_task-crossed_beh.tsv"));
  const Outcome by_bids = fit(of_tables, {"--json"});
  ASSERT_EQ(by_bids.status, 0) << by_bids.err;
  EXPECT_EQ(by_bids.json()["magnitudes"], json["magnitudes"]);
}

TEST(Fitting, WritesNoRecordThatDoesNotCompile) {
  const TemporaryFolder folder;
  const std::string trials = folder.write("study.csv", table());
  const std::string map = folder / "map.wale";
  for (const auto& [more, option] :
       {std::pair(std::vector<std::string>{"--size", "amplitude:N", "--of", "nonsense"}, "--of: "),
        std::pair(std::vector<std::string>{"--size", "amplitude:N", "--domain", "nonsense"}, "--domain: "),
        std::pair(std::vector<std::string>{"--size", "amplitude:N", "--domain", "grating, crest 3 .. 1"}, "--domain: "),
        std::pair(std::vector<std::string>{"--size", "amplitude:foo"}, "--size: "),
        std::pair(std::vector<std::string>{"--size", "amplitude:mm"}, "--size: "),
        std::pair(std::vector<std::string>{"--size", "amp=amplitude:N"}, "--size: ")}) {
    std::vector<std::string> words = {"calibrate", "fit", trials, "--task", "magnitude_estimation", "-o", map};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome refused = wale(words);
    EXPECT_EQ(refused.status, 1) << option << refused.err;
    EXPECT_TRUE(contains(refused.err, option)) << refused.err;
    EXPECT_TRUE(contains(refused.err, "the record does not compile")) << refused.err;
    EXPECT_FALSE(fs::exists(map)) << option;
  }
}

TEST(Fitting, CompilesWithTheMapToTheForceThatItsLawDemands) {
  const TemporaryFolder folder;
  const std::string trials = folder.write("study.csv", table());
  const std::string map = folder / "map.wale";
  const Outcome fitted =
      fit({trials, "-o", map, "--name", "bench.half", "--domain", "grating, one_dimensional, alone"}, as_magnitudes);
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  EXPECT_TRUE(contains(fitted.out, "exponent       0.5,")) << fitted.out;
  EXPECT_TRUE(contains(bytes_of(map), "slope estimated, anchor estimated")) << "nobody says on which device";
  const std::string material = corduroy_with("roughness 0.6 estimated", "roughness 0.6 estimated, by bench.half");
  const std::string whole = folder.write("whole.wale", bytes_of(map) + material.substr(material.find("///")));
  const Outcome described = wale({"describe", whole, "--material", "corduroy", "--json"});
  ASSERT_EQ(described.status, 0) << described.err;
  // Level 1 of roughness is 194 of Minsky's program units, 512 of which are 10 N; levels are magnitudes over its one.
  const double amplitude = 194 * 10.0 / 512 * std::pow(0.6, 1 / 0.5);
  EXPECT_TRUE(contains(described.out, "bench.half")) << described.out;
  EXPECT_NEAR(described.json()["percepts"]["roughness"]["size"].get<double>(), amplitude, 1e-3) << described.out;
}

TEST(Fitting, ThesissWayIsLeastSquaresOfMeans) {
  const TemporaryFolder folder;
  const std::string trials = folder.write("study.csv", table());
  for (const std::string model : {"mixed", "thesis", "thesis_equalised"}) {
    const Outcome fitted = fit({trials, "--model", model, "--json"}, as_magnitudes);
    ASSERT_EQ(fitted.status, 0) << fitted.err;
    EXPECT_NEAR(fitted.json()["magnitudes"]["exponent"]["value"].get<double>(), 0.5, 1e-6) << model;
    // log10 of 10, 20, 30 and 40 in the mean
    EXPECT_NEAR(fitted.json()["magnitudes"]["constant"]["value"].get<double>(), 1 + std::log10(24) / 4, 1e-6) << model;
  }
}

TEST(Fitting, ReadsTablesOfOtherPrograms) {
  const TemporaryFolder folder;
  const std::string wide =
      "\xEF\xBB\xBF" + replaced(replaced(table(";", true), "participant", "id"), "response", "slider.response");
  const Outcome fitted = fit(
      {folder.write("wide.csv", wide), "--participant", "id", "--answer", "slider.response", "--json"}, as_magnitudes);
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  EXPECT_NEAR(fitted.json()["magnitudes"]["exponent"]["value"].get<double>(), 0.5, 1e-6);
}

TEST(Fitting, BadTrialsAreRefusedWithFileAndRow) {
  const TemporaryFolder folder;
  const std::string good = table();
  struct Bad {
    std::string text, says;
    int status = 1;
  };
  const std::string third = "S1,1,3,0.800000,";
  const std::string one = good.substr(0, good.find("S2,"));
  const Bad all[] = {
      {replaced(good, third, "S1,1,3,0.800000,rough #"), ".csv:4: "},
      {replaced(good, third + "9", "S1,1,3,0.800000,-9"), ".csv:4: "},
      {replaced(good, "S1,1,3", "S1,1,2"), ".csv:4: "},
      {replaced(good, third, "S1,1,3,0.8 mN,"), "two units"},
      {replaced(good, third, "S1,1,3,,"), "the amplitude is missing"},
      {replaced(good, "amplitude", "force"), "there is no column `amplitude`", 2},
      {one, "by one observer, S1"},
      {"", "bad.csv"},
  };
  for (const Bad& each : all) {
    const Outcome refused = fit({folder.write("bad.csv", each.text)}, as_magnitudes);
    EXPECT_EQ(refused.status, each.status) << each.text;
    EXPECT_TRUE(contains(refused.err, each.says)) << "expected `" << each.says << "`\n" << refused.err;
    EXPECT_TRUE(contains(refused.err, "bad.csv")) << refused.err;
  }
  std::string same = good;
  for (const char* size : {"0.200000", "0.400000", "1.600000", "3.200000"})
    while (contains(same, size)) same = replaced(same, size, "0.800000");
  EXPECT_TRUE(
      contains(fit({folder.write("bad.csv", same)}, as_magnitudes).err, "the amplitude is 0.8 N in all 40 trials"));
  // A device that changed between the sessions.
  std::string devices = replaced(good, "response", "response,device");
  std::string with;
  std::istringstream lines(devices);
  int number = 0;
  for (std::string line; std::getline(lines, line); ++number)
    with += line + (number == 0 ? "" : number < 20 ? ",stick" : ",pad") + "\n";
  const Outcome changed = fit({folder.write("bad.csv", with)}, as_magnitudes);
  EXPECT_TRUE(contains(changed.err, "the device is `pad` here and `stick` in row 2")) << changed.err;
  EXPECT_TRUE(contains(changed.err, "bad.csv:21")) << changed.err;
  const Outcome twice = fit({folder.write("good.csv", good), folder.write("copy.csv", good)}, as_magnitudes);
  EXPECT_EQ(twice.status, 2);
  EXPECT_TRUE(contains(twice.err, "has the same trials as")) << twice.err;
  EXPECT_EQ(fit({folder / "good.csv", "--of", "a b"}, as_magnitudes).status, 2);
  EXPECT_EQ(fit({folder / "good.csv"}, {"--size", "amplitude:N"}).status, 2) << "the task is not known";
}

TEST(Fitting, ExclusionsAreListedWithTheirRule) {
  const TemporaryFolder folder;
  const std::string text =
      replaced(replaced(table(), "S1,1,3,0.800000,", "S1,1,3,0.800000,-"), "S4,2,5,3.200000,", "S4,2,5,3.200000,n/a#");
  const std::string trials = folder.write("study.csv", text.substr(0, text.find("n/a#")) + "n/a\n");
  const Outcome fitted = fit({trials, "--leave-out-nonpositive", "--drop", "participant=S3"}, as_magnitudes);
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  EXPECT_TRUE(contains(fitted.out, "12 rows")) << fitted.out;
  EXPECT_TRUE(contains(fitted.out, "1 by the rule: magnitudes of zero or below")) << fitted.out;
  EXPECT_TRUE(contains(fitted.out, "1 by the rule: no answer")) << fitted.out;
  EXPECT_TRUE(contains(fitted.out, "10 by the rule: only rows whose participant is not S3")) << fitted.out;
}

TEST(Fitting, HostileTextInATableForgesNothing) {
  const TemporaryFolder folder;
  std::string text = table();
  while (contains(text, "S2,")) text = replaced(text, "S2,", "\x1b[31m\"}material,");
  const Outcome fitted = fit({folder.write("study.csv", text), "-o", folder / "map.wale"}, as_magnitudes);
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  EXPECT_FALSE(contains(fitted.out, "\x1b"));
  EXPECT_EQ(wale({"check", folder / "map.wale"}).status, 0);
}

TEST(Fitting, ChoicesGiveAThresholdThatCompiles) {
  const TemporaryFolder folder;
  std::vector<std::string> logs;
  for (int person = 1; person <= 2; ++person)
    logs.push_back(session(folder, "detection_amplitude.wale", "detection", person, "feels=actuator"));
  logs.insert(logs.end(), {"-o", folder / "threshold.wale", "--json"});
  const Outcome fitted = fit(logs, {});
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  const auto threshold = fitted.json()["thresholds"][0]["threshold"];
  EXPECT_GT(threshold["value"], 0.02);
  EXPECT_LT(threshold["value"], 0.2);
  const std::string record = bytes_of(folder / "threshold.wale");
  EXPECT_TRUE(contains(record, "threshold amplitude {")) << record;
  EXPECT_TRUE(contains(record, "slope simulated, handle simulated")) << record;
  EXPECT_EQ(wale({"check", folder / "threshold.wale"}).status, 0);
}

TEST(Fitting, ThresholdOfCountsIsTheirs) {
  // Three observers with the same right answers: a Weibull function with its 75 % at a fraction of 0.2.
  std::string text = "participant,run,trial,ratio,correct\n";
  for (const char* person : {"A", "B", "C"}) {
    int trial = 0;
    for (const double fraction : {0.05, 0.1, 0.2, 0.4, 0.8}) {
      const double p = 0.5 + 0.5 * (1 - std::exp(-std::log(2) * std::pow(fraction / 0.2, 2)));
      for (int i = 0; i < 200; ++i)
        text += std::string(person) + ",1," + std::to_string(++trial) + "," + std::to_string(1 + fraction) + "," +
                (i < std::lround(200 * p) ? "1" : "0") + "\n";
    }
  }
  const TemporaryFolder folder;
  const Outcome fitted =
      fit({folder.write("study.csv", text), "--task", "two_interval", "--size", "ratio", "--of", "amplitude", "--json"},
          {});
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  // d' is 1 a little above 75 %, where it is 0.954: there the same function is 0.5 (1 - exp(…)) = 0.2602.
  const double expected = 0.2 * std::sqrt(-std::log1p(-2 * 0.2602499) / std::log(2));
  // A power of the difference for d' is nearly that function: its threshold is 2.6 % off.
  EXPECT_NEAR(fitted.json()["weber"]["fraction"].get<double>(), expected, 0.03 * expected);
}

TEST(Fitting, ObserverWithFewAnswersIsSaidAndPrintsNoNan) {
  const TemporaryFolder folder;
  const std::string whole = table(), one = whole.substr(0, whole.find("S2,")) + "S2,1,1,0.400000,4\n";
  const Outcome refused = fit({folder.write("one.csv", one)}, as_magnitudes);
  EXPECT_EQ(refused.status, 1) << refused.err;
  EXPECT_TRUE(contains(refused.err, "W0802")) << refused.err;
  EXPECT_TRUE(contains(refused.err, "1 of 2 observers answered about two sizes or more")) << refused.err;
  const Outcome fitted = fit({folder.write("five.csv", whole + "S5,1,1,0.400000,4\n")}, as_magnitudes);
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  EXPECT_FALSE(contains(fitted.out, "nan")) << fitted.out;
  EXPECT_TRUE(contains(fitted.out, "no exponent: answers about one size, 1 answer\n")) << fitted.out;
  EXPECT_TRUE(contains(fitted.out, "note: S5 has answers about one size alone")) << fitted.out;
}

TEST(Fitting, StandardOfTheTableIsUsedAndCatchTrialsAreNoExclusions) {
  const TemporaryFolder folder;
  std::string two = "participant,standard,amplitude,correct\n", one = "participant,target,amplitude,response,correct\n";
  const int right[] = {12, 14, 17, 19};
  const double differences[] = {0.05, 0.1, 0.2, 0.4};
  for (const char* person : {"A", "B", "C"})
    for (int level = 0; level < 4; ++level)
      for (int i = 0; i < 20; ++i) {
        const bool is_right = i < right[level] + (person[0] == 'A' ? 1 : 0);
        two += std::string(person) + ",0.8," + std::to_string(0.8 * (1 + differences[level])) + "," + (is_right ? "1\n" : "0\n");
        one += std::string(person) + ",1," + std::to_string(differences[level]) + (is_right ? ",yes,1\n" : ",no,0\n");
        one += std::string(person) + (i < 4 ? ",0,n/a,yes,0\n" : ",0,n/a,no,1\n");
      }
  const std::string trials = folder.write("two.csv", two);
  const std::vector<std::string> how = {"--task", "two_interval", "--size", "amplitude:N"};
  const Outcome plain = fit({trials, "-o", folder / "two.wale"}, how);
  ASSERT_EQ(plain.status, 0) << plain.err;
  EXPECT_TRUE(contains(plain.out, "thresholds are fractions of the standard, 0.8 N")) << plain.out;
  EXPECT_TRUE(contains(bytes_of(folder / "two.wale"), "valid       0.8 N .. 1.12 N")) << bytes_of(folder / "two.wale");
  EXPECT_EQ(wale({"check", folder / "two.wale"}).status, 0);
  const Outcome other = fit({trials, "--standard", "0.7"}, how);
  EXPECT_TRUE(contains(other.out, "the column `standard` says 0.8, and --standard 0.7")) << other.out << other.err;
  const Outcome detected =
      fit({folder.write("one.csv", one), "--standard", "0"}, {"--task", "one_interval", "--size", "amplitude:N"});
  // These answers bound no threshold, which is said; what was counted is told all the same.
  EXPECT_TRUE(contains(detected.out, "excluded       0 rows")) << detected.out << detected.err;
  EXPECT_TRUE(contains(detected.out, "240 trials with nothing to find")) << detected.out;
  // What a fit printed as JSON beside a table does not describe it.
  folder.write("two.json", "{}\n");
  EXPECT_EQ(fit({trials}, how).status, 0);
}

TEST(Fitting, UselessRecordsAreNotWritten) {
  const TemporaryFolder folder;
  std::string flat = "participant,trial,amplitude,response\n", zero = "participant,stimulus,response\n";
  const double answers[] = {10, 12, 9, 11, 10, 9, 12, 11};
  for (int person = 1; person <= 3; ++person)
    for (int i = 0; i < 8; ++i) {
      flat += "S" + std::to_string(person) + "," + std::to_string(i + 1) + "," + std::to_string(0.1 * (1 << (i % 4))) + "," +
              std::to_string(answers[(i + 3 * person) % 8]) + "\n";
      zero += "S" + std::to_string(person) + ",s" + std::to_string(i) + ",0\n";
    }
  const Outcome map = fit({folder.write("flat.csv", flat), "-o", folder / "map.wale"}, as_magnitudes);
  EXPECT_EQ(map.status, 1);
  EXPECT_TRUE(contains(map.err, "no map is made: the exponent does not differ from zero")) << map.err;
  EXPECT_FALSE(fs::exists(folder / "map.wale"));
  const Outcome rule = fit({folder.write("zero.csv", zero), "-o", folder / "rule.wale"}, {"--task", "rating"});
  EXPECT_EQ(rule.status, 1);
  EXPECT_TRUE(contains(rule.err, "all ratings are the same")) << rule.err;
  EXPECT_FALSE(fs::exists(folder / "rule.wale"));
}

TEST(Fitting, CommasOfThousandsAreNotReadAsDecimals) {
  const TemporaryFolder folder;
  const std::string text = table() + "S5,1,1,0.4,\"1,234\"\n";
  const Outcome refused = fit({folder.write("study.csv", text)}, as_magnitudes);
  EXPECT_EQ(refused.status, 1);
  EXPECT_TRUE(contains(refused.err, "decimal comma")) << refused.err;
}

TEST(Fitting, SessionsOfTwoDesignsAreNotPooled) {
  const TemporaryFolder folder;
  const std::string design = bytes_of(designs + "crossed.wale");
  const std::string first = session(folder, "crossed.wale", "crossed", 1, "exponent=0.5");
  const auto run = [&](const std::string& name, const std::string& text) {
    const std::string log = folder / (name + ".trials");
    const Outcome ran = wale({"experiment", "run", folder.write(name + ".wale", text), "--experiment", "crossed", "--participant",
                              "P2", "--observer", "planted", "--seed", "2", "--unrecorded", "--log", log});
    EXPECT_EQ(ran.status, 0) << ran.err;
    return log;
  };
  const std::string asked = run("asked", replaced(design, "modulus free", "modulus 10"));
  const Outcome refused = fit({first, asked}, {});
  EXPECT_EQ(refused.status, 2);
  EXPECT_TRUE(contains(refused.err, "this session differs from")) << refused.err;
  const Outcome noted = fit({first, run("noted", design + "\n// a remark\n")}, {});
  EXPECT_TRUE(contains(noted.out, "the text of the design is not that of")) << noted.out << noted.err;
}

TEST(Fitting, SortsGiveTheGroupsThatAllMade) {
  std::string text = "participant,run,stimulus,amplitude,response\n";
  for (const char* person : {"A", "B"})
    for (int i = 0; i < 6; ++i)
      text += std::string(person) + ",1,s" + std::to_string(i) + "," + std::to_string(1 << i) + "," +
              (i < 2   ? "1"
               : i < 4 ? "2"
                       : "3") +
              "\n";
  const TemporaryFolder folder;
  const Outcome fitted = fit({folder.write("sorts.csv", text), "--task", "sorting", "--size", "amplitude:N", "-o",
                              folder / "rule.wale", "--json"},
                             {});
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  const auto sorting = fitted.json()["sorting"];
  EXPECT_EQ(sorting["groups"], 3);
  EXPECT_EQ(sorting["agreement"], 1.0);
  EXPECT_EQ(sorting["clusters"]["s0"], sorting["clusters"]["s1"]);
  EXPECT_NE(sorting["clusters"]["s1"], sorting["clusters"]["s2"]);
  EXPECT_TRUE(contains(bytes_of(folder / "rule.wale"), "case        \"group 1\", assumed amplitude below 1.41421 N"))
      << bytes_of(folder / "rule.wale");
  EXPECT_EQ(wale({"check", folder / "rule.wale"}).status, 0);
}

TEST(Fitting, RatingsGiveARule) {
  std::string text = "participant,run,trial,stimulus,response\n";
  for (const char* person : {"A", "B"})
    for (int run = 1; run <= 2; ++run)
      for (int i = 0; i < 3; ++i)
        text += std::string(person) + "," + std::to_string(run) + "," + std::to_string(i) + ",k" + std::to_string(i) +
                "," + std::to_string(30 * i + (person[0] == 'A' ? 5 : 15)) + "\n";
  const TemporaryFolder folder;
  const Outcome fitted =
      fit({folder.write("ratings.csv", text), "--task", "confidence", "-o", folder / "rule.wale"}, {});
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  EXPECT_TRUE(contains(bytes_of(folder / "rule.wale"), "case        \"k1\", kind k1, confidence 40 %"))
      << bytes_of(folder / "rule.wale");
  EXPECT_EQ(wale({"check", folder / "rule.wale"}).status, 0);
}

TEST(Fitting, StimuliWithoutFactorsHaveTheirSizesInATable) {
  const TemporaryFolder folder;
  std::vector<std::string> logs;
  for (int person = 1; person <= 2; ++person)
    logs.push_back(session(folder, "minsky1995_chapter5.wale", "minsky1995_chapter5", person,
                           "exponent=0.76,noise=0.1,threshold=0,feels=actuator"));
  logs.push_back("--json");
  const Outcome without = fit(logs, {});
  EXPECT_EQ(without.status, 2);
  EXPECT_TRUE(contains(without.err, "--stimuli")) << without.err;
  const Outcome fitted = fit(logs, {"--stimuli", designs + "minsky1995_chapter5_stimuli.csv"});
  ASSERT_EQ(fitted.status, 0) << fitted.err;
  EXPECT_LE(fitted.json()["magnitudes"]["exponent"]["low"], 0.76);
  EXPECT_GE(fitted.json()["magnitudes"]["exponent"]["high"], 0.76);
}

TEST(Reporting, PageHoldsTheStudyAndLoadsNothing) {
  const TemporaryFolder folder;
  std::string text = table();
  while (contains(text, "S2,")) text = replaced(text, "S2,", "<script>alert(1)</script>,");
  const std::string trials = folder.write("study.csv", text);
  const std::string page = folder / "study.html";
  std::vector<std::string> words = {"calibrate", "report",         trials,        "-o",    page,
                                    "--drop",    "participant=S3", "--materials", corduroy};
  words.insert(words.end(), as_magnitudes.begin(), as_magnitudes.end());
  const Outcome reported = wale(words);
  ASSERT_EQ(reported.status, 0) << reported.err;
  const std::string html = bytes_of(page);
  EXPECT_FALSE(contains(html, "<script"));
  EXPECT_TRUE(contains(html, "&lt;script&gt;alert(1)&lt;/script&gt;"));
  EXPECT_FALSE(contains(html, "http://"));
  EXPECT_FALSE(contains(html, "https://"));
  EXPECT_TRUE(contains(html, "default-src 'none'"));
  EXPECT_TRUE(contains(html, "10 rows are excluded"));
  EXPECT_TRUE(contains(html, "map roughness from amplitude {"));
  // With exponent 0.5 level 0.6 is 0.36 of the reference's force, with 0.76 it is 0.51 of it: 1.364 N and 1.934 N.
  // Their ratio is several just noticeable differences of force.
  EXPECT_TRUE(contains(html, "<td>corduroy</td><td>0.6</td><td>1.934 N</td><td>1.364 N</td>"))
      << html.substr(html.find("What it changes"));
  wale(words);
  EXPECT_EQ(bytes_of(page), html) << "the same trials give the same page";
}

TEST(Reporting, DrawsTheStimuliOfTheDesign) {
  const TemporaryFolder folder;
  const std::string design = folder.write("d.wale", R"(wale 1
material bench {
  physical {
    param amplitude = 0.8 N in 0.05 N .. 4 N
    force = lateral(cos(2 * 3.141592653589793 * x / 2.5 mm), amplitude: amplitude)
  }
}
experiment small {
  stimulus bench(amplitude: amplitude)
  factor   amplitude 0.2 N, 0.8 N
  task     magnitude_estimation, modulus free
  ask      "How rough is it?"
  present  1 s
}
)");
  std::string text = "participant,trial,amplitude,response\n";
  for (const char* person : {"A", "B", "C"})
    for (int trial = 1; trial <= 4; ++trial)
      text += std::string(person) + "," + std::to_string(trial) + (trial % 2 == 1 ? ",0.2," : ",0.8,") +
              std::to_string((trial % 2 == 1 ? 1.0 : 2.0) + 0.1 * trial + 0.05 * (*person - 'A') * trial) + "\n";
  const Outcome reported =
      wale({"calibrate", "report", folder.write("t.csv", text), "--design", design, "-o", folder / "r.html"});
  ASSERT_EQ(reported.status, 0) << reported.err;
  EXPECT_TRUE(contains(reported.out, "2 drawn stimuli")) << reported.out;
  const std::string html = bytes_of(folder / "r.html");
  EXPECT_TRUE(contains(html, "data:image/png;base64,iVBORw0KGgo"));
  EXPECT_TRUE(contains(html, "factor   amplitude 0.2 N, 0.8 N"));
}

TEST(Planning, TakesTheExponentThatIsAssumed) {
  const TemporaryFolder folder;
  const std::string design = folder.write(
      "d.wale",
      "wale 1\nmaterial bench { physical { param a = 0.8 N in 0 N .. 6 N; force = lateral(cos(x / 1 mm), amplitude: a) } }\n"
      "experiment d { stimulus bench(a: a); standard bench(a: 0 N); factor a 0.05 N .. 0.6 N, steps 6; task two_interval; "
      "repetitions 10; present 0.6 s }\n");
  const auto words = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = {"experiment", "plan", design, "--studies", "20", "--most", "12", "--precision", "0.6"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  const Outcome plain = wale(words({})), steep = wale(words({"--growth", "2.5", "--lapse", "0.01"}));
  EXPECT_TRUE(contains(plain.out, "d' in proportion to the difference, lapse rate 0.02")) << plain.out << plain.err;
  EXPECT_TRUE(contains(steep.out, "d' as the difference to the power of 2.5, lapse rate 0.01")) << steep.out << steep.err;
  EXPECT_NE(plain.out.substr(plain.out.find('\n')), steep.out.substr(steep.out.find('\n')));
  EXPECT_EQ(wale(words({"--growth", "0"})).status, 2);
  const Outcome described = wale({"describe", design, "--experiment", "d"});
  EXPECT_TRUE(contains(described.out, "short     a presentation takes 0.6 s, and a hand moves to and fro once in 1 s"))
      << described.out;
  EXPECT_TRUE(contains(described.err, "W0308")) << described.err;
}

TEST(Fitting, DescriptionsAreCodedByATable) {
  const TemporaryFolder folder;
  const std::string trials = folder.write("t.csv", "participant,stimulus,response\nA,ribs,rather rough\nB,ribs,Sharp\n"
                                                   "A,oil,slippery\nB,oil,\n");
  const Outcome coded = fit({trials, "--task", "description", "--codes", folder.write("c.csv", "word,code\nsharp,rough\nrough,rough\n")}, {});
  EXPECT_EQ(coded.status, 0) << coded.err;
  EXPECT_TRUE(contains(coded.out, "2 descriptions; rough 2")) << coded.out;
  EXPECT_TRUE(contains(coded.out, "without a code rather 1, slippery 1")) << coded.out;
  EXPECT_TRUE(contains(coded.out, "1 by the rule: no answer")) << coded.out;
  const Outcome twice = fit({trials, "--task", "description", "--codes", folder.write("e.csv", "word,code\nrough,a\nRough,b\n")}, {});
  EXPECT_EQ(twice.status, 1);
  EXPECT_TRUE(contains(twice.err, "e.csv:3: this word has another code above")) << twice.err;
}

TEST(Planning, MorePrecisionNeedsMorePeopleAndTheSameSeedGivesTheSamePlan) {
  const auto people = [](const std::string& precision) {
    const Outcome planned = wale({"experiment", "plan", designs + "crossed.wale", "--precision", precision, "--spread",
                                  "0.1", "--noise", "0.1", "--studies", "60", "--json"});
    EXPECT_EQ(planned.status, 0) << planned.err;
    EXPECT_EQ(planned.out, wale({"experiment", "plan", designs + "crossed.wale", "--precision", precision, "--spread",
                                 "0.1", "--noise", "0.1", "--studies", "60", "--json"})
                               .out);
    return planned.json()["people"].get<int>();
  };
  const int few = people("0.1"), many = people("0.05");
  // The half width is near t s / sqrt(n) with s = 0.1 between people: 1.96 * 0.1 / 0.05 squared is 15, and a share of
  // 80 % of the studies needs some more.
  EXPECT_GE(many, 15);
  EXPECT_LE(many, 28);
  EXPECT_LT(few, many);
  const Outcome never =
      wale({"experiment", "plan", designs + "crossed.wale", "--precision", "0.01", "--most", "6", "--studies", "20"});
  EXPECT_EQ(never.status, 1);
  EXPECT_TRUE(contains(never.out, "6 people are not enough"));
  EXPECT_EQ(wale({"experiment", "plan", designs + "minsky1995_chapter6.wale"}).status, 2);
  EXPECT_EQ(wale({"experiment", "plan", designs + "crossed.wale", "--over", "nothing"}).status, 2);
}

}  // namespace
}  // namespace wale::command_line::fitting_test
