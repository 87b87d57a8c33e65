// Options that cannot apply to what they are given with: each is refused as wrong usage, and says what to do.
#include <gtest/gtest.h>

#include "tests/command_line/running.hpp"

namespace wale::command_line::applying_test {
namespace {

struct Inapplicable {
  std::vector<std::string> words;
  std::string said;
};

void expect_misuse(const std::vector<Inapplicable>& commands) {
  for (const auto& [words, said] : commands) {
    const Outcome outcome = wale(words);
    std::string command;
    for (const std::string& word : words) command += word + " ";
    EXPECT_EQ(outcome.status, 2) << command << outcome.err;
    EXPECT_EQ(outcome.out, "") << command;
    EXPECT_TRUE(contains(outcome.err, said)) << command << "expected: " << said << "\n" << outcome.err;
  }
}

TEST(Applying, OptionsOfARealDeviceNeedOne) {
  expect_misuse({{{"feel", corduroy, "--virtual-time", "--transport", "hidraw"}, "leave out --transport"},
                 {{"feel", corduroy, "--device", "simulated", "--transport", "evdev"}, "found a simulated one"},
                 {{"devices", "--transport", "hidraw"}, "--identify"},
                 {{"devices", "--save"}, "--identify"},
                 {{"devices", "--max-force", "1 N"}, "--identify"}});
}

TEST(Applying, OptionsOfASimulationNeedOne) {
  expect_misuse({{{"feel", corduroy, "--device", "usb", "--virtual-time"}, "leave out --virtual-time"},
                 {{"feel", corduroy, "--device", "1-2", "--hand", "rest"}, "leave out --virtual-time and --hand"}});
}

TEST(Applying, WatchingNeedsAFileOnDisk) {
  const TemporaryFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder / ".");  // in a checkout the shipped materials are files
  expect_misuse({{{"feel", "brick", "--watch", "--device", "simulated", "--seconds", "0.1"}, "leave out --watch"},
                 {{"feel", corduroy, "--watch", "--virtual-time"}, "--watch"}});
  fs::current_path(before);
  const std::string program = folder / "corduroy.wpp";
  ASSERT_EQ(wale({"build", corduroy, "-o", program}).status, 0);
  EXPECT_EQ(wale({"feel", program, "--watch", "--device", "simulated", "--seconds", "0.1"}).status, 0);
}

TEST(Applying, APadHasNoForceToLimit) {
  expect_misuse({{{"feel", corduroy, "--device", "simulated:touch_pad", "--virtual-time", "--max-force", "1 N"},
                  "leave out --max-force"}});
}

TEST(Applying, ADeviceWithoutAPositionHasNoHandToMove) {
  const TemporaryFolder folder;
  const std::string trace = folder.write("t.csv", "t,x,y\n0,0,0\n1,0.01,0\n");
  for (const std::string& hand : {std::string("rest"), std::string("circular"), trace})
    expect_misuse({{{"feel", corduroy, "--device", "gamepad", "--virtual-time", "--hand", hand}, "leave out --hand"}});
  EXPECT_EQ(wale({"feel", corduroy, "--device", "touch_pad", "--virtual-time", "--hand", "rest"}).status, 0)
      << "its screen knows where the hand is";
}

TEST(Applying, ATransportIsOneOfTheDriverOfTheDevice) {
  // At once, although no such device is plugged in.
  for (const std::string device : {"falcon", "novint-falcon", "0403:cb48"})
    expect_misuse({{{"feel", corduroy, "--device", device, "--transport", "evdev"}, "error[W0801]: --transport: "},
                   {{"devices", "--identify", device, "--transport", "evdev"}, "error[W0801]: --transport: "}});
}

TEST(Applying, AnotherDeviceThanThatOfTheProgramCannotApply) {
  const TemporaryFolder folder;
  const std::string program = folder / "corduroy.wpp";
  ASSERT_EQ(wale({"build", corduroy, "-o", program}).status, 0);
  expect_misuse(
      {{{"build", program, "--device", "falcon", "-o", folder / "x.wpp"}, "error[W0607]: --device: "},
       {{"compare", program, "denim", "--device", "falcon"}, "error[W0607]: --device: "},
       {{"feel", program, "--built-for", "falcon"}, "error[W0607]: --built-for: "},
       {{"feel", program, "--device", "simulated:falcon"}, "error[W0607]: --device: "},
       {{"feel", corduroy, "--device", "simulated:falcon", "--built-for", "sandpaper"}, "error[W0607]: --device: "},
       {{"devices", "--identify", "sandpaper"}, "error[W0801]: --identify: "}});
}

TEST(Applying, WordsThatMakeNoSenseAreMisuse) {
  const TemporaryFolder folder;
  const std::string program = folder / "corduroy.wpp", run = folder / "run.wrec", sound = folder / "q.wav";
  ASSERT_EQ(wale({"build", corduroy, "-o", program}).status, 0);
  ASSERT_EQ(wale({"feel", corduroy, "--virtual-time", "--seconds", "0.1", "--record", run}).status, 0);
  fs::create_symlink("q.wav", folder / "link.csv");
  expect_misuse({{{"preview", corduroy, "-o", folder / "p.docx"}, "error[W0801]"},
                 {{"compare", corduroy + ":", "denim"}, "error[W0801]"},
                 {{"describe", corduroy + ":corduroy", "--material", "other"}, "error[W0801]"},
                 {{"build", program, "-o", folder / "again.wpp"}, "error[W0801]"},
                 {{"replay", run, "--csv", sound, "--wav", sound}, "another file than that of --csv"},
                 {{"replay", run, "--csv", folder / "link.csv", "--wav", sound}, "another file than that of --csv"}});
  EXPECT_FALSE(fs::exists(sound));
}

TEST(Applying, WhatAPatchProgramLacksIsNamed) {
  const TemporaryFolder folder;
  const std::string program = folder / "corduroy.wpp";
  ASSERT_EQ(wale({"build", corduroy, "-o", program}).status, 0);
  expect_misuse({{{"build", program, "--all", "-o", folder / "all"}, "leave out --all"},
                 {{"build", program, "--emit", "ir"}, "the stages listing and cpp"},
                 {{"describe", program, "--device", "all"}, "leave out --device"},
                 {{"describe", program, "--exports"}, "leave out --exports"}});
}

TEST(Applying, OptionsOfOneMaterialAreRefusedWithTheWholeFile) {
  const TemporaryFolder folder;
  const std::string exports = folder.write("f.wale", "wale 1\nexport function twice(x) = 2 * x\n");
  EXPECT_EQ(wale({"describe", exports}).status, 0);
  expect_misuse({{{"describe", exports, "--device", "falcon"}, "leave out --device"},
                 {{"describe", exports, "--set", "a=1"}, "leave out --set"},
                 {{"describe", corduroy, "--exports", "--device", "all"}, "--exports"},
                 {{"describe", corduroy, "--exports", "--set", "wale=3mm"}, "--exports"},
                 {{"build", corduroy, "--emit", "tree", "--material", "corduroy"}, "leave out --material"},
                 {{"build", corduroy, "--emit", "tree", "--device", "falcon"}, "leave out --device"},
                 {{"build", corduroy, "--emit", "checked", "--device", "falcon"}, "leave out --device"}});
}

TEST(Applying, OptionsAboutOtherFilesNeedAWaleFile) {
  const TemporaryFolder folder;
  const std::string program = folder / "corduroy.wpp", library = folder / ".";
  ASSERT_EQ(wale({"build", corduroy, "-o", program}).status, 0);
  expect_misuse({{{"describe", program, "--library", library}, "leave out --library"},
                 {{"describe", program, "--unsandboxed-pictures"}, "leave out --unsandboxed-pictures"},
                 {{"preview", program, "--library", library, "-o", folder / "p.png"}, "leave out --library"},
                 {{"sample", program, "--library", library, "--at", "1 mm, 1 mm"}, "leave out --library"},
                 {{"build", program, "--emit", "cpp", "--library", library}, "leave out --library"},
                 {{"feel", program, "--virtual-time", "--library", library}, "leave out --library"},
                 {{"feel", program, "--virtual-time", "--unsandboxed-pictures"}, "leave out --unsandboxed-pictures"},
                 {{"compare", program, program, "--library", library}, "leave out --library"}});
  EXPECT_EQ(wale({"compare", program, "denim", "--library", library}).status, 0) << "the other is looked for in it";
}

TEST(Applying, AMaterialOfAWholeFileIsRefusedHoweverItIsNamed) {
  expect_misuse({{{"build", corduroy, "--material", "corduroy", "--emit", "tree"}, "leave out --material"},
                 {{"build", corduroy + ":corduroy", "--emit", "tree"}, "leave out the material"},
                 {{"build", "corduroy:corduroy", "--emit", "tree"}, "leave out the material"}});
}

TEST(Applying, AMatrixOfJsonIsRefused) {
  expect_misuse({{{"compare", "corduroy", "denim", "--matrix", "--json"}, "--matrix excludes --json"}});
}

TEST(Applying, AFormatIsWhatTheEndingSays) {
  const TemporaryFolder folder;
  const std::string run = folder / "run.wrec";
  ASSERT_EQ(wale({"feel", corduroy, "--virtual-time", "--seconds", "0.1", "--record", run}).status, 0);
  expect_misuse({{{"replay", run, "--wav", folder / "a.txt"}, "expected a file NAME.wav"},
                 {{"feel", corduroy, "--virtual-time", "--record", folder / "a.txt"}, "NAME.wrec or NAME.csv"}});
  EXPECT_FALSE(fs::exists(folder / "a.txt"));
  // A device has no ending.
  using Words = std::vector<std::string>;
  for (const Words& words : {Words{"replay", run, "--csv", "/dev/full"}, Words{"replay", run, "--wav", "/dev/full"},
                             Words{"feel", corduroy, "--virtual-time", "--record", "/dev/full"}}) {
    const Outcome outcome = wale(words);
    EXPECT_EQ(outcome.status, 1) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "error[W0505]")) << outcome.err;
  }
}

TEST(Applying, EndingsMayBeInCapitalLetters) {
  const TemporaryFolder folder;
  const std::string recording = folder / "R.WREC";
  EXPECT_EQ(wale({"feel", corduroy, "--virtual-time", "--seconds", "0.1", "--record", recording}).status, 0);
  EXPECT_EQ(wale({"replay", recording, "--wav", folder / "R.WAV"}).status, 0);
}

TEST(Applying, SimulatedIsNoNameOfADevice) {
  const Outcome outcome = wale({"feel", corduroy, "--device", "simulated:simulated", "--virtual-time"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(contains(outcome.err, "`simulated` alone is the device that the program is built for")) << outcome.err;
  EXPECT_TRUE(!contains(wale({"feel", corduroy, "--device", "simulatd", "--virtual-time"}).err, "simulated:simulated"));
}

}  // namespace
}  // namespace wale::command_line::applying_test
