// Minsky's stimuli, described from their forces alone, against the reports of her subjects and of Kornbrot's.

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "compiler/describe/describe.hpp"
#include "compiler/modules/load_modules.hpp"
#include "tests/standard/standard.hpp"

namespace wale::stimuli_test {
namespace {

constexpr double program_unit = 10.0 / 512;  // N: Minsky 1995, table 2

Description described(const Program& program) {
  static const auto common = common_modules();
  return describe(Bank(program), common->declarations);
}

/// Minsky 1995, section 6.3.8: "rolling hills (A3P100, A3P50, sometimes A3P25, and A1P7) and moguls (A19P100 and
/// A10P100). The remaining stimuli fall into a group which can be identified as flat textured surfaces." The twelfth,
/// A3P25, belongs to either of two groups, by the word "sometimes". The other eleven belong to one.
TEST(Chapter6, TheTwelveStimuliAreClassedByTheirForceAsTheSubjectsSortedThem) {
  struct Stimulus {
    const char* name;
    double units, period;  // table 8: program units; mm
    const char* group;
  };
  for (const Stimulus& each : {Stimulus{"a1p7", 10, 0.7, "rolling hills"},
                               {"a3p7", 30, 0.7, "flat texture"},
                               {"a3p12", 30, 1.2, "flat texture"},
                               {"a3p25", 30, 2.5, "rolling hills or flat texture"},
                               {"a3p50", 30, 5, "rolling hills"},
                               {"a3p100", 30, 10, "rolling hills"},
                               {"a10p7", 100, 0.7, "flat texture"},
                               {"a10p12", 100, 1.2, "flat texture"},
                               {"a10p25", 100, 2.5, "flat texture"},
                               {"a10p50", 100, 5, "flat texture"},
                               {"a10p100", 100, 10, "moguls"},
                               {"a19p100", 190, 10, "moguls"}}) {
    const Description description = described(standard::made("sandpaper.chapter6", each.name));
    const DescribedTexture& texture = *description.texture;
    EXPECT_NE(std::string(each.group).find(texture.texture_class), std::string::npos)
        << each.name << ": " << texture.texture_class;
    ASSERT_FALSE(texture.texture_class.empty()) << each.name;
    EXPECT_NEAR(texture.force.period, each.period * 1e-3, 0.02e-3 * each.period) << each.name;
    // Of the finest stimuli only the first harmonic is in the band of textures.
    const double newton = each.units * program_unit;
    EXPECT_NEAR(texture.force.amplitude, newton, (each.period < 1 ? 0.15 : 0.05) * newton) << each.name;
    EXPECT_TRUE(texture.force.regular()) << each.name;
  }
}

/// Ridges of constant height give a force in proportion to 1 / period, so their level must fall as period^-0.76 by
/// Minsky's map (figure 19). Kornbrot et al. 2007 found an exponent of -0.80 for ridges of constant height.
TEST(CrossCheck, RidgesOfOneHeightHaveNearlyTheExponentOfKornbrot) {
  double n = 0, u = 0, v = 0, uu = 0, uv = 0;
  for (const double period : {1.1, 1.7, 2.6, 4.1, 6.3, 9.4}) {
    const Description description =
        described(standard::material("material ridges { physical {\nheight ridges = 0.4 mm * sin(2 * pi * x / " +
                                         std::to_string(period) + " mm)\nforce = -0.5 N * grad(ridges)\n} }",
                                     "ridges"));
    const auto roughness = std::ranges::find(description.percepts, std::string("roughness"), &DescribedPercept::name);
    ASSERT_NE(roughness, description.percepts.end()) << period;
    EXPECT_TRUE(roughness->extracted);
    const double at = std::log(period), level = std::log(roughness->level);
    n += 1, u += at, v += level, uu += at * at, uv += at * level;
  }
  const double slope = (n * uv - u * v) / (n * uu - u * u);
  EXPECT_NEAR(slope, -0.759593, 0.02);
  EXPECT_NEAR(slope, -0.80, 0.06);
}

}  // namespace
}  // namespace wale::stimuli_test
