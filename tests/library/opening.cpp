// The hand that a library puts at a simulated device.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "wale/library.hpp"

namespace wale::opening_test {
namespace {

/// How far the handle goes from the middle in 2 s under no force, m.
double farthest(const OpenOptions& options) {
  const auto opened = Library().open_device("simulated", options);
  if (!opened) {
    ADD_FAILURE() << in_words(opened.error());
    return -1;
  }
  int counts = 0;
  for (int i = 0; i < 1800; ++i) {
    (*opened)->elapse(1);
    counts = std::max(counts, std::abs((*opened)->sample().counts.x));
    (*opened)->command({0, 0});
  }
  return counts * (*opened)->profile().position_step();
}

TEST(OpeningByLibrary, APersonRubsUnlessTheMotionIsGiven) {
  EXPECT_GT(farthest({}), 0.02) << "to and fro";
  EXPECT_EQ(farthest({.motion = Rest{}}), 0) << "rest is a motion, also in the middle";
  EXPECT_NEAR(farthest({.motion = Rest{{0.01, 0}}}), 0.01, 0.002);
  EXPECT_EQ(farthest({.hand = {.mass = 0.5, .damping = 10, .stiffness = 500}}), 0) << "a hand of one's own rests";
}

}  // namespace
}  // namespace wale::opening_test
