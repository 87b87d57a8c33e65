// Help, versions, exit statuses, and files that are wrong.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "tests/command_line/running.hpp"

namespace wale::command_line::asking_test {
namespace {

const std::vector<std::string> verbs{"check",  "explain", "format", "build",  "describe", "find",   "compare",
                                     "levels", "feel",    "replay", "sample", "preview",  "import", "export", "sandpaper", "devices"};

TEST(Help, NamesTheStartForDesignersCuratorsAndProgrammers) {
  const Outcome help = wale({"--help"});
  EXPECT_EQ(help.status, 0);
  const std::string first_lines = help.out.substr(0, 800);
  for (const char* who : {"designers", "curators", "programmers"})
    EXPECT_TRUE(contains(first_lines, who)) << first_lines;
  for (const auto& verb : verbs) EXPECT_TRUE(contains(help.out, "  " + verb)) << verb;
}

TEST(Help, EveryVerbHasItsOwn) {
  for (const auto& verb : verbs) {
    const Outcome help = wale({verb, "--help"});
    EXPECT_EQ(help.status, 0) << verb;
    EXPECT_TRUE(contains(help.out, "for example: wale " + verb)) << help.out;
    EXPECT_EQ(help.err, "") << verb;
  }
}

TEST(Version, NamesProgramAndLanguage) {
  const Outcome version = wale({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_TRUE(version.out.starts_with("wale ")) << version.out;
  EXPECT_TRUE(contains(version.out, "language version 1"));
}

// With OpenImageIO linked, every command would take a quarter of a second longer (compiler/image/image_library.hpp).
TEST(Version, NeedsNoPictureLibrary) { EXPECT_FALSE(contains(bytes_of(WALE_BINARY), "libOpenImageIO")); }

TEST(Misuse, IsStatus2AndSaysSo) {
  const std::vector<std::vector<std::string>> misuses{{},
                                                      {"nonsense"},
                                                      {"chekc", corduroy},
                                                      {"check"},
                                                      {"build", corduroy},
                                                      {"describe", corduroy, "--colour"},
                                                      {"preview", corduroy},
                                                      {"sample", corduroy},
                                                      {"sample", corduroy, "--at", "0 mm, 0 mm", "--trace", "t.csv"},
                                                      {"feel", corduroy, "--seconds", "long"},
                                                      {"describe", corduroy, "--set"}};
  for (const auto& words : misuses) {
    const Outcome outcome = wale(words);
    EXPECT_EQ(outcome.status, 2) << testing::PrintToString(words);
    EXPECT_FALSE(outcome.err.empty()) << testing::PrintToString(words);
  }
}

TEST(Misuse, NearestVerbIsProposed) { EXPECT_TRUE(contains(wale({"chekc", corduroy}).err, "`check`")); }

TEST(Files, EveryVerbRefusesUnreadableFiles) {
  const TemporaryFolder folder;
  const std::string folder_itself = folder / ".", missing = folder / "missing.wale";
  for (const auto& file : {folder_itself, missing}) {
    const std::vector<std::vector<std::string>> commands{{"check", file},
                                                         {"build", file, "-o", folder / "out.wpp"},
                                                         {"describe", file},
                                                         {"feel", file, "--virtual-time", "--seconds", "0.1"},
                                                         {"sample", file, "--at", "0 mm, 0 mm"},
                                                         {"preview", file, "-o", folder / "out.png"}};
    for (const auto& words : commands) {
      const Outcome outcome = wale(words);
      EXPECT_EQ(outcome.status, 1) << testing::PrintToString(words);
      EXPECT_TRUE(contains(outcome.out + outcome.err, file == missing ? "no such file" : "folder"))
          << outcome.out << outcome.err;
    }
  }
}

TEST(Files, InvalidTextIsADiagnostic) {
  const TemporaryFolder folder;
  const std::string empty = folder.write("empty.wale", ""),
                    binary = folder.write("binary.wale", std::string("\x7f"
                                                                     "ELF\0\xff\xfe",
                                                                     7));
  EXPECT_EQ(wale({"check", empty}).status, 1);
  EXPECT_TRUE(contains(wale({"check", empty}).out, "W0104")) << wale({"check", empty}).out;
  EXPECT_EQ(wale({"check", binary}).status, 1);
  EXPECT_TRUE(contains(wale({"check", binary}).out, "W0506")) << wale({"check", binary}).out;
  EXPECT_EQ(wale({"describe", binary}).status, 1);
}

TEST(Files, OfAnotherKindAreToldAsWhatTheyAre) {
  const TemporaryFolder folder;
  using namespace std::string_literals;
  fs::create_directory(folder / "modules");
  folder.write("modules/one.wale", "wale 1\n");
  const std::string program = folder / "corduroy.wpp", recording = folder / "corduroy.wrec";
  ASSERT_EQ(wale({"build", corduroy, "-o", program}).status, 0);
  ASSERT_EQ(wale({"feel", corduroy, "--virtual-time", "--seconds", "0.1", "--record", recording}).status, 0);
  const struct {
    std::string file, what, mend;
  } kinds[] = {{recording, "a recording", "wale replay"},
               {folder.write("a.png", "\x89PNG\r\n\x1a\n"), "a picture", "image("},
               {folder.write("a.csv", "t,x,y\n0,0,0\n"), "a table", "table("},
               {folder.write("a.wale", "\x01\x02\0\x03"s), "a binary file", "begin with `wale 1`"},
               {folder / "modules", "a folder", "modules/one.wale`"},
               {folder.write("empty", ""), "the end of the file", "write `wale 1`"}};
  for (const auto& [file, what, mend] : kinds)
    for (const std::vector<std::string>& verb :
         std::vector<std::vector<std::string>>{{"check"},
                                               {"format"},
                                               {"describe"},
                                               {"compare", corduroy},
                                               {"feel", "--virtual-time"},
                                               {"preview", "-o", folder / "out.png"}}) {
      std::vector<std::string> words = verb;
      words.push_back(file);
      const Outcome outcome = wale(words);
      EXPECT_EQ(outcome.status, 1) << testing::PrintToString(words);
      for (const std::string& part : {what, mend})
        EXPECT_TRUE(contains(outcome.out + outcome.err, part)) << part << '\n' << outcome.out << outcome.err;
      EXPECT_FALSE(contains(outcome.out + outcome.err, "W0107")) << outcome.out << outcome.err;
    }
  for (const char* verb : {"check", "format"}) {
    const Outcome outcome = wale({verb, program});
    EXPECT_TRUE(contains(outcome.out + outcome.err, "found a patch program")) << outcome.out << outcome.err;
    EXPECT_TRUE(contains(outcome.out + outcome.err, "the Wale file that it was built from")) << outcome.err;
  }
}

TEST(Files, OutputsThatCannotBeWrittenAreErrors) {
  const TemporaryFolder folder;
  const std::string nowhere = folder / "missing/out";
  const std::vector<std::vector<std::string>> commands{
      {"build", corduroy, "-o", nowhere + ".wpp"},
      {"preview", corduroy, "-o", nowhere + ".png"},
      {"sample", corduroy, "--at", "0 mm, 0 mm", "-o", nowhere + ".csv"},
      {"feel", corduroy, "--virtual-time", "--seconds", "0.1", "--record", nowhere + ".csv"}};
  for (const auto& words : commands) {
    const Outcome outcome = wale(words);
    EXPECT_EQ(outcome.status, 1) << testing::PrintToString(words);
    EXPECT_TRUE(contains(outcome.err, "cannot write")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "missing/out")) << outcome.err;
  }
}

TEST(Check, CountsAndStatus) {
  const TemporaryFolder folder;
  EXPECT_EQ(wale({"check", corduroy}).status, 0);
  EXPECT_TRUE(contains(wale({"check", corduroy}).out, "1 file: 0 errors, 0 warnings"));
  const std::string warned =
      folder.write("warned.wale", "wale 1\nmaterial a { physical { let b = 2\n force = -1 N/m * hand } }\n");
  const Outcome warning = wale({"check", corduroy, warned});
  EXPECT_EQ(warning.status, 0) << "a warning is no error";
  EXPECT_TRUE(contains(warning.out, "2 files: 0 errors, 1 warning")) << warning.out;
  const std::string wrong =
      folder.write("wrong.wale", "wale 1\nmaterial a { physical { param k = 3 N\n force = k * x } }\n");
  const Outcome error = wale({"check", wrong, corduroy});
  EXPECT_EQ(error.status, 1);
  EXPECT_TRUE(contains(error.out, "N    = kg m   s^-2")) << error.out;
  EXPECT_TRUE(contains(error.out, "N m  = kg m^2 s^-2")) << error.out;
  EXPECT_TRUE(contains(error.out, "if `k` (line 2) is meant as a stiffness, give it in N/m")) << error.out;
}

TEST(Check, JsonHasEveryFieldOfADiagnostic) {
  const TemporaryFolder folder;
  const std::string wrong = folder.write("wrong.wale", "wale 1\nmaterial a { physical { force = 3 mm * hand } }\n");
  const Outcome outcome = wale({"check", "--json", wrong});
  EXPECT_EQ(outcome.status, 1);
  const auto diagnostics = outcome.json();
  ASSERT_EQ(diagnostics.size(), 1u);
  const auto& only = diagnostics[0];
  EXPECT_EQ(only.at("code"), "W0301");
  EXPECT_EQ(only.at("severity"), "error");
  EXPECT_EQ(only.at("file"), wrong);
  EXPECT_EQ(only.at("line"), 2);
  EXPECT_EQ(only.at("column"), 33);
  EXPECT_EQ(only.at("message"), "expected force, found area");
  for (const char* field : {"end_line", "end_column", "expected", "found", "help"})
    EXPECT_TRUE(only.contains(field)) << field;
  EXPECT_EQ(wale({"check", "--json", corduroy}).json(), nlohmann::json::array());
}

TEST(Devices, IncludeTheSimulatedOneAndThoseToBuildFor) {
  EXPECT_TRUE(contains(wale({"devices"}).out, "sandpaper"));
  EXPECT_TRUE(contains(wale({"devices"}).out, "plugged in"));
  const auto devices = wale({"devices", "--json"}).json();
  const auto named = [&](const std::string& name) {
    for (const auto& device : devices)
      if (device.at("name") == name) return device;
    return nlohmann::json();
  };
  EXPECT_EQ(named("simulated").at("feel"), true);
  EXPECT_EQ(named("sandpaper").at("force_newton"), 10.0);
  EXPECT_EQ(named("sandpaper").at("rate_hz"), 900.0);
}

TEST(Devices, StandInOneColumn) {
  std::istringstream lines(wale({"devices"}).out);
  std::set<std::size_t> columns;
  for (std::string line; std::getline(lines, line);)
    for (const char* figure : {"2 axes, ", "moving mass "})
      if (const auto at = line.find(figure); at != std::string::npos) columns.insert(at);
  EXPECT_EQ(columns.size(), 1u) << testing::PrintToString(columns);
}

TEST(Devices, HaveTheirStepsInWholeNumbers) {
  const std::string text = wale({"devices"}).out;
  EXPECT_TRUE(contains(text, "openffboard   2 axes, 20 N in 32 767 steps")) << text;
  EXPECT_TRUE(contains(text, "arduino_ffb   2 axes, 20 N in 10 000 steps")) << text;
  EXPECT_FALSE(contains(text, "e+0")) << text;
}

TEST(Devices, HaveNoFigureForAnUnknownHandle) {
  const TemporaryFolder folder;
  std::string text = bytes_of(std::string(WALE_SOURCE_DIR) + "/calibration/devices/falcon.wale");
  text = text.substr(text.find("device falcon"));
  text.replace(text.find("falcon"), 6, "mine");
  text.replace(text.find("  usb"), 5, "  // ");
  for (const char* key : {"mass", "damping", "friction"}) {
    const auto at = text.find(std::string("\n  ") + key + " ");
    ASSERT_NE(at, std::string::npos) << key;
    text.replace(at + 1, text.find('\n', at + 1) - at - 1, std::string(key) + " unknown");
  }
  const std::string file = folder.write("mine.wale", "wale 1\nexport " + text);
  const Outcome shown = wale({"devices", "--devices", file});
  EXPECT_TRUE(contains(shown.out, "moving mass unknown, damping unknown, friction unknown\n"))
      << shown.out << shown.err;
  bool is_found = false;
  for (const auto& device : wale({"devices", "--json", "--devices", file}).json()) {
    if (device["name"] != "mine") continue;
    is_found = true;
    for (const char* figure : {"mass_kg", "damping_newton_second_per_m", "friction_newton"})
      EXPECT_TRUE(device.at(figure).is_null()) << figure;
  }
  EXPECT_TRUE(is_found);
}

TEST(Options, AnUnknownOneIsToldBeforeWhatIsMissing) {
  const Outcome outcome = wale({"feel", "--hlp"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(contains(outcome.err, "there is no option `--hlp`; did you mean `--help`?")) << outcome.err;
  EXPECT_TRUE(contains(wale({"feel"}).err, "FILE is required"));
}

TEST(Options, ASettingNeedsAName) {
  const Outcome outcome = wale({"describe", corduroy, "--set", "=3"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(contains(outcome.err, "--set: expected NAME=VALUE, found \"=3\"")) << outcome.err;
}

TEST(Options, CheckSaysForWhichDevice) {
  const std::string help = wale({"check", "--help"}).out;
  EXPECT_TRUE(contains(help, "sandpaper") && contains(help, "wale describe FILE --device")) << help;
}

TEST(Devices, HaveNoFigureForAnUnknownBandwidth) {
  std::size_t unknown = 0;
  for (const auto& device : wale({"devices", "--json"}).json()) {
    if (!device.contains("bandwidth_hz")) continue;
    const std::vector<std::string> without = device.at("unknown");
    const bool is_unknown = std::ranges::find(without, "bandwidth") != without.end();
    unknown += is_unknown;
    for (const auto& axis : device.at("bandwidth_hz")) EXPECT_EQ(axis.is_null(), is_unknown) << device;
  }
  EXPECT_GT(unknown, 0u);
}

TEST(Choices, UnknownNamesAreRefusedWithTheNearest) {
  const TemporaryFolder folder;
  const Outcome material = wale({"describe", corduroy, "--material", "corderoy"});
  EXPECT_EQ(material.status, 2);
  EXPECT_TRUE(contains(material.err, "`corduroy`")) << material.err;
  const Outcome device = wale({"build", corduroy, "--device", "sandpapre", "-o", folder / "out.wpp"});
  EXPECT_EQ(device.status, 2);
  EXPECT_TRUE(contains(device.err, "`sandpaper`")) << device.err;
  EXPECT_EQ(wale({"feel", corduroy, "--device", "phantom", "--virtual-time"}).status, 2);
}

}  // namespace
}  // namespace wale::command_line::asking_test
