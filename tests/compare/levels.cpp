// wale levels: proposed levels against the definition of a just noticeable difference, computed by hand.

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "compiler/compare/propose_levels.hpp"
#include "compiler/compile.hpp"
#include "compiler/diagnostics/render.hpp"
#include "compiler/modules/load_modules.hpp"
#include "compiler/solve/level_scale.hpp"

namespace wale::compare_levels_test {
namespace {

constexpr double d_prime_of_three_of_four = 0.9538725524;  // sqrt(2) z(0.75): tables of the normal distribution

Result<LevelProposal> propose(const std::string& percept, std::optional<std::size_t> steps, double apart = 1,
                              const std::string& device = "sandpaper") {
  static const auto common = common_modules();
  return propose_levels(percept, device, steps, apart, common->declarations);
}

LevelProposal proposal(const std::string& percept, std::optional<std::size_t> steps, double apart = 1,
                       const std::string& device = "sandpaper") {
  const auto proposed = propose(percept, steps, apart, device);
  if (!proposed) throw std::runtime_error(proposed.error().sentence);
  return *proposed;
}

std::string reason(const Result<LevelProposal>& proposed) {
  return proposed ? "" : proposed.error().sentence + "; " + proposed.error().mend;
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Levels, OfASpringAreAGeometricSeries) {
  // The magnitude is proportional to the stiffness, level 1 is 200 N/m, and the map begins at 20 N/m. The Weber
  // fraction is 0.22 at three of four, so 20 .. 200 N/m are ln(10) / ln(1 + 0.2306) = 11.1 just noticeable differences.
  const double whole = std::log(10.0) / std::log1p(0.22 / d_prime_of_three_of_four);
  const LevelProposal four = proposal("springiness", 4);
  ASSERT_EQ(four.levels.size(), 4u);
  EXPECT_EQ(four.unit, "N/m");
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(four.levels[i].size, 20 * std::pow(10, i / 3.0), 0.2) << i;
    EXPECT_NEAR(four.levels[i].level, 0.1 * std::pow(10, i / 3.0), 0.001) << i;
    if (i > 0) {
      EXPECT_NEAR(four.levels[i].apart, whole / 3, 0.05 * whole / 3) << i;
    }
  }
  EXPECT_EQ(four.most, 1 + static_cast<std::size_t>(std::floor(whole)));
  EXPECT_EQ(proposal("springiness", std::nullopt).levels.size(), 12u);
  const LevelProposal far = proposal("springiness", std::nullopt, 3);
  EXPECT_EQ(far.levels.size(), 1 + static_cast<std::size_t>(std::floor(whole / 3)));
  // How far apart levels are asked for changes how many fit, and not how many people tell apart.
  EXPECT_EQ(far.fit, far.levels.size());
  EXPECT_EQ(far.most, four.most);
}

TEST(Levels, AreSpacedByTheFloorWhereForcesAreSmall) {
  // Level = (F / 194 pu)^0.759593, from level 0.1, which is near the threshold. A just noticeable difference is 0.07 of
  // the force at three of four, but at least 0.1 N: below 1.36 N steps of force are equal, above it ratios are.
  const LevelProposal all = proposal("roughness", std::nullopt);
  const double one = 194 * 10.0 / 512, share = std::log1p(0.07);
  const auto force = [&](double level) { return one * std::pow(level, 1 / 0.759593); };
  double sum = 0;
  for (std::size_t i = 1; i < all.levels.size(); ++i) {
    const double low = force(all.levels[i - 1].level), high = force(all.levels[i].level);
    const double apart = std::min((high - low) / 0.1, std::log(high / low) / share);
    EXPECT_NEAR(all.levels[i].apart, apart, 1e-6) << i;
    EXPECT_GE(apart, 1) << i;
    EXPECT_LE(apart, 1.06) << i;
    sum += apart;
  }
  EXPECT_DOUBLE_EQ(all.levels.front().level, 0.1);
  EXPECT_DOUBLE_EQ(all.levels.back().level, 1);
  // The number of levels is that of whole steps in the range.
  const double knee = 0.1 / (std::exp(share) - 1);
  const double whole = (knee - force(0.1)) / 0.1 + std::log(one / knee) / share;
  EXPECT_NEAR(static_cast<double>(all.most), 1 + whole, 1.01);
  EXPECT_NEAR(sum, whole, 0.02 * whole);
}

TEST(Levels, EndWhereTheDeviceDoes) {
  // A spring of 200 N/m pushes with 8 N at 40 mm, which is the Falcon's largest force.
  EXPECT_NEAR(proposal("springiness", 3, 1, "falcon").levels.back().size, 200, 0.1);
  // The map of viscosity ends at 20 N s/m, above level 1. The map of hardness begins at 100 N/m.
  EXPECT_NEAR(proposal("viscosity", 3).levels.back().size, 10, 1e-9);
  EXPECT_GE(proposal("hardness", 2).levels.front().size, 100 * (1 - 1e-9));
}

TEST(Levels, OfAnAntonymAreTheScaleFromItsOtherEnd) {
  const LevelProposal rough = proposal("roughness", 5), smooth = proposal("smoothness", 5);
  EXPECT_TRUE(smooth.reversed);
  EXPECT_EQ(smooth.percept, "roughness");
  ASSERT_EQ(rough.levels.size(), smooth.levels.size());
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(rough.levels[i].level, smooth.levels[i].level);
  // The names rise with what was asked for: the first level of smoothness is the roughest.
  EXPECT_TRUE(levels_line(smooth).starts_with("levels roughness { level_1 1; level_2 ")) << levels_line(smooth);
  EXPECT_TRUE(contains(levels_line(smooth), "level_5 0.1 }")) << levels_line(smooth);
  EXPECT_TRUE(levels_line(rough).starts_with("levels roughness { level_1 0.1; level_2 ")) << levels_line(rough);
}

/// Absolute identification (Cholewiak, Tan and Ebert 2008): 2.9 forces and 2.8 stiffnesses. Nothing is published for
/// viscosity, and on a scale with two differences no three levels fit.
TEST(Levels, ThatAreRecognisedAloneAreFewerThanThoseToldApart) {
  static const auto common = common_modules();
  const auto recognised = [](const std::string& percept, double apart = 1) {
    return *propose_recognised_levels(percept, "sandpaper", apart, common->declarations);
  };
  for (const char* percept : {"roughness", "smoothness", "springiness", "hardness", "softness"}) {
    const LevelProposal found = recognised(percept);
    EXPECT_EQ(found.levels.size(), 3u) << percept;
    EXPECT_GT(found.most, 3u) << percept;
    EXPECT_TRUE(contains(proposal_text(found), "recognised alone: about 3")) << proposal_text(found);
  }
  EXPECT_EQ(recognised("springiness", 8).levels.size(), 2u) << "11.1 differences of springiness";
  const LevelProposal unknown = recognised("viscosity");
  EXPECT_EQ(unknown.levels.size(), unknown.most);
  EXPECT_TRUE(contains(proposal_text(unknown), "recognised alone: unknown"));
  const LevelProposal all = proposal("roughness", std::nullopt);
  EXPECT_TRUE(contains(proposal_text(all), "for comparing, not for naming"));
}

TEST(Levels, ThatCannotBeProposedAreExplained) {
  EXPECT_TRUE(contains(reason(propose("rougness", 3)), "did you mean `roughness`?"));
  EXPECT_TRUE(contains(reason(propose("roughness", 3, 1, "sandpapr")), "did you mean `sandpaper`?"));
  EXPECT_TRUE(contains(reason(propose("vibration", 3)), "unknown: no published threshold"));
  EXPECT_TRUE(contains(reason(propose("sharpness", 3)), "found sharpness, which can only be compared"));
  EXPECT_TRUE(contains(reason(propose("springiness", 13)), "ask for 12 levels at most"));
  EXPECT_TRUE(contains(reason(propose("springiness", 4, 5)),
                       "less than 5 just noticeable differences apart; ask for 3 levels"));
  EXPECT_TRUE(contains(reason(propose("springiness", 2, 50)), "no two levels"));
  EXPECT_TRUE(contains(reason(propose("springiness", 1)), "expected at least two levels"));
  EXPECT_TRUE(contains(reason(propose("springiness", 3, 0)), "must be above 0"));
}

/// The diagnostics of a text's levels on a device, as text.
std::string said_of_levels(const std::string& text, const std::string& device) {
  SourceSet sources;
  Diagnostics diagnostics;
  const SourceId source = sources.add("levels.wale", "wale 1\n" + text);
  const auto resolver = file_resolver({});
  const CheckedModule module = check_source(sources, source, *resolver, diagnostics);
  check_levels(module.declarations(), source, device, diagnostics);
  std::string all;
  for (const auto& each : diagnostics.all()) all += render_text(each, sources, false);
  return all;
}

TEST(Levels, OfAVibrationDeviceNeedAThreshold) {
  // No threshold for a pad's acceleration is published, so no levels are proposed.
  for (const char* percept : {"roughness", "vibration"}) {
    const auto proposed = propose_levels(percept, "touch_pad", std::nullopt, 1, common_modules()->declarations);
    ASSERT_FALSE(proposed) << percept;
    EXPECT_EQ(proposed.error().code, Code::no_threshold);
    EXPECT_EQ(proposed.error().sentence,
              std::string("unknown: no published threshold says how small a difference of ") + percept +
                  " is noticed as `touch_pad` renders it");
  }
  const auto spring = propose_levels("springiness", "touch_pad", std::nullopt, 1, common_modules()->declarations);
  ASSERT_FALSE(spring);
  EXPECT_EQ(spring.error().code, Code::percept_unrealised);
  EXPECT_EQ(spring.error().sentence, "`touch_pad` only vibrates, and has no rule that makes springiness");
}

TEST(CloseLevels, AreJudgedOnTheGivenDevice) {
  // 8.4 N and 9.6 N are ln(9.6 / 8.4) / ln(1.07) = 2.0 apart on the Sandpaper joystick. The Falcon limits both to
  // 8 N.
  const std::string text =
      "percept grit { one lateral amplitude 12 N on sandpaper\n  cue amplitude }\n"
      "map grit from amplitude {\n  law magnitude = amplitude / 1 N\n  valid amplitude 0.1 N .. 12 N\n  scatter 0.05\n"
      "  evidence slope measured, anchor measured, handle measured\n  on sandpaper\n  source \"a test\"\n}\n"
      "levels grit {\n  gravel 0.7\n  rubble 0.8\n}\n";
  EXPECT_EQ(said_of_levels(text, "sandpaper"), "");
  EXPECT_TRUE(contains(said_of_levels(text, "falcon"), "warning[W0423]")) << said_of_levels(text, "falcon");
}

TEST(CloseLevels, AreToldToBeExtrapolatedBeyondWhatWasCompared) {
  const auto said = [](const char* levels) {
    return said_of_levels(std::string("levels roughness { ") + levels, "sandpaper");
  };
  EXPECT_TRUE(contains(said("felted 0.5; woolly 0.51 }"), "abstract, extrapolated from amplitude 2.5 N .. 10 N)"));
  EXPECT_TRUE(contains(said("felted 0.9; woolly 0.91 }"), "abstract)")) << "3.3 N was compared";
}

TEST(CloseLevels, TheProposalIsOneApart) {
  // Springiness is proportional to stiffness, so the next level is 0.5 (1 + w).
  const double share = 1 + 0.22 / d_prime_of_three_of_four;
  const std::string said = said_of_levels("levels springiness {\n  a 0.5\n  b 0.6\n}\n", "sandpaper");
  EXPECT_TRUE(contains(said, "`b 0.616` is one just noticeable difference")) << said;
  EXPECT_NEAR(0.5 * share, 0.616, 0.001);
  EXPECT_EQ(said_of_levels("levels springiness {\n  a 0.5\n  b 0.616\n}\n", "sandpaper"), "");
  EXPECT_EQ(said_of_levels("levels vibration {\n  a 0.5\n  b 0.51\n}\n", "sandpaper"), "") << "there is no threshold";
}

TEST(CloseLevels, NoneAreShipped) {
  const auto common = common_modules();
  std::set<SourceId> files;
  for (const Levels* each : common->declarations.levels()) files.insert(each->span.source);
  EXPECT_FALSE(files.empty());
  for (const char* device : {"sandpaper", "falcon"}) {
    Diagnostics diagnostics;
    for (const SourceId file : files) check_levels(common->declarations, file, device, diagnostics);
    for (const auto& each : diagnostics.all()) ADD_FAILURE() << device << ": " << each.message;
  }
}

}  // namespace
}  // namespace wale::compare_levels_test
