// The proved ranges of look-ups in tables and grids, against the machine's look-ups and by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "compiler/prove/look_up.hpp"
#include "runtime/machine/floating_point_mode.hpp"
#include "runtime/machine/grid.hpp"
#include "tests/prove/values.hpp"

namespace wale::look_ups_test {
namespace {

using prove_test::Values;

// Not inlined, so that they are computed in the floating-point mode that the caller has set.
[[gnu::noinline]] SplineSample sampled(const Spline& spline, float a, float b) { return sample_of(spline, a, b); }
[[gnu::noinline]] GridSample recalled(const GridShape& shape, const float* cells, float a, float b) {
  return recall_of(shape, cells, a, b);
}

HeightTable table(std::uint32_t width, std::uint32_t height,
                  const std::function<double(std::uint32_t, std::uint32_t)>& share) {
  HeightTable table{width, height, {}};
  for (std::uint32_t j = 0; j < height; ++j) {
    for (std::uint32_t i = 0; i < width; ++i) {
      table.heights.push_back(static_cast<std::uint16_t>(std::lround(65535 * share(i, j))));
    }
  }
  return table;
}

void expect_held(const HeightTable& heights, int rounds) {
  const Spline spline(heights);
  const TableRanges ranges(spline);
  Values values(4);
  std::mt19937& random = values.random();
  const auto coordinate = [&](std::uint32_t samples) {
    if (random() % 4 == 0) return values.interval();
    const double last = samples - 1;
    const double low = std::uniform_real_distribution<double>(-0.5 * last, 2.5 * last)(random);
    const double wide = std::exp2(std::uniform_real_distribution<double>(-8, 2)(random));
    const bool inside = random() % 2 == 0;
    const auto held = [&](double at) { return static_cast<float>(inside ? std::clamp(at, 0.0, last) : at); };
    return Interval::between(held(low), held(low + wide));
  };
  for (int round = 0; round < rounds; ++round) {
    const Interval a = coordinate(heights.width), b = coordinate(heights.height);
    const ResultRanges range = ranges.at(a, b);
    for (int i = 0; i < 20; ++i) {
      const float x = values.of(a), y = values.of(b);
      const SplineSample sample = [&] {
        const FloatingPointMode mode;
        return sampled(spline, x, y);
      }();
      ASSERT_TRUE(range[0].contains(sample.value)) << x << " " << y << ": " << sample.value;
      ASSERT_TRUE(range[1].contains(sample.along_a)) << x << " " << y << ": " << sample.along_a;
      ASSERT_TRUE(range[2].contains(sample.along_b)) << x << " " << y << ": " << sample.along_b;
    }
  }
}

TEST(LookUps, TablesKeepToTheirRanges) {
  std::mt19937 random(1);
  expect_held(table(9, 6, [](auto i, auto) { return i / 8.0; }), 3000);
  expect_held(table(2, 17, [](auto, auto j) { return j * j / 256.0; }), 3000);
  expect_held(table(12, 7, [](auto i, auto) { return i < 6 ? 0.0 : 1.0; }), 3000);
  expect_held(table(30, 30, [](auto i, auto j) { return (i + j) % 2 == 0 ? 1.0 : 0.0; }), 3000);
  expect_held(table(70, 70, [&](auto, auto) { return random() % 65536 / 65535.0; }), 3000);
  expect_held(table(5, 5, [](auto, auto) { return 1.0; }), 3000);
}

// The ramp rises by 1/32 per sample. Beyond its edges its mirror image falls.
TEST(LookUps, ARampRisesWithinItsEdges) {
  const Spline spline(table(17, 5, [](auto i, auto) { return 0.25 + i / 32.0; }));
  const TableRanges ranges(spline);
  const Interval rows = Interval::between(1, 3);
  const ResultRanges within = ranges.at(Interval::between(6, 9), rows);
  EXPECT_NEAR(within[0].low, 0.25 + 5 / 32.0, 2e-3) << "one more sample on either side";
  EXPECT_NEAR(within[0].high, 0.25 + 11 / 32.0, 2e-3);
  EXPECT_NEAR(within[1].low, 1 / 32.0, 1e-3);
  EXPECT_NEAR(within[1].high, 1 / 32.0, 1e-3);
  EXPECT_NEAR(within[2].low, 0, 1e-4);
  EXPECT_NEAR(within[2].high, 0, 1e-4);
  for (const Interval& beyond : {Interval::between(15, 18), Interval::between(-1, 2), Interval{6, 9, true}}) {
    EXPECT_LT(ranges.at(beyond, rows)[1].low, -0.03);
    EXPECT_GT(ranges.at(beyond, rows)[1].high, 0.03);
  }
}

TEST(LookUps, GridsKeepToTheirRanges) {
  Values values(8);
  for (int round = 0; round < 3000; ++round) {
    Grid grid{"g",
              1 + static_cast<std::uint32_t>(values.random()() % 6),
              1 + static_cast<std::uint32_t>(values.random()() % 6),
              0,
              0,
              0};
    const Interval bounds = values.interval();
    if (!bounds.is_finite()) continue;
    grid.low = bounds.low;
    grid.high = bounds.high;
    std::vector<float> cells(std::size_t{grid.columns} * grid.rows);
    for (float& cell : cells) cell = values.of({grid.low, grid.high, false});
    const GridShape shape{0, grid.columns, grid.rows};
    const ResultRanges range = recall_ranges(grid);
    for (int i = 0; i < 20; ++i) {
      const float a = values.of(Interval::between(-1, 7)), b = values.of(Interval::everything(true));
      const GridSample sample = [&] {
        const FloatingPointMode mode;
        return recalled(shape, cells.data(), a, b);
      }();
      ASSERT_TRUE(range[0].contains(sample.value)) << sample.value << " " << grid.low << " " << grid.high;
      ASSERT_TRUE(range[1].contains(sample.along_a)) << sample.along_a << " " << grid.low << " " << grid.high;
      ASSERT_TRUE(range[2].contains(sample.along_b)) << sample.along_b << " " << grid.low << " " << grid.high;
      ASSERT_TRUE(cell_range(grid).contains(cells[cell_at(shape, a, b)]));
    }
  }
}

// Half of a cell near the smallest normal number is flushed to zero, so a recalled value may be below the lowest cell.
TEST(LookUps, BetweenTheSmallestCellsThereMayBeZero) {
  const float low = 1.5e-38f, high = 3e-38f;
  const std::vector<float> cells = {low, low};
  const GridSample sample = [&] {
    const FloatingPointMode mode;
    return recalled({0, 2, 1}, cells.data(), 0.5f, 0);
  }();
  EXPECT_EQ(sample.value, 0);
  EXPECT_TRUE(recall_ranges({"g", 2, 1, low, low, high})[0].contains(0));
}

}  // namespace
}  // namespace wale::look_ups_test
