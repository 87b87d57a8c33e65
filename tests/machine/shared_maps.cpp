// Programs with the same map share one copy of it.

#include "runtime/machine/shared_maps.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "runtime/machine/decoded_program.hpp"
#include "tests/machine/random_program.hpp"
#include "tests/machine/running.hpp"

namespace wale::shared_maps_test {
namespace {

HeightTable table(std::uint16_t first) { return {3, 2, {first, 65535, 100, 7, 8, 9}}; }

TEST(SharedMaps, EqualHeightsAreOneMap) {
  const auto one = shared_map(table(1)), same = shared_map(table(1)), other = shared_map(table(2));
  EXPECT_EQ(one, same);
  EXPECT_NE(one, other);
  EXPECT_EQ(one->table, table(1));
  EXPECT_EQ(one->spline.coefficients, Spline(table(1)).coefficients);
  EXPECT_NE(shared_map({2, 3, {1, 65535, 100, 7, 8, 9}}), one) << "the same heights in another shape";
}

TEST(SharedMaps, AMapLivesAsLongAsSomebodyHoldsIt) {
  std::weak_ptr<const SharedMap> watched;
  {
    const auto held = shared_map(table(3));
    watched = held;
    EXPECT_EQ(held.use_count(), 1);
  }
  EXPECT_TRUE(watched.expired());
  EXPECT_EQ(shared_map(table(3))->table, table(3));
}

TEST(SharedMaps, TenThousandProgramsHoldOneMap) {
  const PatchProgram description = example::RandomProgram(4).make();
  const auto bytes = write_patch_program(description);
  std::vector<Program> programs;
  for (int i = 0; i < 10'000; ++i) {
    auto loaded = Program::load(bytes);
    ASSERT_TRUE(loaded);
    programs.push_back(*std::move(loaded));
  }
  for (std::size_t number = 0; number < description.tables.size(); ++number) {
    const auto& first = programs.front().decoded().maps[number];
    EXPECT_EQ(first.use_count(), 10'000);
    for (const Program& program : programs) {
      const DecodedProgram& decoded = program.decoded();
      ASSERT_EQ(decoded.maps[number], first);
      ASSERT_EQ(&decoded.splines[number].get(), &first->spline);
      ASSERT_TRUE(decoded.description.tables[number].heights.shares(first->table.heights)) << "the heights, too";
    }
    EXPECT_EQ(programs.back().description().tables[number], description.tables[number]);
  }
}

TEST(SharedMaps, ThreadsAgree) {
  std::vector<std::shared_ptr<const SharedMap>> found(8 * 50);
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&found, t] {
      for (int i = 0; i < 50; ++i) found[t * 50 + i] = shared_map(table(static_cast<std::uint16_t>(1000 + i)));
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (int t = 1; t < 8; ++t) {
    for (int i = 0; i < 50; ++i) EXPECT_EQ(found[t * 50 + i], found[i]);
  }
}

TEST(SharedHeights, AChangeAffectsOneCopy) {
  const HeightTable before = table(5);
  HeightTable changed = before;
  EXPECT_TRUE(changed.heights.shares(before.heights));
  changed.heights.push_back(1);
  EXPECT_FALSE(changed.heights.shares(before.heights));
  EXPECT_EQ(before, table(5));
  EXPECT_EQ(changed.heights.size(), 7u);
  const SharedHeights::Codes plain{5, 65535, 100, 7, 8, 9};
  EXPECT_EQ(before.heights, plain);
  EXPECT_TRUE(SharedHeights().empty());
}

}  // namespace
}  // namespace wale::shared_maps_test
