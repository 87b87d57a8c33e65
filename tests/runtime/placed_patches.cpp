// Patches that come, go and move, against a search of all patches.
#include "runtime/stage/placed_patches.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>
#include <random>

#include "tests/runtime/figures.hpp"
#include "tests/runtime/placed.hpp"
#include "tests/runtime/programs.hpp"

namespace wale::placed_patches_test {
namespace {

/// The front-most of all, by definition. Returns its number.
std::optional<std::uint32_t> plain_search(const std::map<std::uint32_t, PlacedPatch>& all, glm::dvec2 point) {
  const PlacedPatch* found = nullptr;
  for (const auto& [number, each] : all) {
    const auto x = static_cast<float>(point.x - static_cast<double>(each.outline.position.x));
    const auto y = static_cast<float>(point.y - static_cast<double>(each.outline.position.y));
    if (std::abs(x) > each.outline.width / 2 || std::abs(y) > each.outline.height / 2) continue;
    const bool in_front = !found || each.outline.layer > found->outline.layer ||
                          (each.outline.layer == found->outline.layer && each.outline.order > found->outline.order);
    if (in_front) found = &each;
  }
  return found ? std::optional(found->number) : std::nullopt;
}

/// Changes an arrangement at random, and a table of what it must hold.
class Random {
 public:
  explicit Random(unsigned seed) : random_(seed), model_(patch_of(spring(50))) {}

  void add() {
    const std::uint32_t number = random_() % 400;
    if (all_.count(number) == 0) put(number, anything());
  }
  void change() {
    if (all_.empty()) return;
    auto each = all_.begin();
    std::advance(each, random_() % all_.size());
    PatchOutline outline = each->second.outline;
    switch (random_() % 4) {
      case 0: outline.position = anything().position; break;
      case 1: outline.width = anything().width; break;
      case 2: outline.layer = anything().layer; break;
      default: outline.order = ++order_;
    }
    put(each->first, outline);
  }
  void remove() {
    const std::uint32_t number = random_() % 400;
    arrangement.remove(number);
    all_.erase(number);
  }
  void check(std::uint32_t revision) {
    const PlacedPatches handed = arrangement.hand_over(revision);
    std::uniform_real_distribution<double> place(-0.06, 0.06);
    for (int i = 0; i < 200; ++i) {
      const glm::dvec2 point(place(random_), place(random_));
      const PlacedPatch* const found = handed.at(point);
      const auto expected = plain_search(all_, point);
      ASSERT_EQ(found != nullptr, expected.has_value()) << revision;
      if (found) {
        ASSERT_EQ(found->number, *expected) << revision;
        ASSERT_EQ(found->outline, all_.at(*expected).outline);
      }
    }
  }
  unsigned dice() { return static_cast<unsigned>(random_()); }
  std::size_t size() const { return all_.size(); }

  Arrangement arrangement;

 private:
  PatchOutline anything() {
    std::uniform_real_distribution<float> place(-0.05f, 0.05f), size(0.001f, 0.03f);
    const float side = random_() % 5 == 0 ? 0.02f : size(random_);  // some are equal
    return {{place(random_), place(random_)}, side, side, static_cast<float>(random_() % 3), ++order_};
  }
  void put(std::uint32_t number, const PatchOutline& outline) {
    PlacedPatch patch = model_;
    patch.number = number;
    patch.outline = outline;
    all_.insert_or_assign(number, patch);
    arrangement.put(std::move(patch));
  }

  std::mt19937 random_;
  PlacedPatch model_;
  std::map<std::uint32_t, PlacedPatch> all_;
  std::uint64_t order_ = 0;
};

TEST(Arrangement, FindsWhatASearchOfAllPatchesFinds) {
  Random random(1995);
  for (int i = 0; i < 300; ++i) random.add();
  random.arrangement.make_base();
  std::optional<Arrangement::Outlines> under_way;  // a base that another thread makes meanwhile
  for (std::uint32_t turn = 1; turn <= 600; ++turn) {
    for (unsigned deeds = random.dice() % 5; deeds > 0; --deeds) {
      switch (random.dice() % 4) {
        case 0: random.add(); break;
        case 1: random.remove(); break;
        default: random.change();
      }
    }
    if (turn % 40 == 0) under_way = random.arrangement.outlines();
    if (turn % 40 == 7 && under_way)
      random.arrangement.take_base(std::make_shared<FrontMost>(under_way->outlines, under_way->numbers), *under_way);
    if (turn % 150 == 0) random.arrangement.expect(1000);
    ASSERT_NO_FATAL_FAILURE(random.check(turn));
  }
  EXPECT_GT(random.size(), 50u);
}

TEST(Arrangement, AHandOverKeepsItsPatchesWhenLaterOnesChange) {
  Arrangement arrangement;
  arrangement.put(patch_of(spring(50), 3));
  const PlacedPatches before = arrangement.hand_over(1);
  arrangement.put(patch_of(spring(50), 3, {0.5f, 0}));
  arrangement.put(patch_of(spring(50), 4));
  const PlacedPatches after = arrangement.hand_over(2);
  arrangement.remove(4);
  ASSERT_NE(before.at({0, 0}), nullptr);
  EXPECT_EQ(before.at({0, 0})->number, 3u);
  EXPECT_EQ(after.at({0, 0})->number, 4u);
  EXPECT_EQ(arrangement.hand_over(3).at({0, 0}), nullptr);
  EXPECT_EQ(before.patch(4), nullptr);
  EXPECT_EQ(after.patch(4)->number, 4u);
  EXPECT_EQ(after.patch(4000), nullptr);
}

/// Patches that move all the time do not make a new base worth its cost.
TEST(Arrangement, WantsABaseForPatchesThatCameAndNotForThoseThatMove) {
  Arrangement arrangement;
  const PlacedPatch model = patch_of(spring(50));
  const auto put = [&](std::uint32_t number, float x) {
    PlacedPatch patch = model;
    patch.number = number;
    patch.outline = {{x, 0}, 0.001f, 0.001f, 0, number};
    arrangement.put(patch);
  };
  for (std::uint32_t number = 0; number < 1000; ++number) put(number, 0.001f * static_cast<float>(number));
  EXPECT_TRUE(arrangement.wants_base());
  arrangement.make_base();
  EXPECT_FALSE(arrangement.wants_base());
  EXPECT_EQ(arrangement.overlay(), 0u);
  for (int turn = 1; turn <= 5; ++turn) {
    for (std::uint32_t number = 0; number < 600; ++number)
      put(number, 0.001f * static_cast<float>(number) + 0.01f * static_cast<float>(turn));
    EXPECT_FALSE(arrangement.wants_base()) << turn;
  }
  for (std::uint32_t number = 1000; number < 1400; ++number) put(number, 1);
  EXPECT_TRUE(arrangement.wants_base());
}

}  // namespace
}  // namespace wale::placed_patches_test
