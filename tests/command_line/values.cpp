// What is typed for options that take a value: sense is read, and nonsense is refused in words.

#include <gtest/gtest.h>

#include "tests/command_line/running.hpp"

namespace wale::command_line::values_test {
namespace {

struct ValueOption {
  std::vector<std::string> words;  ///< of the command, before the option
  std::string option;
  int status;  ///< 2 for numbers; 1 for quantities, which are read as those of a Wale file
};

const std::vector<ValueOption> options{
    {{"levels", "roughness"}, "--steps", 2},
    {{"levels", "roughness"}, "--jnd", 2},
    {{"feel", corduroy, "--virtual-time"}, "--seconds", 2},
    {{"feel", corduroy, "--virtual-time"}, "--max-force", 1},
    {{"feel", corduroy, "--virtual-time", "--against", corduroy, "--blind"}, "--trials", 2},
    {{"feel", corduroy, "--virtual-time", "--against", corduroy, "--blind"}, "--seed", 2},
    {{"replay", "missing.wrec"}, "--ticks", 2},
    {{"devices", "--identify"}, "--max-force", 1},
    {{"sample", corduroy}, "--at", 1},
    {{"describe", corduroy}, "--set", 1},
};

TEST(Values, NonsenseIsRefusedWithWhatWasTypedAndAnExample) {
  for (const ValueOption& each : options)
    for (const std::string typed : {"", "5x", "-1", "nan", "inf", "1e999", " ", "0x10", "١"}) {
      if (each.option == "--seconds" && typed == "inf") continue;  // until Ctrl-C
      std::vector<std::string> words = each.words;
      words.push_back(each.option);
      words.push_back(each.option == "--set" ? "wale=" + typed : typed);
      const Outcome outcome = wale(words);
      const std::string told = testing::PrintToString(words) + "\n" + outcome.err;
      EXPECT_EQ(outcome.status, each.status) << told;
      EXPECT_EQ(outcome.out, "") << told;
      EXPECT_TRUE(contains(outcome.err, each.option)) << told;
      EXPECT_TRUE(contains(outcome.err, "expected ")) << told;
      EXPECT_TRUE(contains(outcome.err, typed.empty() ? "found nothing" : "found \"" + typed + "\"")) << told;
      EXPECT_TRUE(contains(outcome.err, "for example, `" + each.option)) << told;
    }
}

TEST(Values, SenseIsRead) {
  EXPECT_EQ(wale({"levels", "roughness", "--steps", "3", "--jnd", "1.5"}).status, 0);
  for (const char* seconds : {"0.2", "0.2 s", "200 ms", "200ms"}) {
    const Outcome felt = wale({"feel", corduroy, "--virtual-time", "--json", "--seconds", seconds});
    ASSERT_EQ(felt.status, 0) << seconds << felt.err;
    EXPECT_EQ(felt.json().at("ticks").at("run"), 180) << seconds;  // 0.2 s at 900 Hz
  }
  EXPECT_EQ(wale({"feel", corduroy, "--virtual-time", "--seconds", "0.1", "--max-force", "500 mN"}).status, 0);
}

TEST(Values, RangesAreToldWhole) {
  EXPECT_TRUE(contains(wale({"levels", "roughness", "--steps", "1"}).err, "a whole number from 2 to 1000"));
  EXPECT_TRUE(contains(wale({"levels", "roughness", "--jnd", "0"}).err, "a number above 0"));
}

}  // namespace
}  // namespace wale::command_line::values_test
