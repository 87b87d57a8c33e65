// Single hills and holes of many shapes: bumps, and no walls; small ones beside waves.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "compiler/modules/load_modules.hpp"
#include "compiler/read/read.hpp"
#include "compiler/read/tolerances.hpp"
#include "tests/standard/standard.hpp"

namespace wale::hills_test {
namespace {

ForceReading reading(const std::string& statements) {
  static const auto common = common_modules();
  return read(Bank(standard::material("material m { physical {\n" + statements + "\n} }", "m")), common->declarations);
}

/// Of the distance in radii from its middle.
const char* const shapes[] = {"exp(-{0}^2)", "(if {0} < 1 then 0.5 + 0.5 * cos(pi * {0}) else 0)", "max(0, 1 - {0})",
                              "max(0, 1 - {0}^2)"};

TEST(ReadingHills, OfEachShapeAreBumps) {
  std::mt19937 random(21);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  for (int i = 0; i < 16; ++i) {
    const double size = between(0.5, 4), radius = between(14, 30);
    const std::string far = fmt::format("(length(hand - vector({:.1f} mm, {:.1f} mm)) / {:.1f} mm)", between(-35, 35),
                                        between(-35, 35), radius);
    const std::string statements =
        fmt::format("height h = {}1 * {}\nforce = lateral(h, amplitude: {} N)", i % 3 == 0 ? "-" : "",
                    fmt::format(fmt::runtime(shapes[i % 4]), far), size);
    const ForceReading found = reading(statements);
    EXPECT_NEAR(found.relief().amplitude, size, 0.03 * size) << statements;
    EXPECT_EQ(found.relief().period, 0) << statements;
    EXPECT_FALSE(found.wall) << statements;
    EXPECT_TRUE(found.steps.empty()) << statements;
    EXPECT_EQ(found.outward > 0, i % 3 != 0) << statements;
  }
}

TEST(ReadingHills, OfBellsAreNoRoundWalls) {
  std::mt19937 random(22);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  for (int i = 0; i < 16; ++i) {
    const std::string statements = fmt::format(
        "let off = (hand - vector({:.2f} mm, {:.2f} mm)) / {:.2f} mm\nforce = {:.2f} N * exp(0.5 - dot(off, off) / 2) "
        "* off",
        between(-20, 20), between(-20, 20), i == 0 ? 6.61 : between(6, 15), between(0.5, 4));
    const ForceReading found = reading(statements);
    EXPECT_FALSE(found.wall) << statements;
    EXPECT_GT(found.outward, 0) << statements;
  }
}

TEST(ReadingHills, ASmallOneBesideAWaveIsTold) {
  for (const char* wave : {"cos(2 pi * x / 8 mm)", "cos(2 pi * (x + y) / 5 mm)"}) {
    const std::string alone = fmt::format("force wave = lateral({}, amplitude: 1 N)", wave);
    // 1.5 N at the steepest of a bell of 3 mm, which fills less than a hundredth of the patch.
    const std::string bell =
        "\nlet off = (hand - vector(20 mm, -12 mm)) / 3 mm\n"
        "force bell = 1.5 N * exp(0.5) * 1.41421356 * exp(-dot(off, off)) * off";
    EXPECT_EQ(reading(alone).relief().small_feature(), 0) << wave;
    const ForceReading both = reading(alone + bell);
    EXPECT_NEAR(both.relief().amplitude, 1, 0.05) << wave;
    EXPECT_NEAR(both.relief().small_feature(), 1.5, 0.3) << wave;
  }
}

}  // namespace
}  // namespace wale::hills_test
