// The front-most patch under a point, against a search of all patches.

#include "runtime/stage/front_most.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace wale::front_most_test {
namespace {

/// The patch that contains the point and has the highest layer; the last of several.
std::uint32_t scan(const std::vector<PatchOutline>& patches, glm::dvec2 point) {
  std::uint32_t found = FrontMost::none;
  for (std::uint32_t i = 0; i < patches.size(); ++i) {
    const PatchOutline& each = patches[i];
    const float x = static_cast<float>(point.x - static_cast<double>(each.position.x));
    const float y = static_cast<float>(point.y - static_cast<double>(each.position.y));
    if (!(std::abs(x) <= each.width / 2 && std::abs(y) <= each.height / 2)) continue;
    if (found == FrontMost::none || each.layer >= patches[found].layer) found = i;
  }
  return found;
}

void compare(const std::vector<PatchOutline>& patches, std::mt19937& random, int points) {
  const FrontMost front_most(patches);
  std::uniform_real_distribution<double> anywhere(-0.13, 0.13);
  int hits = 0;
  for (int i = 0; i < points; ++i) {
    glm::dvec2 point(anywhere(random), anywhere(random));
    if (i % 2 == 0 &&
        !patches.empty()) {  // on an edge, next to it by the smallest step of a float or double, or at a corner
      const PatchOutline& each = patches[random() % patches.size()];
      const double x =
          static_cast<double>(each.position.x) + (random() % 2 == 0 ? 0.5 : -0.5) * static_cast<double>(each.width);
      const double y =
          static_cast<double>(each.position.y) + (random() % 2 == 0 ? 0.5 : -0.5) * static_cast<double>(each.height);
      const double beside[] = {x, std::nextafter(x, 1.0), std::nextafter(x, -1.0), x + 3e-9, x - 3e-9};
      point.x = beside[random() % 5];
      if (random() % 3 == 0) point.y = y;
    }
    const std::uint32_t expected = scan(patches, point);
    ASSERT_EQ(front_most.at(point), expected) << patches.size() << " patches, at " << point.x << " " << point.y;
    hits += expected != FrontMost::none;
  }
  if (patches.size() > 100) {
    EXPECT_GT(hits, points / 100);
  }
}

std::vector<PatchOutline> random_patches(std::mt19937& random, std::size_t count, float largest, int layers) {
  std::uniform_real_distribution<float> place(-0.1f, 0.1f), size(0.0f, largest);
  std::vector<PatchOutline> patches(count);
  for (PatchOutline& each : patches) {
    each = {{place(random), place(random)}, size(random), size(random)};
    if (layers > 0) each.layer = static_cast<float>(random() % static_cast<unsigned>(layers));
  }
  return patches;
}

TEST(FrontMost, AgreesWithASearchOfAllPatches) {
  std::mt19937 random(1995);
  for (const std::size_t count : {1, 2, 3, 10, 57, 300, 2000}) {
    for (const float largest : {0.002f, 0.02f, 0.3f}) {
      for (const int layers : {0, 3, 1000}) compare(random_patches(random, count, largest, layers), random, 2000);
    }
  }
}

TEST(FrontMost, OfNoneIsNone) {
  EXPECT_EQ(FrontMost().at({0, 0}), FrontMost::none);
  EXPECT_EQ(FrontMost().at({std::nan(""), 1e300}), FrontMost::none);
}

TEST(FrontMost, OfOnePatchIncludesItsEdge) {
  const std::vector<PatchOutline> one = {{{0.25f, -0.5f}, 0.5f, 0.25f}};
  const FrontMost front_most(one);
  EXPECT_EQ(front_most.at({0.25, -0.5}), 0u);
  EXPECT_EQ(front_most.at({0.5, -0.625}), 0u) << "a corner";
  EXPECT_EQ(front_most.at({0.500001, -0.5}), FrontMost::none);
  EXPECT_EQ(front_most.at({-1e30, -0.5}), FrontMost::none);
  EXPECT_EQ(front_most.at({std::nan(""), -0.5}), FrontMost::none);
  EXPECT_EQ(front_most.at({0.25, std::numeric_limits<double>::infinity()}), FrontMost::none);
}

TEST(FrontMost, AmongEqualLayersTheLastOne) {
  std::vector<PatchOutline> patches(50, {{0, 0}, 0.1f, 0.1f});
  EXPECT_EQ(FrontMost(patches).at({0, 0}), 49u);
  patches[7].layer = 1;
  EXPECT_EQ(FrontMost(patches).at({0.05f, 0.05f}), 7u);
  patches[9].layer = -1;
  EXPECT_EQ(FrontMost(patches).at({0, 0}), 7u);
}

TEST(FrontMost, PatchesWithInvalidOutlinesAreNotFound) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const std::vector<PatchOutline> patches = {{{nan, 0}, 1, 1}, {{0, 0}, nan, 1},     {{0, 0}, -1, 1},
                                             {{0, inf}, 1, 1}, {{0, 0}, 0.1f, 0.1f}, {{0, 0}, inf, 1}};
  EXPECT_EQ(FrontMost(patches).at({0, 0}), 4u);
}

TEST(FrontMost, RowsAndPointsWithoutExtent) {
  std::mt19937 random(3);
  std::vector<PatchOutline> flat = random_patches(random, 400, 0.1f, 5);
  for (PatchOutline& each : flat) each.position.y = 0.01f, each.height = 0;
  compare(flat, random, 2000);
  for (PatchOutline& each : flat) each.width = 0;
  compare(flat, random, 2000);
}

// Nested frames: each covers every cell that the ones in front of it leave open.
TEST(FrontMost, MemoryStaysInProportion) {
  std::mt19937 random(4);
  std::vector<PatchOutline> frames;
  for (int i = 0; i < 20'000; ++i) {
    const float size = 0.2f - 1e-5f * static_cast<float>(i);
    frames.push_back({{0, 0}, size, 0.2f, static_cast<float>(i)});
  }
  const FrontMost front_most(frames);
  EXPECT_LE(front_most.entries(), 32 * frames.size() + 4096);
  compare(frames, random, 300);
}

TEST(FrontMost, CoveredPatchesAreNotListed) {
  std::mt19937 random(5);
  const std::vector<PatchOutline> same(20'000, {{0, 0}, 0.2f, 0.2f});
  const FrontMost one_for_all(same);
  EXPECT_EQ(one_for_all.entries(), std::size_t{one_for_all.side()} * one_for_all.side());
  compare(same, random, 300);
  std::vector<PatchOutline> behind = random_patches(random, 5000, 0.02f, 0);
  behind.push_back({{0, 0}, 0.5f, 0.5f, 1});
  const FrontMost hidden(behind);
  EXPECT_LT(hidden.entries(), std::size_t{hidden.side()} * hidden.side() + 100);
  compare(behind, random, 1000);
}

}  // namespace
}  // namespace wale::front_most_test
