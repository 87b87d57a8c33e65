// `wale calibrate device`: readings in, a declaration out, and what may reach the owner's file.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/command_line/child.hpp"
#include "tests/command_line/running.hpp"

namespace wale::command_line::calibrating_test {
namespace {

/// An owner with a stick of 10 N, and a table of what a gauge showed on it.
struct Owner {
  TemporaryFolder folder;
  std::string file;  ///< the owner's devices.wale
  const std::string declaration =
      "wale 1\n\n// mine since spring\nexport device my_stick {\n  usb \"1209:ffb0\"   // the adapter\n  workspace "
      "disc(100 mm)\n"
      "  position 1024 counts\n  force 10 N, 1000 counts; rate 500 Hz\n  gain 1   // not measured\n  speed 1 m/s\n  "
      "slew 100 N/s\n"
      "  velocity_filter 15, 1 counts\n  patch 60 mm, 60 mm, 5 mm\n  source \"my desk\"\n}\n\n"
      "export device other { workspace disc(90 mm); position 512 counts; force 5 N, 500 counts; rate 500 Hz; speed 1 "
      "m/s; "
      "slew 100 N/s; velocity_filter 15, 1 counts; patch 60 mm, 60 mm, 5 mm }\n";

  Owner() {
    fs::create_directories(folder / "config/wale");
    file = folder.write("config/wale/devices.wale", declaration);
  }
  std::string config() const { return folder / "config"; }

  /// Readings of a motor with a gain of 0.9 and a dead band of 0.3 N, times `scale`.
  std::string table(double scale = 1, const std::string& more = {}) const {
    std::string text =
        "axis,direction,command (N),reading (N),repeat" + std::string(more.empty() ? "" : ",grade") + "\n";
    int number = 0;
    for (const char* way : {"right", "left", "away", "toward"})
      for (const int repeat : {1, 2})
        for (const double command : {0.0, 0.2, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0}) {
          const double noise = 0.01 * std::sin(++number * 7.3);
          const double reading = scale * (0.9 * std::max(0.0, command - 0.3) + noise);
          text += std::string(*way == 'r' || *way == 'l' ? "x," : "y,") + way + "," + std::to_string(command) + "," +
                  std::to_string(reading) + "," + std::to_string(repeat) + (more.empty() ? "" : "," + more) + "\n";
        }
    return folder.write(more.empty() ? "gauge.csv" : "gauge_" + more + ".csv", text);
  }
};

/// The number after these words; not-a-number if they are not there.
double number_after(const std::string& text, const std::string& words) {
  const auto at = text.find(words);
  return at == std::string::npos ? std::nan("") : std::strtod(text.c_str() + at + words.size(), nullptr);
}

TEST(Calibrating, ATableBecomesSettingsInTheOwnersFile) {
  const Owner owner;
  const Outcome outcome =
      wale({"calibrate-device", "--device", "my_stick", "--table", owner.table(), "--yes"}, {}, owner.config());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NEAR(number_after(outcome.err, "right: 22 readings at 11 commands\n  gain"), 0.9, 0.01) << outcome.err;
  const std::string text = bytes_of(owner.file);
  EXPECT_NEAR(number_after(text, "\n  gain right "), 0.9, 0.01) << text;
  EXPECT_NEAR(number_after(text, "\n  dead_band toward "), 0.3, 0.03) << text;
  EXPECT_TRUE(contains(text, "\n  nonlinearity left quadratic ")) << text;
  EXPECT_TRUE(contains(text, ", within ")) << text;
  EXPECT_FALSE(contains(text, "not measured")) << "the old gain goes with its comment: " << text;
  EXPECT_TRUE(contains(text, "// mine since spring\nexport device my_stick {\n  usb \"1209:ffb0\"   // the adapter\n"))
      << "all else stays: " << text;
  EXPECT_TRUE(contains(text, "force 10 N, 1000 counts; rate 500 Hz\n  speed 1 m/s")) << text;
  EXPECT_TRUE(contains(text, "export device other {")) << text;
  EXPECT_EQ(wale({"check", owner.file}).status, 0);
  EXPECT_TRUE(
      contains(wale({"devices"}, {}, owner.config()).out, "its forces are corrected by what was measured on it"));
  // Again: the settings are replaced, and not added.
  const Outcome again =
      wale({"calibrate-device", "--device", "my_stick", "--table", owner.table(), "--yes"}, {}, owner.config());
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(wale({"check", owner.file}).status, 0);
  std::size_t count = 0;
  const std::string twice = bytes_of(owner.file);
  for (std::size_t at = twice.find("gain right"); at != std::string::npos; at = twice.find("gain right", at + 1))
    ++count;
  EXPECT_EQ(count, 1u) << twice;
}

TEST(Calibrating, WhatWasFoundIsToldAsJson) {
  const Owner owner;
  const std::string out = owner.folder / "measured.wale";
  const Outcome outcome = wale(
      {"calibrate-device", "--device", "my_stick", "--table", owner.table(), "--json", "-o", out}, {}, owner.config());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["device"], "my_stick");
  EXPECT_EQ(json["simulated"], false);
  ASSERT_EQ(json["ways"].size(), 4u);
  for (const auto& way : json["ways"]) {
    EXPECT_EQ(way["readings"], 22);
    EXPECT_NEAR(way["gain"]["value"].get<double>(), 0.9, 0.01);
    EXPECT_LT(way["gain"]["low"].get<double>(), way["gain"]["value"].get<double>());
    EXPECT_NEAR(way["dead_band_newton"]["value"].get<double>(), 0.3, 0.03);
    EXPECT_TRUE(way["saturation_newton"].is_null()) << "none was reached";
    EXPECT_EQ(way["residuals_newton"].size(), 22u);
  }
  EXPECT_TRUE(json["handle"].empty()) << "a table shakes no handle";
  EXPECT_EQ(json["declaration"], bytes_of(out));
  const Outcome both =
      wale({"calibrate-device", "--device", "my_stick", "--table", owner.table(), "--json", "-o", "-"}, {}, owner.config());
  EXPECT_EQ(both.status, 2);
  EXPECT_TRUE(both.out.empty()) << both.out;
  const Outcome shaken = wale({"calibrate-device", "--device", "simulated:sandpaper", "--json", "--seed", "3"});
  ASSERT_EQ(shaken.status, 0) << shaken.err;
  const auto planted = nlohmann::json::parse(shaken.out);
  EXPECT_EQ(planted["simulated"], true);
  ASSERT_EQ(planted["handle"].size(), 2u);
  const auto& mass = planted["handle"][0]["mass_kg"];
  EXPECT_LE(mass["low"].get<double>(), mass["high"].get<double>());
}

TEST(Calibrating, NothingIsWrittenWithoutAYes) {
  const Owner owner;
  const Outcome none = wale({"calibrate-device", "--device", "my_stick", "--table", owner.table()}, {}, owner.config());
  EXPECT_EQ(none.status, 1);
  EXPECT_TRUE(contains(none.out, "export device my_stick {")) << "it is shown first";
  EXPECT_EQ(bytes_of(owner.file), owner.declaration);
  const Outcome no =
      wale({"calibrate-device", "--device", "my_stick", "--table", owner.table()}, "no\n", owner.config());
  EXPECT_EQ(no.status, 1);
  EXPECT_EQ(bytes_of(owner.file), owner.declaration);
  const Outcome yes =
      wale({"calibrate-device", "--device", "my_stick", "--table", owner.table()}, "yes\n", owner.config());
  EXPECT_EQ(yes.status, 0) << yes.err;
  EXPECT_NE(bytes_of(owner.file), owner.declaration);
}

TEST(Calibrating, ATableInGramForceIsRefused) {
  const Owner owner;
  const Outcome outcome =
      wale({"calibrate-device", "--device", "my_stick", "--table", owner.table(1000 / 9.80665), "--yes"},
           "yes\nyes\nyes\nyes\nyes\n", owner.config());
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(contains(outcome.err, "would have a gain of 91")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "gram-force typed as newton makes a gain 102 times too large")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "gauge.csv")) << outcome.err;
  EXPECT_EQ(bytes_of(owner.file), owner.declaration);
}

