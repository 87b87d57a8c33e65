// A program of a size that only a slow device allows is read in bounded work, and says that it was read more coarsely.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/command_line/running.hpp"

namespace wale::command_line::coarse_test {
namespace {

/// A material for a device of 100 Hz, with `count` chains of 64 sines in each tick.
std::string large(int count) {
  std::string text = R"(wale 1
device slow {
  class force_plane
  workspace disc(100 mm)
  position 1667 counts
  force 8 N, 4096 counts
  rate 100 Hz
  speed 1 m/s
  slew 200 N/s
  velocity_filter 15, 1 counts
  patch 80 mm, 80 mm, 4 mm
  mass 0.3 kg
  damping 1 N s/m
  friction 0.2 N
  delay 1 ms
  sustained unknown
  active 2 W
  source "made up"
}
function s4(t) = sin(sin(sin(sin(t))))
function s16(t) = s4(s4(s4(s4(t))))
function s64(t) = s16(s16(s16(s16(t))))
material large {
  physical {
    let a0 = x / 1 mm
)";
  for (int i = 0; i < count; ++i)
    text += "let a" + std::to_string(i + 1) + " = s64(a" + std::to_string(i) + " + y / 1 mm)\n";
  return text + "force = vector(1 N * a" + std::to_string(count) + ", 0 N)\n} }\n";
}

TEST(LargePrograms, SayThatTheyAreSampledCoarsely) {
  const TemporaryFolder folder;
  const std::string file = folder.write("large.wale", large(1500)), program = folder / "large.wpp";
  ASSERT_EQ(wale({"build", file, "--device", "slow", "-o", program}).status, 0);
  const Outcome described = wale({"describe", program, "--json"});
  ASSERT_EQ(described.status, 0) << described.err;
  // 2^19 units of cost are sampled everywhere.
  const auto json = described.json();
  const double cost = json.at("cost").get<double>();
  EXPECT_EQ(json.at("coarseness").get<int>(), static_cast<int>(std::ceil(cost / (1 << 19))));
  EXPECT_TRUE(contains(described.err, "one of 2 places was sampled")) << described.err;
  const Outcome drawn = wale({"preview", program, "-o", folder / "large.png"});
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_TRUE(contains(drawn.err, "drawn in squares of")) << drawn.err;
}

TEST(SmallPrograms, AreSampledEverywhere) {
  const TemporaryFolder folder;
  const Outcome described = wale({"describe", corduroy, "--json"});
  EXPECT_FALSE(described.json().contains("coarseness"));
  EXPECT_FALSE(contains(described.err, "sampled")) << described.err;
  const Outcome drawn = wale({"preview", corduroy, "-o", folder / "small.png"});
  EXPECT_FALSE(contains(drawn.err, "squares")) << drawn.err;
}

}  // namespace
}  // namespace wale::command_line::coarse_test
