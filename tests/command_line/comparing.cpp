// wale compare, as a person runs it.

#include <gtest/gtest.h>

#include "tests/command_line/running.hpp"

namespace wale::command_line::comparing_test {
namespace {

const std::string library = std::string(WALE_SOURCE_DIR) + "/library/";

TEST(Compare, TwoMaterialsCueByCue) {
  const Outcome run = wale({"compare", corduroy, library + "fluid/oil.wale"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "corduroy and ")) << run.out;
  EXPECT_TRUE(contains(run.out, "amplitude            1.9")) << run.out;  // 1.934 N, read to a few thousandths
  EXPECT_TRUE(contains(run.out, "told apart, most plainly by their")) << run.out;
}

TEST(Compare, AMaterialIsHardlyToldApartFromItself) {
  const Outcome run = wale({"compare", "--json", corduroy, corduroy + ":corduroy"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = run.json();
  ASSERT_EQ(json["pairs"].size(), 1u);
  EXPECT_EQ(json["pairs"][0]["verdict"], "alike");
  EXPECT_EQ(json["pairs"][0]["noticeable"], 0);
  EXPECT_NEAR(json["materials"][0]["cues"]["period"]["value"].get<double>(), 2.5e-3, 0.03e-3);
}

TEST(Compare, OneIsNotEnoughAndWhatIsNotThereIsSaid) {
  const Outcome alone = wale({"compare", corduroy});
  EXPECT_EQ(alone.status, 1);
  EXPECT_TRUE(contains(alone.err, "only one material")) << alone.err;
  const Outcome missing = wale({"compare", corduroy, "nowhere.wale"});
  EXPECT_EQ(missing.status, 1);
  EXPECT_TRUE(contains(missing.err, "nowhere.wale")) << missing.err;
}

TEST(Compare, ManyAreAListOfThoseThatAreHardlyToldApart) {
  const Outcome run = wale({"compare", library + "sandpaper/chapter5.wale"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "30 materials")) << run.out;
  EXPECT_TRUE(contains(run.out, "pairs are hardly told apart")) << run.out;
}

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
