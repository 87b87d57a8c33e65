#include "schema/expectation.hpp"

#include <gtest/gtest.h>

#include "schema/closest_names.hpp"

namespace wale::expectation_test {
namespace {

std::string split(std::string_view sentence) {
  const Expectation said = expectation_in(sentence);
  return said.expected + " | " + said.found;
}

TEST(Expectation, IsWhatTheSentenceSays) {
  EXPECT_EQ(split("expected a number, found a text"), "a number | a text");
  EXPECT_EQ(split("expected roughness 0.1 or more, found 0.02, which few people can feel"),
            "roughness 0.1 or more | 0.02");
  EXPECT_EQ(split("expected a period from 0.7 mm to 10 mm, the measured range, found 14 mm (Minsky 1995, figure 19)"),
            "a period from 0.7 mm to 10 mm, the measured range | 14 mm");
  EXPECT_EQ(split("expected physics for grit, found none, and `sandpaper` has no rule"), "physics for grit | none");
  EXPECT_EQ(split("`units.csv`, line 1: expected a declared unit for `x`, found `furlong`"),
            "a declared unit for `x` | `furlong`");
  EXPECT_EQ(split("expected a column `torque`, found x, force"), "a column `torque` | x, force");
  EXPECT_EQ(split("expected a constant, but `x` changes as the hand moves"), "a constant | ");
  EXPECT_EQ(split("a unit must be positive"), " | ");
  EXPECT_EQ(split("this is more than expected here"), " | ") << "no beginning of a sentence";
  EXPECT_EQ(split(""), " | ");
}

TEST(Expectation, LeavesWhatIsSaidAlready) {
  const Error filled = with_expectation({.sentence = "expected a, found b", .expected = "c"});
  EXPECT_EQ(filled.expected, "c");
  EXPECT_EQ(filled.found, "");
  EXPECT_EQ(with_expectation({.sentence = "expected a, found b"}).found, "b");
}

TEST(Expectation, AListIsOneLine) {
  EXPECT_EQ(in_one_line("N   = kg m   s^-2"), "N = kg m s^-2");
  EXPECT_EQ(in_one_line("m   (left)  "), "m (left)");
  EXPECT_EQ(in_one_line(""), "");
}

TEST(ClosestNames, AreThreeWhereThereAreThree) {
  const std::vector<std::string> names{"corduroy", "oak", "silk", "corduroy", "cord", "honey"};
  EXPECT_EQ(closest_names("corduory", names).front(), "corduroy");
  EXPECT_EQ(closest_names("corduory", names).size(), 3u);
  EXPECT_EQ(closest_names("qqk", names), (std::vector<std::string>{"oak", "silk", "cord"})) << "by their slips: 2, 3, 4";
  EXPECT_EQ(closest_names("oak", names).size(), 3u) << "never itself";
  for (const std::string& each : closest_names("oak", {"oak", "silk"})) EXPECT_EQ(each, "silk");
  EXPECT_EQ(closest_names(std::string(100'000, 'q'), names).size(), 3u);
  EXPECT_TRUE(closest_names("oak", {}).empty());
}

}  // namespace
}  // namespace wale::expectation_test
