// Features that slope on little of the patch: what is said of them, that what is proposed helps when it is followed,
// and that nothing is said of textures, of wide features and of cones.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <regex>
#include <string>

#include "compiler/check_files.hpp"

namespace wale::small_features_test {
namespace {

struct Said {
  std::string codes, message, help;
};

/// What `wale check` says of a material whose height is `height`; of several diagnostics the last message and help.
Said said_of(const std::string& height, const std::string& patch = "", const std::string& function = "lateral") {
  SourceSet sources;
  const Diagnostics diagnostics = check_text(
      sources, sources.add("small.wale", "wale 1\nmaterial m {\n  physical {\n    " + patch + "\n    height h = " +
                                             height + "\n    force = " + function + "(h, amplitude: 1 N)\n  }\n}\n"));
  Said said;
  for (const Diagnostic& each : diagnostics.all()) {
    said.codes += (said.codes.empty() ? "" : " ") + code_name(each.code);
    said.message = each.message, said.help = each.help;
  }
  return said;
}

std::string first_match(const std::string& text, const char* pattern) {
  std::smatch found;
  return std::regex_search(text, found, std::regex(pattern)) ? found[1].str() : "";
}

TEST(SmallFeatures, AreNotCalledFlat) {
  const Said said = said_of("(1 - clamp(length(hand) / 8 mm, 0, 1)^2)^2");
  EXPECT_EQ(said.codes, "W0409");
  EXPECT_EQ(said.message.find("flat"), std::string::npos) << said.message;
  // A disc of 8 mm on a patch of 160 mm, whose rim is 5 % of it or less.
  const double covered = std::stod(first_match(said.message, R"(slopes on ([0-9.]+) % of the patch)"));
  EXPECT_NEAR(covered, 100 * std::numbers::pi * 8 * 8 / (152.0 * 152), 0.1);
  EXPECT_EQ(said_of("2 mm + 0 * x").message.find("slopes on"), std::string::npos);
}

TEST(SmallFeatures, TheSmallerPatchGivesThemRoom) {
  for (const char* height : {"(1 - clamp(length(hand) / 8 mm, 0, 1)^2)^2", "(1 - clamp(length(hand) / 3 mm, 0, 1)^2)^2",
                             "exp(-(length(hand) / 3 mm)^2)", "exp(-(length(hand) / 1 mm)^2)",
                             "smoothstep(2 - length(hand) / 4 mm)", "smoothstep(x / 1 mm)", "smoothstep(y / 1.5 mm)"})
    for (const char* function : {"lateral", "bumps"}) {
      const Said said = said_of(height, "", function);
      EXPECT_TRUE(said.codes == "W0409" || said.codes == "W0437") << height << ": " << said.codes;
      const std::string patch = first_match(said.help, "`(patch [^`]*)`");
      ASSERT_FALSE(patch.empty()) << height << ": " << said.help;
      EXPECT_EQ(said_of(height, patch, function).codes, "") << height << " on " << patch;
    }
}

TEST(SmallFeatures, RepeatedTheyAreTextures) {
  for (const char* height : {"(1 - clamp(length(hand) / 8 mm, 0, 1)^2)^2", "exp(-(length(hand) / 3 mm)^2)"}) {
    const std::string repeated =
        std::regex_replace(std::string(height), std::regex("hand"),
                           "vector(modulo(x + 10 mm, 20 mm) - 10 mm, modulo(y + 10 mm, 20 mm) - 10 mm)");
    EXPECT_EQ(said_of(repeated).codes, "") << repeated;
  }
}

TEST(SmallFeatures, AsideOfTheMiddleNoSmallerPatchIsProposed) {
  const Said said = said_of("exp(-(length(hand - vector(40 mm, 30 mm)) / 2 mm)^2)");
  EXPECT_EQ(said.codes, "W0437");
  EXPECT_NE(said.help.find("move the feature to the middle"), std::string::npos) << said.help;
}

TEST(SmallFeatures, WhatIsHeldIsAsMuchAsAFormulaSays) {
  // A Gaussian of width s slopes with 2 r / s^2 exp(-r^2 / s^2). Above the percentile lies a ring of 1 % of the patch.
  const double s = 4, area = 152.0 * 152;
  const auto slope = [&](double r) { return r * std::exp(-r * r / (s * s)); };
  const double steepest = slope(s / std::numbers::sqrt2);
  double percentile = steepest;
  for (double above = 0; above < 0.01 * area; percentile *= 0.999) {
    above = 0;
    for (double r = 0; r < 40; r += 0.01)
      if (slope(r) > percentile) above += 2 * std::numbers::pi * r * 0.01;
  }
  const Said said = said_of("exp(-(length(hand) / 4 mm)^2)");
  EXPECT_EQ(said.codes, "W0437");
  const double told = std::stod(first_match(said.message, R"(there is ([0-9.]+) times)"));
  EXPECT_NEAR(told / (steepest / percentile), 1, 0.2);
}

TEST(SmallFeatures, TexturesWideFeaturesAndConesAreLeftAlone) {
  for (const char* height :
       {"grating(x, period: 3 mm)", "grating(x, period: 3 mm, duty: 5 %)", "grating(x, period: 20 mm, duty: 3 %)",
        "grating(x, period: 10 mm, duty: 10 %, smooth: 0.005)", "grating(x, period: 50 mm, duty: 0.5)",
        "sin(2 pi * x / 5 mm)", "noise2(x / 2 mm, y / 2 mm)", "max(0, noise2(x / 2 mm, y / 2 mm) - 0.8)",
        "exp(-(length(hand) / 12 mm)^2)", "exp(-(length(hand) / 30 mm)^2)", "max(0 mm, 9 mm - length(hand))",
        "smoothstep(x / 8 mm)", "sin(2 pi * x / 5 mm) + exp(-(length(hand) / 3 mm)^2)"})
    EXPECT_EQ(said_of(height).codes, "") << height;
}

TEST(SmallFeatures, AHeightThatOnlyJumpsRisesOverADistanceThatIsEnough) {
  const Said step = said_of("if x > 0 mm then 1 mm else 0 mm");
  EXPECT_EQ(step.codes, "W0409");
  const std::string rise = first_match(step.help, "`(smoothstep[^`]*)`");
  EXPECT_EQ(said_of("1 mm * " + rise).codes, "") << rise;
  const std::string on_a_small_patch =
      first_match(said_of("if x > 0 mm then 1 mm else 0 mm", "patch 60 mm, 40 mm").help, "`(smoothstep[^`]*)`");
  EXPECT_EQ(said_of("1 mm * " + on_a_small_patch, "patch 60 mm, 40 mm").codes, "") << on_a_small_patch;
  const std::string steps = first_match(said_of("floor(x / 3 mm)").help, "`(smoothed_steps[^`]*)`");
  EXPECT_EQ(said_of("1 mm * " + steps).codes, "") << steps;
  const std::string ridges = first_match(said_of("if modulo(x, 10 mm) < 5 mm then 1 else 0").help, "`(grating[^`]*)`");
  EXPECT_EQ(said_of(ridges).codes, "") << ridges;
}

}  // namespace
}  // namespace wale::small_features_test
