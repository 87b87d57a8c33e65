// The spline through a height table, against the functions that the table samples.

#include "runtime/machine/spline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

namespace wale::spline_test {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float inf = std::numeric_limits<float>::infinity();
constexpr double code = 1 / 65535.0;

HeightTable table_of(std::uint32_t width, std::uint32_t height, const std::function<double(double, double)>& f) {
  HeightTable table{width, height, {}};
  for (std::uint32_t j = 0; j < height; ++j) {
    for (std::uint32_t i = 0; i < width; ++i) {
      table.heights.push_back(static_cast<std::uint16_t>(std::lround(f(i, j) * 65535)));
    }
  }
  return table;
}

HeightTable noise(std::uint32_t width, std::uint32_t height) {
  std::mt19937 random(3);
  HeightTable table{width, height, std::vector<std::uint16_t>(width * height)};
  for (auto& value : table.heights) value = static_cast<std::uint16_t>(random());
  return table;
}

TEST(Spline, PassesThroughItsSamples) {
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{2, 2}, {2, 7}, {3, 2}, {5, 4}, {64, 33}, {200, 2}}) {
    const HeightTable table = noise(width, height);
    const Spline spline(table);
    for (int j = 0; j < height; ++j) {
      for (int i = 0; i < width; ++i) {
        EXPECT_NEAR(sample_of(spline, i, j).value, table.heights[j * width + i] * code, 6e-7) << i << " " << j;
      }
    }
  }
}

// A cubic spline reproduces polynomials up to the third degree away from the mirrored edges.
TEST(Spline, ReproducesACubic) {
  const auto cubic = [](double t) { return 0.5 + 0.3 * t - 0.1 * t * t - 0.25 * t * t * t; };
  const auto slope = [](double t) { return 0.3 - 0.2 * t - 0.75 * t * t; };
  const auto t = [](double i) { return (i - 50) / 50; };
  const Spline spline(table_of(101, 101, [&](double i, double j) { return 0.8 * cubic(t(i)) + 0.001 * j; }));
  for (float a = 25; a < 75; a += 0.37f) {
    const SplineSample s = sample_of(spline, a, 40.25f);
    EXPECT_NEAR(s.value, 0.8 * cubic(t(a)) + 0.04025, 2 * code);
    EXPECT_NEAR(s.along_a, 0.8 * slope(t(a)) / 50, 3 * code);
    EXPECT_NEAR(s.along_b, 0.001, 3 * code);
  }
}

TEST(Spline, FollowsASineMap) {
  const double u = 2 * std::numbers::pi / 16, v = 2 * std::numbers::pi / 20;
  const auto f = [&](double a, double b) { return 0.5 + 0.4 * std::cos(u * a) * std::cos(v * b); };
  // Whole-sample mirroring continues these cosines exactly: 64 and 80 samples after the first are crests.
  const Spline spline(table_of(65, 81, f));
  std::mt19937 random(5);
  std::uniform_real_distribution<float> anywhere(-300, 400);
  for (int i = 0; i < 20000; ++i) {
    const float a = anywhere(random), b = anywhere(random);
    const SplineSample s = sample_of(spline, a, b);
    EXPECT_NEAR(s.value, f(a, b), 2e-4);
    EXPECT_NEAR(s.along_a, -0.4 * u * std::sin(u * a) * std::cos(v * b), 6e-4);
    EXPECT_NEAR(s.along_b, -0.4 * v * std::cos(u * a) * std::sin(v * b), 6e-4);
  }
}

