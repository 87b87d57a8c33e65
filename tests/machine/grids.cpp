// `recall` and `cell` against the bilinear formula in double.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "runtime/machine/grid.hpp"

namespace wale::grids_test {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float inf = std::numeric_limits<float>::infinity();

/// A grid of 5 columns and 4 rows. The 3 cells before it belong to another grid and may not be read.
struct Field {
  Field() {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> anything(-1, 1);
    for (float& cell : cells) cell = anything(random);
    cells[0] = cells[1] = cells[2] = nan;
  }
  double at(int column, int row) const { return cells[static_cast<std::size_t>(3 + row * 5 + column)]; }
  /// Bilinear interpolation in double; places beyond an edge count as on the edge.
  double value(double a, double b) const {
    const double u = std::min(std::max(a, 0.0), 4.0), v = std::min(std::max(b, 0.0), 3.0);
    const int i = std::min(static_cast<int>(u), 3), j = std::min(static_cast<int>(v), 2);
    const double f = u - i, g = v - j;
    return (1 - g) * ((1 - f) * at(i, j) + f * at(i + 1, j)) + g * ((1 - f) * at(i, j + 1) + f * at(i + 1, j + 1));
  }
  GridSample recall(float a, float b) const { return recall_of(shape, cells.data(), a, b); }
  float cell(float a, float b) const { return cells[cell_at(shape, a, b)]; }

  GridShape shape{3, 5, 4};
  std::vector<float> cells = std::vector<float>(3 + 5 * 4);
};

TEST(Grids, RecallIsBilinear) {
  const Field field;
  for (float a = -2; a < 7; a += 0.037f) {
    for (float b = -2; b < 6; b += 0.041f)
      ASSERT_NEAR(field.recall(a, b).value, field.value(a, b), 3e-7) << a << " " << b;
  }
}

TEST(Grids, RecallIsExactAtCells) {
  const Field field;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 4; ++j) {
      EXPECT_EQ(field.recall(static_cast<float>(i), static_cast<float>(j)).value, static_cast<float>(field.at(i, j)));
    }
  }
}

TEST(Grids, DerivativesAreThoseOfTheValue) {
  const Field field;
  const double h = 1e-4;
  for (float a = -1.51f; a < 6; a += 0.173f) {
    for (float b = -1.53f; b < 5; b += 0.191f) {
      const auto [value, along_a, along_b] = field.recall(a, b);
      ASSERT_NEAR(along_a, (field.value(a + h, b) - field.value(a - h, b)) / (2 * h), 1e-5) << a << " " << b;
      ASSERT_NEAR(along_b, (field.value(a, b + h) - field.value(a, b - h)) / (2 * h), 1e-5) << a << " " << b;
    }
  }
}

TEST(Grids, NotANumberIsTheFirstPlaceAndInfinityAnEdge) {
  const Field field;
  EXPECT_EQ(field.recall(nan, nan).value, static_cast<float>(field.at(0, 0)));
  EXPECT_EQ(field.recall(nan, 2).value, static_cast<float>(field.at(0, 2)));
  EXPECT_EQ(field.recall(nan, 2).along_a, 0);
  EXPECT_EQ(field.recall(inf, -inf).value, static_cast<float>(field.at(4, 0)));
  EXPECT_EQ(field.recall(-3e38f, inf).value, static_cast<float>(field.at(0, 3)));
  EXPECT_EQ(field.recall(-3e38f, inf).along_a, 0);
  EXPECT_EQ(field.cell(nan, nan), static_cast<float>(field.at(0, 0)));
  EXPECT_EQ(field.cell(inf, -inf), static_cast<float>(field.at(4, 0)));
}

TEST(Grids, CellIsTheNearest) {
  const Field field;
  for (float a = -1.97f; a < 7; a += 0.073f) {
    for (float b = -1.93f; b < 6; b += 0.079f) {
      const int i = static_cast<int>(std::lround(std::min(std::max(a, 0.0f), 4.0f)));
      const int j = static_cast<int>(std::lround(std::min(std::max(b, 0.0f), 3.0f)));
      ASSERT_EQ(field.cell(a, b), static_cast<float>(field.at(i, j))) << a << " " << b;
    }
  }
}

TEST(Grids, OneCellIsTheSameEverywhere) {
  const std::vector<float> cells = {0.3f};
  for (const float a : {-1.0f, 0.0f, 0.4f, 5.0f, nan, inf}) {
    const auto [value, along_a, along_b] = recall_of({0, 1, 1}, cells.data(), a, -a);
    EXPECT_EQ(value, 0.3f);
    EXPECT_EQ(along_a, 0);
    EXPECT_EQ(along_b, 0);
    EXPECT_EQ(cell_at({0, 1, 1}, a, -a), 0u);
  }
}

}  // namespace
}  // namespace wale::grids_test