TEST(Calibrating, AFarGainNeedsAWordOfItsOwn) {
  const Owner owner;
  const std::vector<std::string> words{"calibrate-device", "--device", "my_stick", "--table", owner.table(2), "--yes"};
  const Outcome unsaid = wale(words, {}, owner.config());
  EXPECT_EQ(unsaid.status, 1);
  EXPECT_NEAR(number_after(unsaid.err, "the declared gain is 1, and the readings say "), 1.8, 0.02) << unsaid.err;
  EXPECT_TRUE(contains(unsaid.err, "would be 102 times")) << unsaid.err;
  EXPECT_EQ(bytes_of(owner.file), owner.declaration);
  const Outcome once = wale(words, "yes\nno\n", owner.config());
  EXPECT_EQ(once.status, 1) << "each way is asked about";
  EXPECT_EQ(bytes_of(owner.file), owner.declaration);
  const Outcome said = wale(words, "yes\nyes\nyes\nyes\n", owner.config());
  EXPECT_EQ(said.status, 0) << said.err;
  EXPECT_NEAR(number_after(bytes_of(owner.file), "gain right "), 1.8, 0.02);
}

TEST(Calibrating, ASimulationNeverReachesTheOwnersFile) {
  const Owner owner;
  const std::string out = owner.folder / "out.wale", kept = owner.folder / "kept.csv";
  const Outcome simulated =
      wale({"calibrate-device", "--device", "simulated:sandpaper", "-o", out, "--readings", kept, "--yes"},
           "yes\nyes\nyes\nyes\nyes\n", owner.config());
  ASSERT_EQ(simulated.status, 0) << simulated.err;
  EXPECT_TRUE(contains(simulated.err, "nothing of it enters your trusted file")) << simulated.err;
  EXPECT_TRUE(contains(bytes_of(out), "export device simulated_sandpaper {")) << bytes_of(out);
  EXPECT_TRUE(contains(bytes_of(out), "grade simulated")) << bytes_of(out);
  EXPECT_NEAR(number_after(bytes_of(out), "  mass "), 0.3, 0.01) << "of both axes: " << bytes_of(out);
  EXPECT_TRUE(contains(simulated.err, "the handle along y, by ")) << simulated.err;
  EXPECT_EQ(wale({"check", out}).status, 0);
  // The same of a device that the owner declares, if it is simulated, and of a table that came from a simulation.
  for (const auto& words : std::vector<std::vector<std::string>>{
           {"calibrate-device", "--device", "simulated:my_stick", "--yes"},
           {"calibrate-device", "--device", "my_stick", "--table", kept, "--yes"},
           {"calibrate-device", "--device", "my_stick", "--table", owner.table(1, "simulated"), "--yes"},
           {"calibrate-device", "--device", "other", "--table", owner.table(0.5), "--yes"},
           {"calibrate-device", "--device", "pointer", "--table", owner.table(), "--yes"}}) {
    const Outcome outcome = wale(words, "yes\nyes\nyes\nyes\nyes\n", owner.config());
    EXPECT_FALSE(contains(outcome.err, "written to")) << outcome.err;
    EXPECT_EQ(bytes_of(owner.file), owner.declaration) << testing::PrintToString(words) << outcome.err;
    EXPECT_FALSE(contains(outcome.out, "usb")) << "it is about no plugged device: " << outcome.out;
  }
  EXPECT_NE(wale({"calibrate-device", "--device", "pointer"}, {}, owner.config()).status, 0);
}

