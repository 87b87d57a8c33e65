// `wale compare`, `levels` and `feel --blind` on the command line.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/command_line/running.hpp"

namespace wale::command_line::comparing_test {
namespace {

const std::string library = std::string(WALE_SOURCE_DIR) + "/library/";

TEST(Compare, TwoMaterialsCueByCue) {
  const Outcome run = wale({"compare", corduroy, library + "fluid/oil.wale"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "corduroy and ")) << run.out;
  EXPECT_TRUE(contains(run.out, "amplitude            1.9")) << run.out;  // 1.934 N, read to a few thousandths
  EXPECT_TRUE(contains(run.out, "people can tell them apart, most easily by their")) << run.out;
}

TEST(Compare, AMaterialIsAlikeToItself) {
  const Outcome run = wale({"compare", "--json", corduroy, corduroy + ":corduroy"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = run.json();
  ASSERT_EQ(json["pairs"].size(), 1u);
  EXPECT_EQ(json["pairs"][0]["verdict"], "alike");
  EXPECT_EQ(json["pairs"][0]["noticeable"], 0);
  EXPECT_NEAR(json["materials"][0]["cues"]["period"]["value"].get<double>(), 2.5e-3, 0.03e-3);
}

TEST(Compare, OneMaterialOrAMissingFileIsAnError) {
  const Outcome alone = wale({"compare", corduroy});
  EXPECT_EQ(alone.status, 1);
  EXPECT_TRUE(contains(alone.err, "expected at least two materials, found only one")) << alone.err;
  const Outcome missing = wale({"compare", corduroy, "nowhere.wale"});
  EXPECT_EQ(missing.status, 1);
  EXPECT_TRUE(contains(missing.err, "nowhere.wale")) << missing.err;
}

TEST(Compare, ManyAreAListOfPairsThatAreHardToTellApart) {
  const Outcome run = wale({"compare", library + "sandpaper/chapter5.wale"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "30 materials")) << run.out;
  EXPECT_TRUE(contains(run.out, "pairs are hard to tell apart")) << run.out;
}

TEST(Compare, TheJsonOfManyHasAllDistancesAndTheNearestPairs) {
  const Outcome run = wale({"compare", "--json", library + "sandpaper/chapter5.wale"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = run.json();
  const std::size_t count = json["materials"].size();
  ASSERT_EQ(count, 30u);
  ASSERT_EQ(json["matrix"].size(), count - 1);
  double least = HUGE_VAL;
  for (std::size_t a = 0; a + 1 < count; ++a) {
    ASSERT_EQ(json["matrix"][a].size(), count - 1 - a);
    for (const auto& distance : json["matrix"][a])
      if (!distance.is_null()) least = std::min(least, distance.get<double>());
  }
  EXPECT_EQ(json["pairs"].size(), 20u);
  EXPECT_NEAR(json["pairs"][0]["noticeable"].get<double>(), least, 1e-3);
  EXPECT_EQ(json["nearest"][0], json["pairs"][0]["a"]);
}

TEST(Compare, FilesKeepTheirOrder) {
  const std::vector<std::string> names = {"velvet", "corduroy", "denim", "canvas", "jersey"};
  std::vector<std::string> words = {"compare", "--json"};
  for (const auto& name : names) words.push_back(library + "fabric/" + name + ".wale:" + name);
  const Outcome first = wale(words), second = wale(words);
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_EQ(first.out, second.out);
  const auto json = first.json();
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(json["materials"][i]["name"], names[i]);
}

TEST(Compare, ErrorsOfAllFilesAreShownInTheirOrder) {
  const TemporaryFolder folder;
  const std::string one = folder.write("one.wale", "wale 1\nmaterial m { physical { force = 1 m } }\n");
  const std::string two = folder.write("two.wale", "wale 1\nmaterial m { physical { force = nothing } }\n");
  const Outcome run = wale({"compare", one, corduroy, two, corduroy + ":velvet"});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(run.out, "");
  const auto first = run.err.find("one.wale:2"), second = run.err.find("two.wale:2"), third = run.err.find("W0602");
  EXPECT_LT(first, second) << run.err;
  EXPECT_LT(second, third) << run.err;
  EXPECT_NE(third, std::string::npos) << run.err;
}

TEST(Compare, ARecalledThresholdIsAWarning) {
  const TemporaryFolder folder;
  const auto heavy = [&](const std::string& name, const std::string& mass) {
    return folder.write(name + ".wale", "wale 1\nmaterial " + name + " { physical { force = heavy(" + mass + ") } }\n");
  };
  const Outcome run = wale({"compare", heavy("light", "0.5 kg"), heavy("lead", "0.55 kg")});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.err, "warning[W0420]")) << run.err;
  EXPECT_TRUE(contains(run.err, "Beauregard and Srinivasan 1997, recalled")) << run.err;
  // Of light ones the smallest force decides, which was looked up, and the recalled fraction says nothing.
  const Outcome small = wale({"compare", heavy("air", "0.05 kg"), heavy("cork", "0.15 kg")});
  EXPECT_TRUE(contains(small.out, "by the smallest difference at d' = 1")) << small.out;
  EXPECT_FALSE(contains(small.err, "W0420")) << small.err;
  for (const char* percept : {"viscosity", "crispness", "heaviness"}) {
    const Outcome levels = wale({"levels", percept});
    EXPECT_EQ(contains(levels.err, "recalled"), contains(levels.out, "recalled")) << levels.out << levels.err;
  }
}

TEST(Levels, AreProposedAsADeclaration) {
  const Outcome run = wale({"levels", "roughness", "--steps", "5", "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = run.json();
  ASSERT_EQ(json["levels"].size(), 5u);
  const TemporaryFolder folder;
  std::string text = "wale 1\n\n" + json["wale"].get<std::string>() + "\n";
  for (const int i : {2, 3})
    text += "material m" + std::to_string(i) + " {\n  perceptual { roughness level_" + std::to_string(i) +
            " }\n  physical { force = lateral(grating(x, period: 2.5 mm)) }\n}\n";
  const std::string file = folder.write("levels.wale", text);
  const Outcome checked = wale({"check", file});
  EXPECT_EQ(checked.status, 0);
  EXPECT_TRUE(contains(checked.out, "0 errors, 0 warnings")) << checked.out;
  // Materials with two adjacent levels, compared by their forces, differ as much as the proposal states.
  const auto compared = wale({"compare", "--json", file}).json();
  EXPECT_NEAR(compared["pairs"][0]["cues"]["amplitude"]["noticeable"].get<double>(),
              json["levels"][2]["apart"].get<double>(), 0.2);
}

// A hand on it is never fast enough to feel what resists in proportion to its speed, and on so small a patch no wall
// stands.
TEST(Levels, ThatNoHandOnTheDeviceMeetsAreNotProposed) {
  const TemporaryFolder folder;
  const std::string devices = folder.write(
      "devices.wale",
      "wale 1\nexport device slow {\n  class force_plane\n  workspace disc(30 mm)\n  position 4096 counts\n"
      "  force 10 N, 2048 counts\n  rate 900 Hz\n  speed 50 mm/s\n  slew 200 N/s\n  velocity_filter 15, 1 counts\n"
      "  patch 20 mm, 20 mm, 2 mm\n  mass 0.3 kg\n  damping 1 N s/m\n  friction 0.15 N\n  delay 0 ms\n}\n");
  for (const char* percept : {"viscosity", "hardness"}) {
    const Outcome run = wale({"levels", percept, "--devices", devices, "--device", "slow"});
    EXPECT_EQ(run.status, 1) << percept << run.out;
    EXPECT_TRUE(contains(run.err, "no hand on `slow` meets " + std::string(percept))) << run.err;
  }
  EXPECT_EQ(wale({"levels", "roughness", "--devices", devices, "--device", "slow"}).status, 0);
}

TEST(Levels, OfWhatIsFeltInAWallAreProposedBesideOne) {
  for (const char* percept : {"crispness", "mushiness"}) {
    const Outcome run = wale({"levels", percept});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(contains(run.out, "felt in the face of a wall only: ask for hardness too")) << run.out;
  }
  EXPECT_EQ(wale({"levels", "crispness", "--json"}).json()["beside"], "hardness");
  EXPECT_TRUE(wale({"levels", "hardness", "--json"}).json()["beside"].is_null());
}

TEST(Levels, FartherApartAreFewerAndToldApartAllTheSame) {
  const Outcome run = wale({"levels", "roughness", "--jnd", "3"});
  EXPECT_TRUE(contains(run.out, "9 levels of roughness")) << run.out;
  EXPECT_TRUE(contains(run.out, "told apart side by side: 27 levels")) << run.out;
  EXPECT_TRUE(contains(run.out, "3 just noticeable differences apart or more: 9 levels")) << run.out;
}

TEST(Levels, ThatCannotBeProposedAreExplained) {
  EXPECT_EQ(wale({"levels", "vibration"}).status, 1);
  // Cholewiak, Tan and Ebert 2008: 2.9 forces are recognised alone; side by side many more are told apart.
  const auto alone = wale({"levels", "roughness", "--json"}).json();
  const auto beside = wale({"levels", "roughness", "--side-by-side", "--json"}).json();
  EXPECT_EQ(alone["levels"].size(), 3u);
  EXPECT_EQ(alone["recognised_alone"]["levels"], 2.9);
  EXPECT_EQ(beside["levels"].size(), alone["most"]);
  EXPECT_GT(beside["levels"].size(), 20u);
  EXPECT_TRUE(contains(wale({"levels", "vibration"}).err, "unknown: no published threshold"));
  EXPECT_TRUE(contains(wale({"levels", "rougness"}).err, "did you mean `roughness`?"));
  const Outcome many = wale({"levels", "smoothness", "--steps", "500"});
  EXPECT_EQ(many.status, 1);
  EXPECT_TRUE(contains(many.err, "ask for")) << many.err;
  EXPECT_EQ(wale({"levels"}).status, 2);
  EXPECT_TRUE(contains(wale({"levels", "smoothness", "--steps", "3"}).out, "3 levels of smoothness"));
}

TEST(Levels, SayTheDistanceAsItWasTyped) {
  EXPECT_TRUE(contains(wale({"levels", "roughness", "--jnd", "1000"}).err, " 1000 just noticeable differences apart"));
  EXPECT_TRUE(contains(wale({"levels", "roughness", "--jnd", "999.5"}).err, " 999.5 just noticeable differences"));
  EXPECT_FALSE(contains(wale({"levels", "--help"}).out, "file itself")) << "it takes no file";
}

TEST(Blind, PlaysAsksAndScores) {
  const std::vector<std::string> words = {"feel",      corduroy,    "--against", library + "fabric/denim.wale",
                                          "--blind",   "--trials",  "3",         "--seed",
                                          "5",         "--seconds", "0.1",       "--device",
                                          "simulated", "--json"};
  const Outcome run = wale(words, "1\nneither\n2\n1\n");
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = run.json();
  ASSERT_EQ(json["trials"].size(), 3u);
  int right = 0;
  const int answers[] = {1, 2, 1};
  for (int i = 0; i < 3; ++i) {
    const auto& trial = json["trials"][i];
    EXPECT_EQ(trial["answer"], answers[i]);
    EXPECT_EQ(trial["right"].get<bool>(), (answers[i] == 1) == trial["a_first"].get<bool>());
    right += trial["right"].get<bool>();
  }
  EXPECT_EQ(json["right"], right);
  // The prediction is that of `wale compare`.
  const auto compared = wale({"compare", "--json", corduroy, library + "fabric/denim.wale:denim"}).json();
  EXPECT_NEAR(json["predicted"]["d_prime"].get<double>(), compared["pairs"][0]["noticeable"].get<double>(), 1e-9);
  EXPECT_EQ(json["predicted"]["outside"], compared["pairs"][0]["cues"]["amplitude"]["outside"]);
  EXPECT_EQ(json["predicted"]["outside"][0], "amplitude 2.5 N .. 10 N");
  EXPECT_FALSE(json.contains("ended"));
  EXPECT_EQ(wale(words, "1\nneither\n2\n1\n").out, run.out) << "the seed determines the order";
}

TEST(Blind, SaysHowOftenGuessingDoesAsWell) {
  const std::vector<std::string> words = {"feel",     corduroy,   "--against", library + "fabric/denim.wale",
                                          "--blind",  "--seed",   "5",         "--seconds",
                                          "0.1",      "--trials", "1",         "--device",
                                          "simulated"};
  // Of the two possible answers one is right: none or more right is certain, one right has half of all guesses.
  const std::string both = wale(words, "1\n").out + wale(words, "2\n").out;
  EXPECT_TRUE(contains(both, "0 of 1: ") && contains(both, "as many or more in 100 % of sessions")) << both;
  EXPECT_TRUE(contains(both, "1 of 1: ") && contains(both, "as many or more in 50 % of sessions")) << both;
}

TEST(Blind, EndsWithTheAnswers) {
  std::vector<std::string> words = {"feel",     corduroy,    "--against", library + "fabric/denim.wale",
                                    "--blind",  "--seconds", "0.1",       "--device",
                                    "simulated"};
  const Outcome some = wale(words, "1\nq\n1\n");
  EXPECT_EQ(some.status, 0) << some.err;
  EXPECT_TRUE(contains(some.out, "1 of 12 trials was answered: you ended it with q")) << some.out;
  const Outcome two = wale(words, "1\n2\n");
  EXPECT_TRUE(contains(two.out, "2 of 12 trials were answered: the input ended")) << two.out;
  const Outcome none = wale(words);
  EXPECT_EQ(none.status, 1);
  EXPECT_EQ(none.out, "");
  EXPECT_TRUE(contains(none.err, "no trial was answered")) << none.err;
  EXPECT_EQ(wale({"feel", corduroy, "--blind"}).status, 2);
  const Outcome unheard = wale(words, "neither\nq\n");
  EXPECT_TRUE(contains(unheard.err, "expected 1, 2 or q, found \"neither\"\n")) << unheard.err;
  words.emplace_back("--virtual-time");
  EXPECT_EQ(wale(words, "1\n").status, 2) << "nobody feels it";
}

TEST(Blind, NeedsTwoMaterials) {
  const Outcome same = wale({"feel", corduroy, "--against", "corduroy", "--blind", "--device", "simulated"});
  EXPECT_EQ(same.status, 2);
  EXPECT_TRUE(contains(same.err, "error[W0801]: --against: expected another material than A")) << same.err;
  const Outcome set = wale({"feel", corduroy, "--against", "corduroy", "--blind", "--device", "simulated", "--set",
                            "wale=2mm", "--trials", "1", "--seconds", "0.1"},
                           "1\n");
  EXPECT_EQ(set.status, 0) << set.err;
}

TEST(Blind, NeedsAnOption) { EXPECT_EQ(wale({"feel", corduroy, "--against", corduroy}).status, 2); }

TEST(Describe, TheTextureAndItsClassAreInTheJson) {
  const Outcome run = wale({"describe", "--json", corduroy});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = run.json();
  EXPECT_EQ(json["texture"]["class"], "flat texture");
  EXPECT_EQ(json["texture"]["confidence"], "high");
  const auto& roughness = json["percepts"]["roughness"];
  EXPECT_LT(roughness["individual_low"], roughness["low"]);
  EXPECT_GT(roughness["individual_high"], roughness["high"]);
  EXPECT_EQ(roughness["read_from_force"], false);
}

}  // namespace
}  // namespace wale::command_line::comparing_test
