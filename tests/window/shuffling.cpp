// Shuffled places: random, with the least overlap, against slow references.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "document/shuffling.hpp"

namespace sandpaper {
namespace {

Contents squares(const std::vector<glm::dvec2>& sizes) {
  Contents contents;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    Placed placed{.id = i + 1};
    placed.patch.name = "p" + std::to_string(i);
    placed.patch.made_of = "oak";
    placed.patch.size = sizes[i];
    contents.placed.push_back(std::make_shared<const Placed>(std::move(placed)));
  }
  return contents;
}

glm::dvec2 given_size(const Placed& placed) { return *placed.patch.size; }

/// The overlap counted in squares of half a millimetre: of each the pairs that lie on it.
double counted_overlap(const Contents& contents) {
  constexpr double step = 0.0005;
  double sum = 0;
  for (double x = -0.15; x < 0.15; x += step)
    for (double y = -0.15; y < 0.15; y += step) {
      int on = 0;
      for (const PlacedRef& each : contents.placed) {
        const glm::dvec2 from = glm::dvec2(x + step / 2, y + step / 2) - each->patch.at, half = 0.5 * *each->patch.size;
        on += std::abs(from.x) < half.x && std::abs(from.y) < half.y;
      }
      sum += on * (on - 1) / 2 * step * step;
    }
  return sum;
}

/// The least overlap of three boxes over all places on a grid, within the disc.
double least_of_three(const std::vector<glm::dvec2>& sizes, double radius, double step) {
  std::vector<std::vector<glm::dvec2>> places(3);
  for (int i = 0; i < 3; ++i)
    for (double x = -radius; x <= radius; x += step)
      for (double y = -radius; y <= radius; y += step)
        if (std::hypot(std::abs(x) + sizes[i].x / 2, std::abs(y) + sizes[i].y / 2) <= radius)
          places[i].push_back({x, y});
  const auto shared = [&](int a, glm::dvec2 at, int b, glm::dvec2 bt) {
    const glm::dvec2 high{std::min(at.x + sizes[a].x / 2, bt.x + sizes[b].x / 2),
                          std::min(at.y + sizes[a].y / 2, bt.y + sizes[b].y / 2)};
    const glm::dvec2 low{std::max(at.x - sizes[a].x / 2, bt.x - sizes[b].x / 2),
                         std::max(at.y - sizes[a].y / 2, bt.y - sizes[b].y / 2)};
    return std::max(0.0, high.x - low.x) * std::max(0.0, high.y - low.y);
  };
  double least = 1;
  for (const glm::dvec2 a : places[0])
    for (const glm::dvec2 b : places[1])
      for (const glm::dvec2 c : places[2])
        least = std::min(least, shared(0, a, 1, b) + shared(0, a, 2, c) + shared(1, b, 2, c));
  return least;
}

TEST(Shuffle, OverlapsNoMoreThanTheBestOfAllPlaces) {
  constexpr double radius = 0.1;
  const std::vector<std::vector<glm::dvec2>> cases = {
      {{0.05, 0.05}, {0.06, 0.04}, {0.03, 0.09}},  // there is room
      {{0.1, 0.1}, {0.1, 0.1}, {0.1, 0.1}},        // there is not
      {{0.12, 0.06}, {0.06, 0.12}, {0.1, 0.05}}};
  for (const auto& sizes : cases)
    for (const std::uint32_t seed : {1u, 2u, 3u}) {
      const Shuffled shuffled = shuffle(squares(sizes), {}, seed, 2 * radius, given_size);
      EXPECT_EQ(shuffled.moved, 3);
      const double least = least_of_three(sizes, radius, 0.01), counted = counted_overlap(shuffled.contents);
      EXPECT_LE(counted, 1.02 * least + 1e-5) << seed;
      EXPECT_NEAR(*shuffled.overlap, counted, 1e-4);
      for (const PlacedRef& each : shuffled.contents.placed)
        EXPECT_LE(std::hypot(std::abs(each->patch.at.x) + each->patch.size->x / 2,
                             std::abs(each->patch.at.y) + each->patch.size->y / 2),
                  radius + 1e-9);
    }
}

TEST(Shuffle, TwelvePatchesLieSideBySide) {
  const Contents twelve = squares(std::vector<glm::dvec2>(12, {0.03, 0.03}));
  std::set<std::vector<std::string>> orders;
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const Shuffled shuffled = shuffle(twelve, {}, seed, 0.2, given_size);
    EXPECT_EQ(counted_overlap(shuffled.contents), 0) << seed;
    std::vector<std::string> order;
    for (const PlacedRef& each : shuffled.contents.placed) order.push_back(each->patch.name);
    orders.insert(order);
    const Shuffled again = shuffle(twelve, {}, seed, 0.2, given_size);
    for (std::size_t i = 0; i < 12; ++i)
      EXPECT_EQ(shuffled.contents.placed[i]->patch.at, again.contents.placed[i]->patch.at);
  }
  EXPECT_EQ(orders.size(), 5u);  // from back to front
}

