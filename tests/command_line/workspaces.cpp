// Workspaces on the command line: check, describe, feel.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/command_line/running.hpp"

namespace wale::command_line::workspaces_test {
namespace {

/// Two materials side by side, on the way of a hand along x: rough on the left, smooth on the right.
constexpr const char* two =
    "wale 1\n"
    "/// Side by side.\n"
    "workspace desk {\n"
    "  patch left = denim(roughness: 0.6) { at -20 mm, 0 mm; size 40 mm, 40 mm }\n"
    "  patch right = denim(roughness: 0.2) { at 20 mm, 0 mm; size 40 mm, 40 mm; mark yarn, low 1 mm, \"denim\" }\n"
    "  patch away = oak { at 0 mm, 60 mm; size 40 mm, 30 mm; shape ellipse }\n"
    "}\n";

struct Desk {
  TemporaryFolder folder;
  std::string file = folder.write("desk.wale", two);
};

/// A grey picture of 40 x 20 pixels: `grey` in its right half, black in its left one.
std::string half(char grey) {
  std::string picture = "P5\n40 20\n255\n";
  for (int row = 0; row < 20; ++row) picture += std::string(20, '\0') + std::string(20, grey);
  return picture;
}

TEST(WorkspacesOnTheCommandLine, AreCheckedAndFormatted) {
  const Desk desk;
  const Outcome checked = wale({"check", desk.file});
  EXPECT_EQ(checked.status, 0) << checked.err;
  EXPECT_EQ(wale({"format", desk.file}).status, 0);
  EXPECT_TRUE(contains(bytes_of(desk.file), "    at   -20 mm, 0 mm\n")) << bytes_of(desk.file);
}

TEST(WorkspacesOnTheCommandLine, AreDescribedPatchByPatch) {
  const Desk desk;
  const Outcome told = wale({"describe", desk.file});
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_TRUE(contains(told.out, "workspace desk on sandpaper: 3 patches, the last in front\n  Side by side.\n"))
      << told.out;
  EXPECT_TRUE(contains(told.out, "  left   at -20 mm, 0 mm; 40 mm x 40 mm rectangle, rim 1 mm\n")) << told.out;
  EXPECT_TRUE(contains(told.out, "denim(roughness: 0.6): roughness 0.6")) << told.out;
  EXPECT_TRUE(contains(told.out, "marked: yarn, low 1 mm, \"denim\"\n")) << told.out;
  EXPECT_TRUE(contains(told.out, "40 mm x 30 mm ellipse")) << told.out;
  const auto json = wale({"describe", desk.file, "--workspace", "desk", "--json"}).json();
  EXPECT_EQ(json["patches"].size(), 3u);
  EXPECT_NEAR(json["patches"][0]["x_m"].get<double>(), -0.02, 1e-9);
  EXPECT_NEAR(json["patches"][1]["marks"][0]["low_si"].get<double>(), 1e-3, 1e-9);
}

TEST(WorkspacesOnTheCommandLine, AreFeltTogether) {
  const Desk desk;
  // A trace from the left patch to the right one, at 50 mm/s.
  std::string trace = "t (s),x (m),y (m)\n";
  for (int i = 0; i <= 60; ++i) trace += std::to_string(0.01 * i) + "," + std::to_string(-0.015 + 5e-4 * i) + ",0\n";
  const Outcome felt = wale({"feel", desk.file, "--workspace", "desk", "--virtual-time", "--seconds", "0.6", "--hand",
                             desk.folder.write("hand.csv", trace), "--json"});
  ASSERT_EQ(felt.status, 0) << felt.err;
  const auto json = felt.json();
  EXPECT_EQ(json["patches"][0]["entries"], 1);
  EXPECT_EQ(json["patches"][1]["entries"], 1);
  EXPECT_EQ(json["patches"][2]["entries"], 0);
  EXPECT_NEAR(json["patches"][0]["seconds"].get<double>(), 0.3, 0.1);
  EXPECT_GT(json["patches"][0]["rms_newton"].get<double>(), 1.5 * json["patches"][1]["rms_newton"].get<double>());
}

TEST(WorkspacesOnTheCommandLine, ShapesAreFeltWhereTheyAre) {
  const Desk desk;
  // Half of the mask is light; an ellipse of 40 mm; a triangle to the right of the centre. The hand goes along a line
  // from x = -60 to 60 mm at a height y, and is on each shape for a length that is known.
  desk.folder.write("half.pgm", half('\xff'));
  const std::string file = desk.folder.write(
      "shapes.wale",
      "wale 1\nworkspace shapes {\n"
      "  patch mask = denim { at -40 mm, 0 mm; shape mask(\"half.pgm\", scale: 1 mm/px) }\n"  // from -40 to -20 mm
      "  patch round = denim { at 0 mm, 0 mm; size 30 mm, 24 mm; shape ellipse }\n"
      "  patch corner = denim { at 40 mm, 0 mm; shape polygon(-20 mm, -20 mm, 20 mm, -20 mm, -20 mm, 20 mm) }\n}\n");
  const double height = 0.009;  // m
  std::string trace = "t (s),x (m),y (m)\n";
  for (int i = 0; i <= 120; ++i)
    trace += std::to_string(0.01 * i) + "," + std::to_string(-0.06 + 1e-3 * i) + "," + std::to_string(height) + "\n";
  const Outcome felt = wale({"feel", file, "--workspace", "shapes", "--virtual-time", "--seconds", "1.2", "--hand",
                             desk.folder.write("hand.csv", trace), "--json"});
  ASSERT_EQ(felt.status, 0) << felt.err;
  const auto json = felt.json();
  const double on_ellipse = 30 * std::sqrt(1 - std::pow(height / 0.012, 2));  // mm
  const double expected[] = {20, on_ellipse, 40 - (1e3 * height + 20)};
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(json["patches"][i]["entries"], 1) << i;
    // At 100 mm/s; the handle follows the hand within some millimetres.
    EXPECT_NEAR(json["patches"][i]["seconds"].get<double>(), expected[i] / 100, 0.04) << i;
  }
}

TEST(WorkspacesOnTheCommandLine, AGapIsAsNarrowAsItsNarrowestPlace) {
  const Desk desk;
  // A tip points at a straight edge, 0.3 mm away; its height, y = 0.07 to 0.47 mm, is between what a scan would meet.
  for (const double y : {0.07, 0.13, 0.2, 0.29, 0.33, 0.47}) {
    const std::string file = desk.folder.write(
        "tip.wale",
        "wale 1\nworkspace tip {\n  patch left = corduroy { at -20 mm, " + std::to_string(y) +
            " mm; shape polygon(-20 mm, -20 mm, 20 mm, 0 mm, -20 mm, 20 mm) }\n"
            "  patch right = oak { at 20.3 mm, 0 mm; size 40 mm, 40 mm }\n}\n");
    const Outcome outcome = wale({"check", file, "--json"});
    bool told = false;
    for (const auto& each : outcome.json()) {
      if (each["code"] != "W0435") continue;
      told = true;
      EXPECT_NEAR(each["facts"][0]["value"].get<double>(), 0.3, 0.005) << y << "\n" << each;
    }
    EXPECT_TRUE(told) << y << outcome.out;
  }
}

TEST(WorkspacesOnTheCommandLine, AreBuiltToOneFileThatFeelsTheSame) {
  const Desk desk;
  const std::string built = desk.folder / "desk.wws";
  const Outcome outcome = wale({"build", desk.file, "--workspace", "desk", "-o", built});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto felt = [](std::vector<std::string> words) {
    words.insert(words.end(), {"--virtual-time", "--seconds", "1", "--json"});
    const Outcome outcome = wale(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.json().at("patches").dump();
  };
  EXPECT_EQ(felt({"feel", built}), felt({"feel", desk.file, "--workspace", "desk"}));
  const std::string again = desk.folder / "again.wws";
  ASSERT_EQ(wale({"build", desk.file, "--workspace", "desk", "-o", again}).status, 0);
  EXPECT_EQ(bytes_of(again), bytes_of(built));
  std::string bytes = bytes_of(built);
  bytes[bytes.size() / 2] ^= 1;
  const Outcome damaged = wale({"feel", desk.folder.write("damaged.wws", bytes), "--virtual-time"});
  EXPECT_EQ(damaged.status, 1);
  EXPECT_TRUE(contains(damaged.err, "W0506")) << damaged.err;
  EXPECT_EQ(wale({"feel", built, "--set", "yarn=1 mm"}).status, 2);
  EXPECT_EQ(wale({"build", desk.file, "--workspace", "desc", "-o", again}).status, 2);
}

TEST(WorkspacesOnTheCommandLine, AreDrawnFromAbove) {
  const Desk desk;
  const auto drawn = [&](const std::string& name) {
    const std::string file = desk.folder / name;
    const Outcome outcome = wale({"preview", desk.file, "--workspace", "desk", "-o", file});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return bytes_of(file);
  };
  const std::string picture = drawn("desk.png");
  EXPECT_EQ(picture.substr(1, 3), "PNG");
  EXPECT_EQ(picture.substr(16, 8), std::string("\0\0\x06\x40\0\0\x04\xd8", 8)) << "1600 x 1240 pixels";
  EXPECT_EQ(drawn("again.png"), picture);
  EXPECT_TRUE(contains(drawn("desk.svg"), "<svg"));
  EXPECT_EQ(wale({"preview", desk.file, "--workspace", "desc", "-o", desk.folder / "x.png"}).status, 2);
  EXPECT_EQ(wale({"preview", desk.file, "--workspace", "desk", "--along", "y", "-o", desk.folder / "x.png"}).status, 2);
}

TEST(WorkspacesOnTheCommandLine, AMaskIsWhereItsPictureIsLight) {
  const Desk desk;
  desk.folder.write("half.pgm", half('\x80'));
  desk.folder.write("dark.pgm", half('\x7f'));
  const auto masked = [&](const std::string& verb, const std::string& file, const std::string& at) {
    return wale(
        {verb, desk.folder.write("mask.wale", "wale 1\nworkspace desk {\n  patch a = denim { at " + at +
                                                  ", 0 mm; shape mask(\"" + file + "\", scale: 1 mm/px) }\n}\n")});
  };
  const Outcome good = masked("describe", "half.pgm", "0 mm");
  EXPECT_EQ(good.status, 0) << good.err;
  EXPECT_TRUE(contains(good.out, "40 mm x 20 mm mask half.pgm")) << good.out;
  EXPECT_TRUE(contains(masked("check", "dark.pgm", "0 mm").out, "W0314"));
  // Only the light half counts: to the left of the centre the dark one may lie beyond the edge, 114.3 mm away.
  EXPECT_FALSE(contains(masked("check", "half.pgm", "-100 mm").out, "W0427"));
  EXPECT_TRUE(contains(masked("check", "half.pgm", "100 mm").out, "W0427"));
}

/// A coloured picture of 60 x 40 pixels: red on the left, blue on the right, a white band of 10 pixels between them.
std::string coloured() {
  std::string picture = "P6\n60 40\n255\n";
  for (int row = 0; row < 40; ++row)
    for (int column = 0; column < 60; ++column)
      picture += column < 25 ? "\xc0\x40\x20" : column < 35 ? "\xff\xff\xff" : "\x20\x60\xc0";
  return picture;
}

TEST(WorkspacesOnTheCommandLine, AMapIsMadeOfAColouredPicture) {
  const Desk desk;
  desk.folder.write("map.ppm", coloured());
  const auto map = [&](const std::string& settings) {
    return desk.folder.write("map.wale",
                             "wale 1\n\nworkspace map {\n  patch oak = oak { at 0 mm, 80 mm; size 20 mm, 20 mm }\n"
                             "  patches from picture(\"map.ppm\", scale: 1 mm/px) {\n" +
                                 settings + "  }\n}\n");
  };
  const std::string file =
      map("    colour \"#c04020\" = denim(roughness: 0.6)\n    colour \"#2060c0\" = oak\n    blank  \"#ffffff\"\n");
  const Outcome checked = wale({"check", file});
  EXPECT_EQ(checked.status, 0) << checked.err << checked.out;
  EXPECT_EQ(wale({"format", file}).status, 0);
  EXPECT_EQ(wale({"format", "--check", file}).status, 0);
  const Outcome told = wale({"describe", file});
  ASSERT_EQ(told.status, 0) << told.err;
  EXPECT_TRUE(contains(told.out, "  denim  at -17.5 mm, 0 mm; 25 mm x 40 mm colour #c04020 of map.ppm")) << told.out;
  EXPECT_TRUE(contains(told.out, "  oak_2  at 17.5 mm, 0 mm; 25 mm x 40 mm colour #2060c0 of map.ppm")) << told.out;
  EXPECT_EQ(wale({"preview", file, "--workspace", "map", "-o", desk.folder / "map.png"}).status, 0);
  const std::string built = desk.folder / "map.wws";
  ASSERT_EQ(wale({"build", file, "--workspace", "map", "-o", built}).status, 0);
  // Along x at 100 mm/s: 25 mm on the one, 10 mm on nothing, 25 mm on the other.
  std::string trace = "t (s),x (m),y (m)\n";
  for (int i = 0; i <= 80; ++i) trace += std::to_string(0.01 * i) + "," + std::to_string(-0.04 + 1e-3 * i) + ",0\n";
  const Outcome felt = wale(
      {"feel", built, "--virtual-time", "--seconds", "0.8", "--hand", desk.folder.write("hand.csv", trace), "--json"});
  ASSERT_EQ(felt.status, 0) << felt.err;
  const auto json = felt.json();
  ASSERT_EQ(json["patches"].size(), 3u);
  for (const int patch : {1, 2}) {
    EXPECT_EQ(json["patches"][patch]["entries"], 1) << patch;
    EXPECT_NEAR(json["patches"][patch]["seconds"].get<double>(), 0.25, 0.07) << patch;
  }
  // A picture without one of the colours, and one that is no picture.
  EXPECT_TRUE(
      contains(wale({"check", map("    colour \"#c04020\" = denim\n    colour \"#00ff00\" = oak\n")}).out, "W0314"));
  const Outcome partly = wale({"check", map("    colour \"#c04020\" = denim\n    blank \"#fff\"\n")});
  EXPECT_TRUE(contains(partly.out, "41.7 % of `map.ppm` has none of these colours: it is mostly \"#2060c0\""))
      << partly.out;
  EXPECT_EQ(partly.status, 0);
  for (const auto& [bytes, code] : {std::pair<std::string, std::string>{"", "W0502"},
                                    {"P6\n60 40\n255\nxyz", "W0502"},
                                    {"P6\n90000 90000\n255\n", "W0503"}}) {
    desk.folder.write("map.ppm", bytes);
    const Outcome damaged = wale({"check", file});
    EXPECT_EQ(damaged.status, 1) << code;
    EXPECT_TRUE(contains(damaged.out, code) && contains(damaged.out, "map.wale:5:24")) << damaged.out;
  }
}

TEST(WorkspacesOnTheCommandLine, AnUnknownNameIsWrongUsage) {
  const Desk desk;
  for (const char* verb : {"describe", "feel"}) {
    const Outcome outcome = wale({verb, desk.file, "--workspace", "desc"});
    EXPECT_EQ(outcome.status, 2) << verb;
    EXPECT_TRUE(contains(outcome.err, "W0609") && contains(outcome.err, "did you mean `desk`?")) << outcome.err;
  }
}

}  // namespace
}  // namespace wale::command_line::workspaces_test