/// The spline as a plain sum over every coefficient, in double: coefficients from the linear system itself.
TEST(Spline, AgreesWithTheDefinition) {
  const HeightTable table = noise(6, 2);
  const Spline spline(table);
  // The coefficients of one line: solves (c[i-1] + 4 c[i] + c[i+1]) / 6 = s[i] with c mirrored, by Gauss-Seidel.
  const auto line = [](std::vector<double> s) {
    std::vector<double> c = s;
    const int n = static_cast<int>(s.size());
    for (int sweep = 0; sweep < 200; ++sweep) {
      for (int i = 0; i < n; ++i) {
        const double before = c[i > 0 ? i - 1 : 1], after = c[i + 1 < n ? i + 1 : n - 2];
        c[i] = (6 * s[i] - before - after) / 4;
      }
    }
    return c;
  };
  std::vector<std::vector<double>> rows(2);
  for (int j = 0; j < 2; ++j) {
    std::vector<double> s;
    for (int i = 0; i < 6; ++i) s.push_back(table.heights[j * 6 + i] * code);
    rows[j] = line(s);
  }
  for (int i = 0; i < 6; ++i) {
    const auto column = line({rows[0][i], rows[1][i]});
    rows[0][i] = column[0];
    rows[1][i] = column[1];
  }
  const auto basis = [](double t) {
    t = std::abs(t);
    return t < 1 ? 2.0 / 3 - t * t + t * t * t / 2 : t < 2 ? std::pow(2 - t, 3) / 6 : 0.0;
  };
  const auto mirror = [](int i, int n) {
    const int period = 2 * (n - 1);
    i = ((i % period) + period) % period;
    return i < n ? i : period - i;
  };
  for (float a = -7; a < 13; a += 0.21f) {
    for (float b = -2; b < 3; b += 0.17f) {
      double expected = 0;
      for (int j = -6; j < 8; ++j) {
        for (int i = -12; i < 18; ++i) expected += basis(a - i) * basis(b - j) * rows[mirror(j, 2)][mirror(i, 6)];
      }
      EXPECT_NEAR(sample_of(spline, a, b).value, expected, 3e-6) << a << " " << b;
    }
  }
}

TEST(Spline, DerivativesAreThoseOfTheValue) {
  const Spline spline(noise(40, 30));
  std::mt19937 random(9);
  std::uniform_real_distribution<float> along(-60, 100);
  const float step = 0.03125f;
  for (int i = 0; i < 5000; ++i) {
    const float a = std::round(along(random) * 256) / 256, b = std::round(along(random) * 256) / 256;
    const SplineSample s = sample_of(spline, a, b);
    const double da = (sample_of(spline, a + step, b).value - sample_of(spline, a - step, b).value) / (2.0 * step);
    const double db = (sample_of(spline, a, b + step).value - sample_of(spline, a, b - step).value) / (2.0 * step);
    // The error of a central difference is step^2 / 6 times the third derivative, which is about 10 on noise.
    EXPECT_NEAR(s.along_a, da, 6e-3);
    EXPECT_NEAR(s.along_b, db, 6e-3);
  }
}

TEST(Spline, MirrorsAtItsEdges) {
  const Spline spline(noise(9, 5));
  for (float d = 0; d < 30; d += 0.125f) {
    const SplineSample left = sample_of(spline, -d, 1.25f), right = sample_of(spline, d, 1.25f);
    EXPECT_NEAR(left.value, right.value, 1e-6);
    EXPECT_NEAR(left.along_a, -right.along_a, 1e-6);
    EXPECT_NEAR(left.along_b, right.along_b, 1e-6);
    const SplineSample below = sample_of(spline, 3.5f, 4 + d), above = sample_of(spline, 3.5f, 4 - d);
    EXPECT_NEAR(below.value, above.value, 1e-6);
    EXPECT_NEAR(below.along_b, -above.along_b, 1e-6);
  }
}

TEST(Spline, AnyCoordinateIsSafe) {
  const Spline spline(noise(7, 16));
  for (const float a : {nan, inf, -inf, 3.4e38f, -3.4e38f, 1e10f, -1e10f, 1e-42f, -0.0f, 8388608.5f}) {
    for (const float b : {nan, inf, -inf, 3.4e38f, 0.5f, 15.0f, 14.999999f}) {
      const SplineSample s = sample_of(spline, a, b);
      EXPECT_TRUE(std::isfinite(s.value) && std::isfinite(s.along_a) && std::isfinite(s.along_b)) << a << " " << b;
    }
  }
  EXPECT_EQ(sample_of(spline, nan, 2).value, sample_of(spline, 0, 2).value);
  EXPECT_EQ(sample_of(spline, inf, 2).value, sample_of(spline, 0, 2).value);
}

}  // namespace
}  // namespace wale::spline_test