TEST(Calibrating, WrongTablesAreNamedByFileAndRow) {
  const Owner owner;
  const std::string good = bytes_of(owner.table());
  const auto refused = [&](const std::string& text) {
    const std::string table = owner.folder.write("bad.csv", text);
    const Outcome outcome =
        wale({"calibrate-device", "--device", "my_stick", "--table", table, "--yes"}, "yes\n", owner.config());
    EXPECT_NE(outcome.status, 0) << text;
    EXPECT_TRUE(contains(outcome.err, "bad.csv")) << outcome.err;
    return outcome.err;
  };
  std::string words = good;
  words.replace(words.find("1.000000"), 8, "one");
  EXPECT_TRUE(contains(refused(words), "bad.csv:5: command: expected a number with its unit, found \"one\""))
      << refused(words);
  std::string unitless = good;
  unitless.replace(unitless.find("reading (N)"), 11, "reading");
  EXPECT_TRUE(contains(refused(unitless), "the unit is missing")) << refused(unitless);
  EXPECT_TRUE(contains(refused(good.substr(0, good.find('\n', 200) + 1)), "too few for a fit"));
  EXPECT_TRUE(contains(refused(good + good.substr(good.find('\n') + 1, 30) + "\n"), "bad.csv:"));
  EXPECT_EQ(bytes_of(owner.file), owner.declaration);
}

/// A file that is written is replaced as a whole, whenever the process is killed.
TEST(Calibrating, KilledWhileWritingTheOldFileIsWhole) {
  const Owner owner;
  const std::string table = owner.table();
  setenv("XDG_CONFIG_HOME", owner.config().c_str(), 1);
  int old = 0, fresh = 0;
  for (int round = 0; round < 12; ++round) {
    owner.folder.write("config/wale/devices.wale", owner.declaration);
    int status = 0;
    {
      Child child({"calibrate-device", "--device", "my_stick", "--table", table, "--yes"}, owner.folder / "out",
                  owner.folder / "err");
      // At another moment each time: the last rounds let it finish.
      const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(20 * round);
      while (!child.has_ended(status) && (round > 9 || std::chrono::steady_clock::now() < until))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const std::string text = bytes_of(owner.file);
    if (text == owner.declaration) {
      ++old;
    } else {
      ++fresh;
      EXPECT_TRUE(contains(text, "dead_band toward") && contains(text, "export device other {") &&
                  text.ends_with("}\n"))
          << text;
    }
    std::size_t files = 0;
    for (const auto& each : fs::directory_iterator(owner.folder / "config/wale"))
      files += each.is_regular_file() ? 1 : 0;
    EXPECT_LE(files, 2u);
  }
  unsetenv("XDG_CONFIG_HOME");
  EXPECT_GT(old, 0);
  EXPECT_GT(fresh, 0);
}

}  // namespace
}  // namespace wale::command_line::calibrating_test
