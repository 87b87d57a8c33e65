// `wale import` and `wale export`: the files of the thesis's Sandpaper, both ways. The golden files are those of
// tests/library/thesis_files, written by hand from the thesis's words.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/command_line/running.hpp"

namespace wale::command_line::thesis_files_test {
namespace {

const std::string golden = std::string(WALE_SOURCE_DIR) + "/tests/library/thesis_files/";

bool is_empty(const TemporaryFolder& folder) { return fs::is_empty(folder.path()); }

std::string array(unsigned width, unsigned height, const std::string& cells) {
  return {std::string{static_cast<char>(width >> 8), static_cast<char>(width), static_cast<char>(height >> 8),
                      static_cast<char>(height)} +
          cells};
}

TEST(ThesisFilesOnTheCommandLine, AnArrayGoesBothWays) {
  const TemporaryFolder folder;
  const std::string file = folder / "ramp.wale";
  const Outcome made = wale({"import", golden + "ramp.depth", "--size", "6 mm", "--amplitude", "500 mN", "-o", file});
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_TRUE(made.out.ends_with("ramp.depth  ramp\n")) << made.out;
  EXPECT_TRUE(contains(bytes_of(file), "patch 6 mm, 5 mm")) << bytes_of(file);  // 6 by 5 cells
  EXPECT_EQ(wale({"check", file}).status, 0);
  EXPECT_EQ(bytes_of(folder / "ramp.pgm").substr(0, 11), "P5\n6 5\n255\n");
  const std::string back = folder / "back.depth";
  const Outcome written = wale({"export", file, "--columns", "6", "--heights", "0 mm, 1 mm", "-o", back});
  EXPECT_EQ(written.status, 0) << written.err;
  EXPECT_EQ(bytes_of(back), bytes_of(golden + "ramp.depth"));
}

TEST(ThesisFilesOnTheCommandLine, ASurfaceComesWithHowItLooks) {
  const TemporaryFolder folder;
  const std::string depth = folder.write("rock.depth", bytes_of(golden + "ramp.depth"));
  std::string cells;
  for (int i = 0; i < 30; ++i) cells += static_cast<char>(8 * i);
  const std::string shade = folder.write("rock.shade", array(6, 5, cells));
  const std::string file = folder / "rock.wale";
  const Outcome made = wale({"import", shade, depth, "--name", "slate_1", "--size", "6 mm", "--amplitude", "1 N", "-o", file});
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_TRUE(contains(bytes_of(file), "material slate_1")) << bytes_of(file);
  EXPECT_TRUE(fs::exists(folder / "slate_1_shade.pgm"));
  const Outcome back = wale({"export", file, "--columns", "6", "-o", folder / "back.shade"});
  EXPECT_EQ(back.status, 0) << back.err;
  EXPECT_EQ(bytes_of(folder / "back.shade"), bytes_of(shade));
  // Another size, or no surface: refused, and nothing is left.
  const TemporaryFolder empty;
  folder.write("rock.shade", array(5, 6, cells));
  const Outcome other = wale({"import", shade, depth, "--size", "6 mm", "--amplitude", "1 N", "-o", empty / "rock.wale"});
  EXPECT_EQ(other.status, 1);
  EXPECT_TRUE(contains(other.err, "expected a shading of 6 by 5 cells as its surface, found 5 by 6")) << other.err;
  const Outcome alone = wale({"import", shade, "--size", "6 mm", "--amplitude", "1 N", "-o", empty / "rock.wale"});
  EXPECT_EQ(alone.status, 1);
  EXPECT_TRUE(contains(alone.err, "--as array")) << alone.err;
  EXPECT_TRUE(is_empty(empty));
}

TEST(ThesisFilesOnTheCommandLine, AWaveGoesBothWays) {
  const TemporaryFolder folder;
  std::string cells;
  for (int i = 0; i < 64; ++i) cells += static_cast<char>(std::lround(127.5 + 127.5 * std::sin(2 * M_PI * i / 64)));
  const std::string wave = folder.write("seed", array(64, 1, cells)), file = folder / "seed.wale";
  const Outcome made = wale({"import", wave, "--as", "wave", "--size", "2.5 mm", "--amplitude", "1 N", "-o", file});
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_TRUE(contains(bytes_of(file), "2.5 mm")) << bytes_of(file);
  const Outcome back = wale({"export", file, "--wave", "--size", "2.5 mm", "--columns", "64", "-o", folder / "back"});
  ASSERT_EQ(back.status, 0) << back.err;
  const std::string bytes = bytes_of(folder / "back");
  ASSERT_EQ(bytes.size(), 68u);
  EXPECT_EQ(bytes.substr(0, 4), std::string("\0\x40\0\1", 4));
  // The same wave, from wherever in its period the patch's middle lies, within a step of the byte.
  int best = 255;
  for (int shift = 0; shift < 64; ++shift) {
    int worst = 0;
    for (int i = 0; i < 64; ++i)
      worst = std::max(worst, std::abs(static_cast<unsigned char>(bytes[4 + i]) - static_cast<unsigned char>(cells[(i + shift) % 64])));
    best = std::min(best, worst);
  }
  EXPECT_LE(best, 2);
}

TEST(ThesisFilesOnTheCommandLine, TheEndingTellsAWaveAndWhatIsLeftOutIsSaid) {
  const TemporaryFolder folder;
  std::string cells;
  for (int i = 0; i < 64; ++i) cells += static_cast<char>(std::lround(127.5 + 127.5 * std::sin(2 * M_PI * i / 64)));
  const std::string wave = folder.write("SEED.WAVE", array(64, 1, cells)), file = folder / "seed.wale";
  const Outcome made = wale({"import", wave, "--size", "2.5 mm", "--amplitude", "1 N", "-o", file});
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_TRUE(contains(bytes_of(file), "material SEED {")) << bytes_of(file);
  EXPECT_TRUE(contains(bytes_of(file), "param period")) << bytes_of(file);
  EXPECT_EQ(made.err, "");
  const std::string flat = folder.write("flat.depth", array(8, 8, std::string(64, 'a')));
  const Outcome level = wale({"import", flat, "--size", "40 mm", "--amplitude", "2 N", "-o", folder / "flat.wale"});
  EXPECT_EQ(level.status, 0) << level.err;
  EXPECT_TRUE(contains(level.err, "the amplitude of 2 N is left out")) << level.err;
  // 2.5 mm is the wave; 2 mm cuts it off, and more than the patch is nowhere felt.
  const Outcome whole = wale({"export", file, "--wave", "--size", "2.5 mm", "-o", folder / "whole.wave"});
  EXPECT_EQ(whole.err, "");
  const Outcome cut = wale({"export", file, "--wave", "--size", "2 mm", "-o", folder / "cut.wave"});
  EXPECT_EQ(cut.status, 0) << cut.err;
  EXPECT_TRUE(contains(cut.err, "seam")) << cut.err;
  const Outcome far = wale({"export", file, "--size", "500 mm", "-o", folder / "far.depth"});
  EXPECT_EQ(far.status, 2) << far.err;
  EXPECT_TRUE(contains(far.err, "expected at most the patch's width of 160 mm, found 500 mm")) << far.err;
}

TEST(ThesisFilesOnTheCommandLine, HeightsAreOfTheReliefsKind) {
  const TemporaryFolder folder;
  const std::string plain = folder.write("plain.wale", "wale 1\n\nmaterial plain {\n  physical {\n    height h = 0.5 + 0.4 * sin(x / 5 mm)\n    force = lateral(h, amplitude: 1 N)\n    show relief(h)\n  }\n}\n");
  const Outcome taken = wale({"export", plain, "--heights", "0, 1", "-o", folder / "a.depth"});
  EXPECT_EQ(taken.status, 0) << taken.err;
  const Outcome other = wale({"export", plain, "--heights", "0 mm, 1 mm", "-o", folder / "b.depth"});
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(contains(other.err, "--heights \"0, 1\"")) << other.err;
}

TEST(ThesisFilesOnTheCommandLine, MoviesAndShufflesGoBothWays) {
  const TemporaryFolder folder;
  const Outcome shown = wale({"import", golden + "demo.movie"});
  EXPECT_EQ(shown.status, 0) << shown.err;
  EXPECT_TRUE(contains(shown.out, "movie demo { frames warm_up, grids, warm_up }\n")) << shown.out;
  // A frame that is a workspace of the file is that one, and text that is there stays as it was written.
  const std::string before = "wale 1\n\nworkspace  grids{ patch a = oak }   // mine\nworkspace oil {}\nworkspace plain_cloth {}\n"
                             "movie demo { frames grids, oil, plain_cloth }\n";
  const std::string file = folder.write("mine.wale", before);
  const Outcome added = wale({"import", golden + "demo.shuffle", "--into", file});
  ASSERT_EQ(added.status, 0) << added.err;
  const std::string after = bytes_of(file);
  EXPECT_TRUE(after.starts_with(before)) << after;
  EXPECT_TRUE(contains(after, "movie demo_shuffle { frames plain_cloth, grids, oil }\n")) << after;
  EXPECT_EQ(after.find("workspace", before.size()), std::string::npos) << after;
  EXPECT_EQ(wale({"check", file}).status, 0);
  const Outcome movie = wale({"export", file, "--movie", "demo", "-o", "-"});
  EXPECT_EQ(movie.out, "grids\noil\nplain_cloth\n") << movie.err;
  const Outcome shuffle = wale({"export", file, "--movie", "demo", "--shuffled", "demo_shuffle", "--date", "6/1/93", "--time", "14:03", "-o", "-"});
  EXPECT_EQ(shuffle.out, "Movie:demo\nDate: 6/1/93\nTime: 14:03\n\n3 plain_cloth\n1 grids\n2 oil\n") << shuffle.err;
}

TEST(ThesisFilesOnTheCommandLine, NothingThatIsThereIsLost) {
  const TemporaryFolder folder;
  const std::string mine = folder.write("ramp.pgm", "somebody's"), file = folder / "a.wale";
  ASSERT_EQ(wale({"import", golden + "ramp.depth", "--size", "6 mm", "--amplitude", "1 N", "-o", file}).status, 0);
  EXPECT_EQ(bytes_of(mine), "somebody's");
  EXPECT_TRUE(contains(bytes_of(file), "material ramp_2")) << bytes_of(file);
  const std::string broken = folder.write("broken.wale", "wale 1\nmaterial {\n");
  EXPECT_EQ(wale({"import", golden + "demo.movie", "--into", broken}).status, 1);
  EXPECT_EQ(bytes_of(broken), "wale 1\nmaterial {\n");
  const std::string copy = folder.write("copy.depth", bytes_of(golden + "ramp.depth"));
  EXPECT_EQ(wale({"import", copy, "--size", "6 mm", "--amplitude", "1 N", "-o", copy}).status, 1);
  EXPECT_EQ(bytes_of(copy), bytes_of(golden + "ramp.depth"));
}

TEST(ThesisFilesOnTheCommandLine, WhatAFileDoesNotSayIsAskedFor) {
  const TemporaryFolder folder;
  const std::string out = folder / "a.wale", depth = golden + "ramp.depth";
  const auto expect = [&](std::vector<std::string> words, int status, const std::string& part) {
    words.insert(words.begin(), "import");
    const Outcome outcome = wale(words);
    EXPECT_EQ(outcome.status, status) << testing::PrintToString(words) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, part)) << testing::PrintToString(words) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "= help: ")) << outcome.err;
  };
  expect({depth, "-o", out}, 2, "--size \"2.22 mm\"");  // 6 cells of 0.37 mm
  expect({depth, "--as", "wave", "-o", out}, 2, "the length of one wave");
  expect({depth, "--size", "6 mm", "-o", out}, 2, "--amplitude \"1 N\"");
  expect({depth, "--size", "6 N", "--amplitude", "1 N", "-o", out}, 2, "--size");
  expect({depth, "--size", "0 mm", "--amplitude", "1 N", "-o", out}, 2, "a length above 0 mm");
  expect({depth, "--size", "6 mm", "--amplitude", "1 N"}, 2, "-o ramp.wale");
  expect({golden + "demo.movie", "--size", "6 mm", "-o", out}, 2, "no array and no wave");
  expect({depth, "--name", "3 x", "--size", "6 mm", "--amplitude", "1 N", "-o", out}, 2, "n3_x");
  EXPECT_TRUE(is_empty(folder));
  EXPECT_EQ(wale({"export", corduroy, "--wave", "-o", out}).status, 2);
  EXPECT_EQ(wale({"export", corduroy}).status, 2);
  EXPECT_EQ(wale({"export", corduroy, "--movie", "x", "-o", out}).status, 2);
  EXPECT_EQ(wale({"export", corduroy, "--heights", "1 mm, 0 mm", "-o", out}).status, 2);
  EXPECT_EQ(wale({"export", corduroy, "--heights", "5, 6", "-o", out}).status, 1);
  EXPECT_EQ(wale({"export", corduroy, "--heights", "5 mm, 6 mm", "-o", out}).status, 2);  // its relief has no unit
  EXPECT_EQ(wale({"export", corduroy, "-o", folder / "a.shade"}).status, 1);  // it shows no colour
  EXPECT_TRUE(is_empty(folder));
}

