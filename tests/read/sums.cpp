// Two sines along one direction, read as themselves and with their shares of the mean square.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "compiler/read/relief.hpp"
#include "tests/standard/standard.hpp"

namespace wale::sums_test {
namespace {

TEST(Sums, OfAFineWaveOnACoarseOneAreTheseTwo) {
  struct Sum {
    double coarse, fine;  // mm
    double of_fine;       // amplitude, of the coarse one's
    double phase;         // rad, of the fine one
  };
  // Over few periods a common multiple fits by chance: 39.1 mm is nearly nine times 4.1 mm. And harmonics meet: the
  // third of 3 mm is the 25th of 25 mm.
  constexpr Sum sums[] = {{39.1, 4.1, 1, 5},     {35.91, 11, 0.7, 1},  {20.95, 7.77, 1, 3.93}, {15.8, 2.48, 1, 4.485},
                          {25, 3, 0.7, 2.894},   {24, 5, 0.4, 5.3},    {12, 1, 1, 1},          {16, 1, 0.7, 2},
                          {9.74, 2, 1, 5.95},    {2, 0.7, 0.7, 1.216}, {3.86, 0.5, 0.4, 3.82}, {5, 0.7, 0.7, 1.645},
                          {5.9, 2.4, 0.5, 3.39}, {27, 13, 0.5, 0.7},   {30.69, 6.57, 1, 2},    {5, 0.6, 1, 1.193}};
  for (const Sum& sum : sums) {
    const std::string force = "force = vector(1 N * sin(2 * pi * x / " + std::to_string(sum.coarse) + " mm) + " +
                              std::to_string(sum.of_fine) + " N * sin(2 * pi * x / " + std::to_string(sum.fine) +
                              " mm + " + std::to_string(sum.phase) + "), 0 N)";
    const Relief relief =
        static_force(Bank(standard::material("material m { physical {\n    " + force + "\n} }", "m"))).relief;
    ASSERT_EQ(relief.waves.size(), 2u) << force;
    auto waves = relief.waves;
    std::ranges::sort(waves, {}, &ReliefWave::period);
    const double square = sum.of_fine * sum.of_fine, of_fine = square / (1 + square);
    EXPECT_NEAR(waves[0].period, 1e-3 * sum.fine, 5e-3 * 1e-3 * sum.fine) << force;
    EXPECT_NEAR(waves[1].period, 1e-3 * sum.coarse, 5e-3 * 1e-3 * sum.coarse) << force;
    EXPECT_NEAR(waves[0].share, of_fine, 0.02) << force;
    EXPECT_NEAR(waves[1].share, 1 - of_fine, 0.02) << force;
  }
}

struct Pair {
  double one, other;  // mm

  std::string force() const {
    return "force = vector(0.6 N * (sin(2 * pi * x / " + std::to_string(one) + " mm) + sin(2 * pi * x / " +
           std::to_string(other) + " mm)), 0 N)";
  }
  Relief relief() const {
    return static_force(Bank(standard::material("material m { physical {\n    " + force() + "\n} }", "m"))).relief;
  }
  /// The largest force over the root mean square, which is that of two sines of 1.
  double largest() const {
    double most = 0;
    for (double x = 0; x < 60; x += 1e-3)
      most = std::max(most, std::abs(std::sin(2 * std::numbers::pi * x / one) + std::sin(2 * std::numbers::pi * x / other)));
    return most;
  }
  /// The largest force but 1 % over the root mean square, in steps of a micrometre over a patch of 160 mm less its rim.
  double crest() const {
    std::vector<double> sizes;
    double squares = 0;
    for (double x = -75; x < 75; x += 1e-3) {
      const double force = std::sin(2 * std::numbers::pi * x / one) + std::sin(2 * std::numbers::pi * x / other);
      sizes.push_back(std::abs(force)), squares += force * force;
    }
    const auto most = sizes.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(sizes.size()));
    std::nth_element(sizes.begin(), most, sizes.end());
    return *most / std::sqrt(squares / static_cast<double>(sizes.size()));
  }
};

TEST(Sums, WithoutASmallCommonMultipleAreNeverWhollyRegular) {
  // They repeat together after 9 to 42 mm, which is five of the longer or more.
  for (const Pair& pair : {Pair{3, 3.6}, {2, 2.4}, {5, 7}, {6, 7}, {5, 8}, {3, 3.375}, {2.1, 2.7}}) {
    const Relief relief = pair.relief();
    EXPECT_TRUE(relief.regular()) << pair.force();
    EXPECT_LT(relief.regularity, 0.95) << pair.force();
    EXPECT_NEAR(relief.crest, pair.crest(), 0.05) << pair.force();
    EXPECT_NEAR(relief.crest, relief.amplitude / relief.rms, 0.05) << pair.force();
    EXPECT_GT(relief.period, 0.99e-3 * pair.one) << pair.force();
  }
  for (const Pair& pair : {Pair{4, 5}, {2, 3}}) {
    const Relief relief = pair.relief();
    EXPECT_GT(relief.regularity, 0.98) << pair.force();
    EXPECT_NEAR(relief.period, 1e-3 * pair.one * pair.other, 1e-4) << pair.force();
  }
  // Two that repeat together are one waveform, whose largest force comes once in a period.
  for (const Pair& pair : {Pair{4, 8}, {8, 4}, {5, 10}, {4, 6}, {3, 9}, {4, 5}, {2, 3}}) {
    const Relief relief = pair.relief();
    EXPECT_NEAR(relief.crest, pair.largest(), 0.03) << pair.force();
    EXPECT_GT(relief.regularity, 0.98) << pair.force();
  }
}

}  // namespace
}  // namespace wale::sums_test
