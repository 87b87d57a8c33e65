// Lattice noise passes statistical tests of randomness: counts, moments and correlations.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "runtime/machine/arithmetic.hpp"

namespace wale::hash_test {
namespace {

constexpr int side = 128;  // lattice points along each side of a cube about the origin

template <class Look>
void at_every_point(Look look) {
  for (int i = -side / 2; i < side / 2; ++i) {
    for (int j = -side / 2; j < side / 2; ++j) {
      for (int k = -side / 2; k < side / 2; ++k)
        look(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k));
    }
  }
}
constexpr double points = double{side} * side * side;

/// The distance of the chi-square statistic from its mean, in standard deviations, for counts of equal expectation.
double surprise(const std::vector<long>& counts) {
  double total = 0, chi_square = 0;
  for (const long count : counts) total += static_cast<double>(count);
  const double expected = total / static_cast<double>(counts.size());
  for (const long count : counts) {
    chi_square += (static_cast<double>(count) - expected) * (static_cast<double>(count) - expected) / expected;
  }
  const double freedom = static_cast<double>(counts.size() - 1);
  return (chi_square - freedom) / std::sqrt(2 * freedom);
}

// Computed from the definition in schema/PATCH_PROGRAM.md with integers of unlimited size.
TEST(Hash, IsTheDocumentedOne) {
  EXPECT_EQ(hash_of(0, 0, 0), 0.5793412327766418f);
  EXPECT_EQ(hash_of(1, 0, 0), 0.8374328017234802f);
  EXPECT_EQ(hash_of(0, 1, 0), 0.7753357887268066f);
  EXPECT_EQ(hash_of(0, 0, 1), 0.12033867835998535f);
  EXPECT_EQ(hash_of(-1, 2, -3), 0.3776739835739136f);
  EXPECT_EQ(hash_of(1000, -1000, 7), 0.6802402138710022f);
}

TEST(Hash, IsTheSameWithinACell) {
  for (const float f : {0.0f, 0.25f, 0.999f}) {
    EXPECT_EQ(hash_of(3 + f, -2 + f, f), hash_of(3, -2, 0));
    EXPECT_EQ(hash_of(-1 + f, 0, 0), hash_of(-1, 0, 0));
  }
  EXPECT_NE(hash_of(-0.001f, 0, 0), hash_of(0, 0, 0));
}

/// Of every 4099th of all floats, and of those at the ends: what the standard library says of the same in double precision.
TEST(Hash, CountsInWholeNumbersBelow) {
  const auto expected = [](float a) {
    if (std::isnan(a)) return std::int64_t{0};
    return static_cast<std::int64_t>(std::floor(std::min(std::max(static_cast<double>(a), -2147483520.0), 2147483520.0)));
  };
  const auto check = [&](float a) {
    ASSERT_EQ(static_cast<std::int32_t>(arithmetic::lattice_index(a)), expected(a)) << a;
  };
  for (std::uint64_t bits = 0; bits <= 0xffffffffu; bits += 4099) {
    const auto a = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    if (a == 0 || std::isnormal(a) || !std::isfinite(a)) check(a);  // others are flushed before
  }
  for (const float end : {2147483520.0f, 2147483648.0f, 1e30f, std::numeric_limits<float>::infinity(), 8388607.5f, 0.99999994f, 1.0f, 0.0f})
    check(end), check(-end);
}

TEST(Hash, TakesAnyFloat) {
  constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(hash_of(nan, 1, 2), hash_of(0, 1, 2));
  EXPECT_EQ(hash_of(1, -nan, nan), hash_of(1, 0, 0));
  EXPECT_EQ(hash_of(inf, 0, 0), hash_of(3e38f, 0, 0));
  EXPECT_EQ(hash_of(inf, 0, 0), hash_of(2147483648.0f, 0, 0));
  EXPECT_EQ(hash_of(0, -inf, 0), hash_of(0, -2147483648.0f, 0));
  EXPECT_NE(hash_of(inf, 0, 0), hash_of(-inf, 0, 0));
  EXPECT_NE(hash_of(2147483520.0f, 0, 0), hash_of(2147483392.0f, 0, 0));
  for (const float a : {inf, -inf, nan, 1e-40f, -1e-40f, 3e38f}) {
    EXPECT_GE(hash_of(a, a, a), 0.0f);
    EXPECT_LT(hash_of(a, a, a), 1.0f);
  }
}

TEST(Hash, IsUniform) {
  std::vector<long> high(4096), low(4096);
  double sum = 0, squares = 0;
  at_every_point([&](float a, float b, float c) {
    const float h = hash_of(a, b, c);
    ASSERT_TRUE(h >= 0 && h < 1);
    const auto bits = static_cast<unsigned>(h * 0x1p24f);
    ++high[bits >> 12];
    ++low[bits & 4095];
    sum += h;
    squares += (h - 0.5) * (h - 0.5);
  });
  EXPECT_LT(std::abs(surprise(high)), 4);
  EXPECT_LT(std::abs(surprise(low)), 4);
  EXPECT_NEAR(sum / points, 0.5, 4 * std::sqrt(1 / 12.0 / points));
  EXPECT_NEAR(squares / points, 1 / 12.0, 4 * std::sqrt(1 / 180.0 / points));
}

TEST(Hash, HasAllItsBits) {
  std::set<float> different;
  for (int i = 0; i < 100000; ++i) different.insert(hash_of(static_cast<float>(i), 5, 0));
  // Among 1e5 random numbers out of 2^24, 1e5^2 / 2 / 2^24 = 298 pairs are expected to be equal.
  EXPECT_NEAR(100000.0 - static_cast<double>(different.size()), 298, 5 * std::sqrt(298));
}

TEST(Hash, NeighboursAreUncorrelated) {
  using Offset = std::array<float, 3>;
  for (const Offset& d : {Offset{1, 0, 0}, Offset{0, 1, 0}, Offset{0, 0, 1}, Offset{1, 1, 0}, Offset{0, -1, 1},
                          Offset{1, 1, 1}, Offset{16, 0, 0}, Offset{0, 64, 0}, Offset{-256, 0, 256}}) {
    double product = 0;
    std::vector<long> pairs(256);
    at_every_point([&](float a, float b, float c) {
      const float one = hash_of(a, b, c), other = hash_of(a + d[0], b + d[1], c + d[2]);
      product += (one - 0.5) * (other - 0.5);
      ++pairs[static_cast<std::size_t>(one * 16) * 16 + static_cast<std::size_t>(other * 16)];
    });
    EXPECT_LT(std::abs(product / points * 12), 4.5 / std::sqrt(points)) << d[0] << " " << d[1] << " " << d[2];
    EXPECT_LT(std::abs(surprise(pairs)), 4.5) << d[0] << " " << d[1] << " " << d[2];
  }
}

TEST(Hash, OrderMatters) {
  double product = 0;
  long same = 0;
  at_every_point([&](float a, float b, float c) {
    product += (hash_of(a, b, c) - 0.5) * (hash_of(b, c, a) - 0.5);
    same += hash_of(a, b, c) == hash_of(b, a, c) && a != b;
  });
  EXPECT_LT(std::abs(product / points * 12), 0.01);  // points on the diagonal are equal
  EXPECT_LT(same, 2);
}

// A changed bit of a coordinate changes each bit of the result with a probability of one half.
TEST(Hash, EveryBitChangesEveryBit) {
  constexpr int trials = 4096;
  double worst = 0;
  for (int coordinate = 0; coordinate < 3; ++coordinate) {
    for (int bit = 0; bit < 23; ++bit) {
      std::array<int, 24> turned{};
      for (int trial = 0; trial < trials; ++trial) {
        std::array<float, 3> at = {static_cast<float>(trial * 7919 % 65536), static_cast<float>(trial % 61),
                                   static_cast<float>(trial % 67)};
        const auto before = static_cast<std::uint32_t>(hash_of(at[0], at[1], at[2]) * 0x1p24f);
        at[coordinate] = static_cast<float>(static_cast<std::int32_t>(at[coordinate]) ^ 1 << bit);
        const auto after = static_cast<std::uint32_t>(hash_of(at[0], at[1], at[2]) * 0x1p24f);
        for (int i = 0; i < 24; ++i) turned[i] += (before ^ after) >> i & 1;
      }
      for (const int count : turned) worst = std::max(worst, std::abs(count / double{trials} - 0.5));
    }
  }
  EXPECT_LT(worst, 5 * 0.5 / std::sqrt(trials));
}

}  // namespace
}  // namespace wale::hash_test