TEST(ThesisFilesOnTheCommandLine, MalformedFilesAreRefusedWithTheirPlace) {
  const TemporaryFolder folder, outputs;
  const std::string ramp = bytes_of(golden + "ramp.depth");
  struct Case {
    std::string name, bytes, says;
  };
  const Case cases[] = {
      {"short.depth", ramp.substr(0, 33), "short.depth:33: expected 34 bytes for 6 by 5 cells, found 33"},
      {"long.depth", ramp + "x", "long.depth:34: expected 34 bytes for 6 by 5 cells, found 35"},
      {"empty.depth", "", "empty.depth:0: expected the width and the height"},
      {"flat.depth", std::string("\0\0\0\5", 4), "flat.depth:0: expected an array that is 1 cell wide or more, found 0"},
      {"small.depth", array(2, 2, "abcd"), "expected 4 by 4 to 2^24 cells for a relief, found 2 by 2"},
      {"a.shuffle", "Movie: m\nDate: d\nTime: t\n\n1 a\n3 b\n", "a.shuffle:6: expected a number from 1 to 2"},
      {"b.shuffle", "Movie: m\nTime: t\n", "b.shuffle:2: expected `Date:`"},
      {"empty.movie", "", "empty.movie:1: expected the names of workspaces, found none"},
      {"roman.movie", "a\nb\ncaf\x8e\n", "roman.movie:3: expected text in UTF-8"},
      {"binary", std::string("\x01\x20\x03\x00\x01\xff", 6), "binary: expected an array, a wave, a movie or a shuffle"},
  };
  for (const Case& each : cases) {
    const Outcome outcome = wale({"import", folder.write(each.name, each.bytes), "--size", "6 mm", "--amplitude", "1 N", "-o", outputs / "a.wale"});
    const bool of_size = contains(outcome.err, "there is no array");  // movies and shuffles have none
    const Outcome plain = of_size ? wale({"import", folder / each.name, "-o", outputs / "a.wale"}) : outcome;
    EXPECT_EQ(plain.status, 1) << each.name << plain.err;
    EXPECT_TRUE(contains(plain.err, each.says)) << each.name << plain.err;
    EXPECT_TRUE(contains(plain.err, "= help: ")) << each.name << plain.err;
    EXPECT_TRUE(is_empty(outputs)) << each.name;
  }
  EXPECT_EQ(wale({"import", folder / "missing"}).status, 1);
  EXPECT_EQ(wale({"import", folder.path().string()}).status, 1);
  // The second of two files is wrong: what the first one brought is gone again.
  folder.write("good.depth", ramp);
  EXPECT_EQ(wale({"import", folder / "good.depth", folder / "short.depth", "--size", "6 mm", "--amplitude", "1 N", "-o", outputs / "a.wale"}).status, 1);
  EXPECT_TRUE(is_empty(outputs));
}

}  // namespace
}  // namespace wale::command_line::thesis_files_test