TEST(Shuffle, AShapeBesideItsPlaceLiesWhereItIsSeen) {
  // As kitchen.wale's puddle: its corners are far from its patch's centre.
  const std::vector<glm::vec2> corners = {{0.04f, -0.02f}, {0.08f, -0.01f}, {0.085f, -0.045f}, {0.05f, -0.06f}};
  Contents contents = squares(std::vector<glm::dvec2>(4, {0.05, 0.05}));
  Placed puddle = *contents.placed[1];
  puddle.patch.shape = "polygon";
  puddle.patch.outline = *wale::Shape::polygon(corners);
  puddle.patch.size = glm::dvec2(puddle.patch.outline.size());
  contents.placed[1] = std::make_shared<const Placed>(puddle);
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    const Shuffled shuffled = shuffle(contents, {}, seed, 0.2, given_size);
    EXPECT_EQ(shuffled.overlap, 0) << seed;
    const auto found =
        std::ranges::find(shuffled.contents.placed, "p1", [](const PlacedRef& each) { return each->patch.name; });
    for (const glm::vec2 corner : corners) {
      const glm::dvec2 at = (*found)->patch.at + glm::dvec2(corner);
      EXPECT_LE(std::hypot(at.x, at.y), 0.1) << seed;
      for (const PlacedRef& each : shuffled.contents.placed)
        if (each->patch.name != "p1") {
          const glm::dvec2 from = at - each->patch.at;
          EXPECT_FALSE(std::abs(from.x) < 0.025 && std::abs(from.y) < 0.025) << seed;
        }
    }
  }
}

TEST(Shuffle, LockedPatchesStayAndOthersKeepOffThem) {
  Contents contents = squares(std::vector<glm::dvec2>(6, {0.04, 0.04}));
  Placed locked = *contents.placed[2];
  locked.locked = true;
  locked.patch.at = {0.03, 0.02};
  contents.placed[2] = std::make_shared<const Placed>(locked);
  const Shuffled shuffled = shuffle(contents, {}, 9, 0.2, given_size);
  EXPECT_EQ(shuffled.moved, 5);
  EXPECT_EQ(shuffled.contents.placed[2]->patch.at, locked.patch.at);
  EXPECT_EQ(counted_overlap(shuffled.contents), 0);
  const Shuffled two = shuffle(contents, {1, 4}, 9, 0.2, given_size);  // only these
  EXPECT_EQ(two.moved, 2);
  for (const std::size_t each : {1u, 2u, 4u, 5u})
    EXPECT_EQ(two.contents.placed[each]->patch.at, contents.placed[each]->patch.at);
  EXPECT_EQ(shuffle(squares({{0.1, 0.1}}), {}, 1, 0.2, given_size).moved, 0);
}

TEST(Shuffle, TwentyThousandPatchesComeToAnEnd) {
  const Shuffled shuffled = shuffle(squares(std::vector<glm::dvec2>(20000, {0.005, 0.005})), {}, 1, 0.2, given_size);
  EXPECT_EQ(shuffled.moved, 20000);
  EXPECT_FALSE(shuffled.overlap);
}

}  // namespace
}  // namespace sandpaper
