// Values of options: valid ones are read, and invalid ones are refused with an explanation.

#include <gtest/gtest.h>

#include "tests/command_line/running.hpp"

namespace wale::command_line::values_test {
namespace {

struct ValueOption {
  std::vector<std::string> words;  ///< the command before the option
  std::string option;
};

const std::vector<ValueOption> options{
    {{"levels", "roughness"}, "--steps"},
    {{"levels", "roughness"}, "--jnd"},
    {{"feel", corduroy, "--virtual-time"}, "--seconds"},
    {{"feel", corduroy, "--virtual-time"}, "--max-force"},
    {{"feel", corduroy, "--against", "denim", "--blind"}, "--trials"},
    {{"feel", corduroy, "--against", "denim", "--blind"}, "--seed"},
    {{"replay", "missing.wrec"}, "--ticks"},
    {{"devices", "--identify"}, "--max-force"},
    {{"sample", corduroy}, "--at"},
    {{"describe", corduroy}, "--set"},
};

TEST(Values, ASettingThatCannotBeSaysWhichMaterialWasTaken) {
  const TemporaryFolder folder;
  const std::string file =
      folder.write("two.wale", "wale 1\nmaterial a { perceptual { roughness 0.5 } }\nmaterial b = corduroy\n");
  const Outcome of_first = wale({"preview", file, "-o", folder / "a.png", "--set", "wale=2.2mm"});
  EXPECT_EQ(of_first.status, 2);
  for (const char* part : {"`a` has no parameter `wale`", "`--material`"})
    EXPECT_TRUE(contains(of_first.err, part)) << part << of_first.err;
  const Outcome named = wale({"describe", corduroy, "--set", "roughness=smooth"});
  EXPECT_EQ(named.status, 2);
  EXPECT_TRUE(contains(named.err, "names of levels work in a file only")) << named.err;
}

TEST(Values, InvalidValuesAreRefusedWithTheirTextAndAnExample) {
  for (const ValueOption& each : options)
    for (const std::string typed : {"", "5x", "-1", "nan", "inf", "1e999", " ", "0x10", "١"}) {
      if (each.option == "--seconds" && typed == "inf") continue;  // valid: until Ctrl-C
      std::vector<std::string> words = each.words;
      words.push_back(each.option);
      words.push_back(each.option == "--set" ? "wale=" + typed : typed);
      const Outcome outcome = wale(words);
      const std::string told = testing::PrintToString(words) + "\n" + outcome.err;
      EXPECT_EQ(outcome.status, 2) << told;
      EXPECT_EQ(outcome.out, "") << told;
      EXPECT_TRUE(contains(outcome.err, each.option)) << told;
      EXPECT_TRUE(contains(outcome.err, "expected ")) << told;
      EXPECT_TRUE(contains(outcome.err, typed.empty() ? "found nothing" : "found \"" + typed + "\"")) << told;
      EXPECT_TRUE(contains(outcome.err, "for example, `" + each.option)) << told;
    }
}

TEST(Values, ValidValuesAreRead) {
  EXPECT_EQ(wale({"levels", "roughness", "--steps", "3", "--jnd", "1.5"}).status, 0);
  for (const char* seconds : {"0.2", "0.2 s", "200 ms", "200ms"}) {
    const Outcome felt = wale({"feel", corduroy, "--virtual-time", "--json", "--seconds", seconds});
    ASSERT_EQ(felt.status, 0) << seconds << felt.err;
    EXPECT_EQ(felt.json().at("ticks").at("run"), 180) << seconds;  // 0.2 s at 900 Hz
  }
  EXPECT_EQ(wale({"feel", corduroy, "--virtual-time", "--seconds", "0.1", "--max-force", "500 mN"}).status, 0);
}

TEST(Values, ErrorsStateTheRange) {
  EXPECT_TRUE(contains(wale({"levels", "roughness", "--steps", "1"}).err, "a whole number from 2 to 1000"));
  EXPECT_TRUE(contains(wale({"levels", "roughness", "--jnd", "0"}).err, "a number from 0.01 to 1000"));
}

/// A command, its expected exit status, and a part of its expected message.
struct Refused {
  std::vector<std::string> words;
  int status;
  std::string said;
};

void expect_refused(const std::vector<Refused>& commands) {
  for (const Refused& each : commands) {
    const Outcome outcome = wale(each.words);
    const std::string told = testing::PrintToString(each.words) + "\n" + outcome.err;
    EXPECT_EQ(outcome.status, each.status) << told;
    EXPECT_EQ(outcome.out, "") << told;
    EXPECT_TRUE(contains(outcome.err, each.said)) << each.said << " in " << told;
    EXPECT_FALSE(contains(outcome.err, "warning[")) << told;
  }
}

TEST(Values, EmptyTextsAreRefusedByTheirOption) {
  expect_refused({{{"build", corduroy, "--device", "", "-o", "a.wpp"}, 2, "--device: expected"},
                  {{"feel", corduroy, "--virtual-time", "--record", ""}, 2, "--record: expected"},
                  {{"feel", corduroy, "--virtual-time", "--transport", ""}, 2, "--transport: expected"},
                  {{"feel", corduroy, "--virtual-time", "--built-for", ""}, 2, "--built-for: expected"},
                  {{"replay", "a.wrec", "--csv", ""}, 2, "--csv: expected"},
                  {{"compare", "denim", "--", "brick"}, 2, "`--` ends the options"},
                  {{"replay", "a.wrec", "--wav", ""}, 2, "--wav: expected"},
                  {{"describe", corduroy, "--material", ""}, 2, "--material: expected"},
                  {{"describe", corduroy, "--library", ""}, 2, "--library: expected"},
                  {{"preview", corduroy, "-o", ""}, 2, "--output: expected"},
                  {{"sample", corduroy, "--trace", ""}, 2, "--trace: expected"},
                  {{"find", "--kind", ""}, 2, "--kind: expected"},
                  {{"devices", "--identify", ""}, 2, "--identify: expected"},
                  {{"explain", ""}, 2, "CODE: expected"},
                  {{"levels", ""}, 2, "PERCEPT: expected"}});
}

TEST(Values, EmptyArgumentsAreRefusedInTheWordsOfTheirVerb) {
  expect_refused({{{"check", ""}, 2, "FILE: expected the path of a Wale file, found nothing"},
                  {{"feel", ""}, 2, "FILE: expected a file or the name of a material, found nothing"},
                  {{"compare", "", "denim"}, 2, "FILE: expected a file or the name of a material, found nothing"},
                  {{"build", corduroy, "-o", ""}, 2, "for example, `wale build corduroy -o corduroy.wpp`"}});
}

TEST(Values, AnEmptyValueDoesNotTakeTheNextOption) {
  expect_refused({{{"levels", "roughness", "--device=", "--steps", "3"}, 2, "--device: expected NAME, found nothing"},
                  {{"feel", corduroy, "--max-force=", "--device", "simulated"}, 2, "--max-force: expected a force"},
                  {{"describe", corduroy, "--set="}, 2, "--set: expected NAME=VALUE, found nothing"}});
}

TEST(Values, AreExpectedOnce) {
  expect_refused({{{"levels", "roughness", "--device", "falcon", "--device", "sandpaper"},
                   2,
                   "--device: expected once, found twice\n"},
                  {{"levels", "roughness", "--device", "a", "--device=b", "--device", "c"},
                   2,
                   "--device: expected once, found 3 times\n"},
                  {{"levels", "roughness", "--device"}, 2, "--device: expected NAME, found nothing\n"},
                  {{"build", corduroy, "-o"}, 2, "-o: expected FILE, found nothing\n"}});
}

TEST(Values, WholeNumbersSayThatTheyAreNotNegative) {
  expect_refused({{{"feel", corduroy, "--against", "denim", "--blind", "--seed", "-1"},
                   2,
                   "expected a whole number of 0 or more, found \"-1\""}});
}

TEST(Values, NamesOfParametersMayHaveSpacesRoundThem) {
  EXPECT_EQ(wale({"describe", corduroy, "--set", " wale = 4 mm"}).out,
            wale({"describe", corduroy, "--set", "wale=4mm"}).out);
}

TEST(Values, BeginningsOfNamesAreUnderstood) {
  expect_refused({{{"levels", "rough"}, 1, "did you mean `roughness`?"}});
}

TEST(Values, HelpIsAnOption) {
  expect_refused({{{"help"}, 2, "there is no verb `help`; `wale --help` is the help\n"},
                  {{"help", "feel"}, 2, "there is no verb `help`; `wale feel --help` is the help\n"}});
}

TEST(Values, LargeFiguresHaveNoExponent) {
  const Outcome levels = wale({"levels", "hardness", "--steps", "3"});
  ASSERT_EQ(levels.status, 0) << levels.err;
  EXPECT_TRUE(contains(levels.out, " 1000 N/m")) << levels.out;
  EXPECT_FALSE(contains(levels.out, "e+")) << levels.out;
}

TEST(Values, AFolderThatIsMissingIsNamed) {
  const TemporaryFolder folder;
  expect_refused({{{"build", corduroy, "-o", folder / "none/x.wpp"},
                   1,
                   "cannot write this file: there is no such folder\n  = help: make it first"}});
}

TEST(Values, UnknownNamesAreRefused) {
  expect_refused(
      {{{"describe", "brick:"}, 2, "after its colon"},
       {{"compare", "denim:", "velvet"}, 2, "after its colon"},
       {{"describe", corduroy + ":corduroy", "--material", "other"},
        2,
        "names `corduroy`, but --material names `other`"},
       {{"describe", corduroy, "--material", "nosuch"}, 2, "it has `corduroy`"},
       {{"describe", "fabric"}, 1, "`wale find --kind fabric`"},
       {{"describe", "std"}, 1, "`wale find --kind std`"},
       {{"describe", corduroy, "--library", "/nowhere"}, 2, "--library: `/nowhere` does not exist"},
       {{"feel", corduroy, "--virtual-time", "--transport", "banana"}, 2, "expected hidraw, libusb, evdev"},
       {{"feel", corduroy, "--device", "simulated:falcon", "--built-for", "nope"}, 2, "error[W0601]: --built-for"},
       {{"feel", corduroy, "--virtual-time", "--hand", "nofile.csv"},
        1,
        "error[W0501]: nofile.csv: the file cannot be read: no such file"},
       {{"feel", corduroy, "--virtual-time", "--hand", "traces/rest"}, 1, "error[W0501]: traces/rest: "},
       {{"feel", corduroy, "--virtual-time", "--hand", "foo"}, 2, "lateral, circular, press, rest nor"},
       {{"feel", corduroy, "--virtual-time", "--hand", "lateral along z"}, 2, "expected `x`, `y` or an angle"},
       {{"feel", corduroy, "--virtual-time", "--hand", "lateral at 20 N, 3 N"}, 2, "expected length, found force"},
       {{"feel", corduroy, "--virtual-time", "--hand", "circle"}, 2, "did you mean `circular`"},
       {{"feel", corduroy, "--virtual-time", "--hand", "Lateral"}, 2, "did you mean `lateral`"},
       {{"describe", corduroy, "--set", "Wale=4mm"}, 2, "did you mean `wale`"},
       {{"describe", corduroy, "--set", "wale=4mm", "--set", "wale=5mm"}, 2, "`wale` is set twice"}});
}

TEST(Values, NumbersOutOfRangeAreRefused) {
  expect_refused({{{"replay", "a.wrec", "--ticks", "99999999999999999999"}, 2, "to 18446744073709551615"},
                  {{"levels", "roughness", "--jnd", "1e-30"}, 2, "from 0.01"},
                  {{"levels", "bumpiness", "--steps", "50"}, 1, "error["},
                  {{"feel", corduroy, "--virtual-time", "--seconds", "inf"}, 2, "--seconds"},
                  {{"feel", corduroy, "--virtual-time", "--record", "x.txt"}, 2, "--record"}});
}

TEST(Values, APatchProgramKeepsItsDeviceAndMaterial) {
  const TemporaryFolder folder;
  const std::string program = folder / "c.wpp";
  ASSERT_EQ(wale({"build", corduroy, "-o", program}).status, 0);
  expect_refused({{{"describe", program, "--device", "falcon"}, 2, "expected `sandpaper`, the device"},
                  {{"feel", program, "--virtual-time", "--built-for", "falcon"}, 2, "expected `sandpaper`, the device"},
                  {{"describe", program, "--material", "x"}, 2, "holds only `corduroy`"},
                  {{"describe", program + ":x"}, 1, "holds only `corduroy`"},
                  {{"describe", program, "--exports"}, 2, "leave out --exports"},
                  {{"build", program, "-o", folder / "d.wpp"}, 2, "built for `sandpaper`"}});
  EXPECT_EQ(wale({"describe", program, "--device", "sandpaper"}).status, 0);
  EXPECT_EQ(wale({"feel", program, "--virtual-time", "--built-for", "sandpaper"}).status, 0);
  const std::string recording = folder.write("a.wrec", "\x89WRC"), picture = folder.write("a.png", "\x89PNG");
  expect_refused({{{"describe", recording}, 1, "`wale replay`"}, {{"describe", picture}, 1, "a picture"}});
}

}  // namespace
}  // namespace wale::command_line::values_test
