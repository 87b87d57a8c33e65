// The options of `wale preview`.

#include <gtest/gtest.h>

#include "tests/command_line/running.hpp"

namespace wale::command_line::previewing_test {
namespace {

TEST(Preview, ShowsTheSectionThatIsAskedFor) {
  const TemporaryFolder folder;
  const auto picture = [&](std::vector<std::string> options) {
    const std::string out = folder / "ribs.png";
    std::vector<std::string> words = {"preview", "corduroy", "-o", out};
    words.insert(words.end(), options.begin(), options.end());
    const Outcome run = wale(words);
    EXPECT_EQ(run.status, 0) << run.err;
    return bytes_of(out);
  };
  const std::string plain = picture({});
  EXPECT_EQ(picture({"--along", "x"}), plain) << "the ribs change along x";
  EXPECT_EQ(picture({"--along", "0"}).empty(), false);
  EXPECT_NE(picture({"--along", "y"}), plain);
  EXPECT_NE(picture({"--along", "30"}), plain);
  EXPECT_EQ(picture({"--along", "30 deg"}), picture({"--along", "30"}));
  EXPECT_NE(picture({"--at", "1 mm, 0 mm"}), plain);
  EXPECT_NE(picture({"--seconds", "3 s"}), plain) << "of the spectrum";
}

TEST(Preview, RefusesASectionThatMakesNoSense) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& option, const std::string& value) {
    return wale({"preview", "corduroy", "-o", folder / "ribs.png", option, value});
  };
  const Outcome upwards = refused("--along", "up");
  EXPECT_EQ(upwards.status, 2);
  EXPECT_TRUE(contains(upwards.err, "--along: expected x, y, or an angle in degrees, found \"up\"")) << upwards.err;
  EXPECT_EQ(refused("--along", "4000").status, 2);
  EXPECT_EQ(refused("--at", "10").status, 2);
  const Outcome outside = refused("--at", "200 mm, 0 mm");
  EXPECT_EQ(outside.status, 2);
  EXPECT_TRUE(contains(outside.err, "outside the patch, 160 mm by 160 mm")) << outside.err;
  EXPECT_EQ(refused("--seconds", "-1").status, 2);
}

}  // namespace
}  // namespace wale::command_line::previewing_test
