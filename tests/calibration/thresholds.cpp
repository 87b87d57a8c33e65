// Discrimination thresholds converted to d' = 1, and the rules of texture classes, against their publications.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "compiler/declarations/discrimination.hpp"
#include "tests/calibration/declared.hpp"

namespace wale {
namespace {

using calibrating::Declared;

TEST(Sensitivity, IsThatOfTheTables) {
  // Two-alternative forced choice: p = Phi(d' / sqrt 2), Macmillan and Creelman, Detection Theory, 2nd ed. (2005),
  // ch. 7.
  EXPECT_NEAR(sensitivity(Task::forced_choice, 0.707), 0.77, 0.005);
  EXPECT_NEAR(sensitivity(Task::forced_choice, 0.75), 0.95, 0.005);
  EXPECT_NEAR(sensitivity(Task::forced_choice, 0.794), 1.16, 0.005);
  EXPECT_NEAR(sensitivity(Task::forced_choice, 0.84), 1.41, 0.005);
  EXPECT_NEAR(sensitivity(Task::yes_no, 0.75), 2 * 0.6744897501960817, 1e-12);
  // One interval, one of two: p = Phi(d' / 2) for an unbiased observer, the same, ch. 1. Phi(0.5) = 0.6914624612740131.
  EXPECT_NEAR(sensitivity(Task::one_interval, 0.6914624612740131), 1, 1e-12);
  EXPECT_NEAR(0.07 / sensitivity(Task::one_interval, 0.75), 0.052, 0.0005);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-12);
  EXPECT_NEAR(normal_quantile(0.5), 0, 1e-12);
}

/// z of the criteria 71, 75 and 84 % correct. 75 % holds where a publication states none.
constexpr double z71 = 0.5533847195556727, z75 = 0.6744897501960817, z84 = 0.9944578832097531;
/// Two intervals at d' = 1 have sqrt 2 times this z; Pang's one interval has 2 z(69.146246 %) = 1.
constexpr double one_apart = 0.7071067811865476;

/// The threshold that is used on a device for sizes near this one, in SI units.
const Threshold* chosen(const Declared& declared, const char* cue, const char* device, double size) {
  return Discrimination(declared.declarations(), cue, device, 0).threshold(size, 1.01 * size);
}

TEST(ShippedThresholds, AreNormalisedToOne) {
  const std::multimap<std::string, std::pair<double, double>> expected = {
      {"Tan 1992, after Minsky 1995, section 5.4.2", {0.10, z75}},
      {"Pang, Tan and Durlach 1991, abstract", {0.07, one_apart}},
      {"Jones, Hunter and Lafontaine 1997, abstract", {0.19, z71}},
      {"Jones and Hunter 1993, abstract", {0.34, z84}},
      {"Beauregard and Srinivasan 1997, recalled", {0.13, z75}},
      {"Beauregard and Srinivasan 1997, recalled", {0.21, z75}},
      {"Tan et al. 1995, abstract", {0.22, z75}},
      {"Jones and Hunter 1990, recalled", {0.23, z84}},
      {"Bergmann Tiest and Kappers 2009, abstract", {0.45, z75}},
      {"Fehlberg et al. 2022, abstract", {0.20, z75}},
      {"Saleem, Yilmaz and Basdogan 2020, abstract", {0.14, z75}},
      {"Kocsis et al. 2013, abstract", {0.098, z75}},
      {"Kocsis et al. 2013, abstract", {0.05, z75}},
      {"Kocsis et al. 2013, abstract", {0.076, z75}},
      {"Skinner et al. 2013, abstract", {0.11, z75}},
      {"an estimate of this project, after Tan 1992", {0.22, z75}},
      {"an estimate of this project, after Tan 1992", {0.56, z75}},
  };
  const Declared declared("");
  std::size_t found = 0;
  for (const Threshold* threshold : declared.declarations().thresholds()) {
    if (threshold->recognised > 0) continue;
    bool known = false;
    const auto [first, last] = expected.equal_range(threshold->source);
    for (auto each = first; each != last; ++each)
      known =
          known || (std::abs(each->second.first - threshold->published) < 1e-12 &&
                    std::abs(threshold->weber - each->second.first / (std::sqrt(2.0) * each->second.second)) < 1e-6);
    EXPECT_TRUE(known) << threshold->source << " " << threshold->published << " " << threshold->weber;
    EXPECT_EQ(threshold->evidence == Evidence::recalled, threshold->source.ends_with("recalled"));
    ++found;
  }
  EXPECT_EQ(found, expected.size());
}

/// Cholewiak, Tan and Ebert 2008: 1.46 and 1.54 bits are 2^1.46 and 2^1.54 levels.
TEST(ShippedThresholds, NumbersOfRecognisedLevelsTellNothingApart) {
  const Declared declared("");
  const Threshold* stiffness = recognition(declared.declarations(), "stiffness", "sandpaper");
  const Threshold* force = recognition(declared.declarations(), "amplitude", "sandpaper");
  ASSERT_TRUE(stiffness && force);
  EXPECT_NEAR(stiffness->recognised, std::exp2(1.46), 0.05);
  EXPECT_NEAR(force->recognised, std::exp2(1.54), 0.05);
  EXPECT_EQ(recognition(declared.declarations(), "mass", "sandpaper"), nullptr);
  for (const double size : {100.0, 1000.0})
    EXPECT_EQ(chosen(declared, "stiffness", "sandpaper", size)->recognised, 0) << "it has no fraction";
  const Declared own(
      "threshold mass {\n  quantity mass\n  task identification\n  recognised 4\n"
      "  evidence slope estimated, handle measured\n  on sandpaper\n  source \"a test\"\n}\n");
  EXPECT_EQ(recognition(own.declarations(), "mass", "sandpaper")->recognised, 4);
}

TEST(ShippedThresholds, OneSensitivityAtTwoCriteria) {
  // 19 % at 71 % (Jones, Hunter and Lafontaine 1997) and 34 % at 84 % correct describe the same sensitivity.
  EXPECT_NEAR(0.19 / (std::sqrt(2.0) * z71), 0.34 / (std::sqrt(2.0) * z84), 0.002);
  const Declared declared("");
  const Threshold* counts = chosen(declared, "viscosity", "sandpaper", 10);
  ASSERT_TRUE(counts);
  EXPECT_NEAR(counts->weber, 0.243, 0.002);
  EXPECT_EQ(chosen(declared, "orientation", "sandpaper", 1), nullptr);
}

TEST(Threshold, CountsRatiosAndSmallDifferencesByTheFloor) {
  Threshold threshold;
  threshold.weber = 0.25;
  EXPECT_NEAR(threshold.distance(1, 1.25), 1, 1e-12);
  EXPECT_NEAR(threshold.distance(1.25 * 1.25 * 1.25, 1), 3, 1e-12);
  EXPECT_EQ(threshold.distance(2, 2), 0);
  EXPECT_TRUE(std::isinf(threshold.distance(0, 1)));
  threshold.floor = 0.5;
  EXPECT_NEAR(threshold.distance(0, 1), 2, 1e-12);
  EXPECT_NEAR(threshold.distance(0.1, 0.2), 0.2, 1e-12) << "both sizes are below the floor";
  EXPECT_NEAR(threshold.distance(10, 12.5), 1, 1e-12) << "the fraction is above the floor";
}

/// The conditions of a measurement: sizes of the cue, and other quantities by their names.
TEST(Threshold, IsExtrapolatedBeyondEachOfItsConditions) {
  const Declared declared(
      "threshold push {\n  quantity force\n  weber 0.1\n  task one_interval\n  criterion 75 %\n"
      "  valid push 2 N .. 10 N, assumed speed 20 mm/s .. 200 mm/s, period below 5 mm\n"
      "  evidence slope estimated, handle estimated\n  on fingers\n  source \"a test\"\n}\n");
  const Threshold& push = *Discrimination(declared.declarations(), "push", "sandpaper", 0).threshold(3, 4);
  using Strings = std::vector<std::string>;
  EXPECT_EQ(push.unmet(3, 10, {}, {}), Strings{});
  EXPECT_EQ(push.unmet(3, -4, {}, {}), Strings{}) << "the sign does not count";
  EXPECT_EQ(push.unmet(0, 4, {}, {}), Strings{}) << "a stimulus without the cue is no size";
  EXPECT_EQ(push.unmet(1.9, 4, {}, {}), Strings{"push 2 N .. 10 N"});
  EXPECT_EQ(push.unmet(4, 11, {}, {}), Strings{"push 2 N .. 10 N"});
  EXPECT_EQ(push.unmet(3, 4, {{"speed", 0.1}}, {{"speed", 0.2}}), Strings{});
  EXPECT_EQ(push.unmet(3, 4, {{"speed", 0.1}}, {{"speed", 0.3}}), Strings{"speed 20 mm/s .. 200 mm/s"});
  EXPECT_EQ(push.unmet(1, 4, {{"period", 0.005}}, {}), (Strings{"push 2 N .. 10 N", "period below 5 mm"}));
  EXPECT_EQ(push.unmet(3, 4, {{"period", 0.0049}}, {}), Strings{});
  ASSERT_EQ(push.conditions.size(), 2u);
  EXPECT_TRUE(push.conditions[0].assumed);
  EXPECT_FALSE(push.conditions[1].assumed || push.valid->assumed);
}

TEST(ShippedThresholds, OneOfTheSameDeviceComesFirst) {
  const Declared declared(
      "threshold viscosity {\n  quantity viscosity\n  weber 0.5\n  task yes_no\n  criterion 75 %\n"
      "  evidence slope estimated, handle measured\n  on sandpaper\n  source \"a test\"\n}\n");
  EXPECT_EQ(chosen(declared, "viscosity", "sandpaper", 10)->source, "a test");
  EXPECT_NEAR(chosen(declared, "viscosity", "sandpaper", 10)->weber, 0.5 / (2 * z75), 1e-12);
  EXPECT_NE(chosen(declared, "viscosity", "falcon", 10)->source, "a test");
}

/// The threshold for a size is one whose publication compared such sizes; among these the one with the best evidence;
/// among these the one with the smallest fraction.
TEST(ShippedThresholds, TheOneThatComparedSuchSizesIsUsed) {
  const Declared declared("");
  // Jones and Hunter 1993 compared 2 to 1024 N s/m and found 24.2 % at d' = 1. Jones, Hunter and Lafontaine 1997
  // compared 4 to 512 N s/m and found 24.3 %. The figures of Beauregard and Srinivasan are recalled, without a range.
  EXPECT_EQ(chosen(declared, "viscosity", "sandpaper", 10)->source, "Jones and Hunter 1993, abstract");
  EXPECT_EQ(chosen(declared, "viscosity", "sandpaper", 3)->source, "Jones and Hunter 1993, abstract");
  EXPECT_EQ(chosen(declared, "viscosity", "sandpaper", 1)->source, "Beauregard and Srinivasan 1997, recalled");
  const Discrimination people(declared.declarations(), "viscosity", "sandpaper", 0.25);
  EXPECT_EQ(people.threshold(0, 10)->source, "Jones and Hunter 1993, abstract") << "0 is not a size that was compared";
  EXPECT_EQ(people.evidence(*people.threshold(3, 10)), Evidence::transferred);
  EXPECT_NEAR(*people.distance(10, 12.5), std::log(1.25) / std::log1p(0.34 / (std::sqrt(2.0) * z84)), 1e-9);
  // The floor is 0.1 N, and 1 N s/m gives 0.25 N, so the floor of a viscosity is 0.4 N s/m.
  EXPECT_NEAR(people.floor(*people.threshold(3, 10)), 0.4, 1e-12);
  EXPECT_NEAR(*people.distance(0, 6), 15, 1e-9);
  EXPECT_NEAR(*people.distance(-3, 3), 15, 1e-9) << "figures of opposite sign have no ratio";
  EXPECT_EQ(people.distance(5, 5), 0.0);
  // A cue that is no force has no floor, and there is no ratio to 0.
  const Discrimination periods(declared.declarations(), "period", "sandpaper", 0);
  EXPECT_FALSE(periods.distance(0, 1e-3));
  EXPECT_FALSE(Discrimination(declared.declarations(), "orientation", "sandpaper", 0).distance(1, 2));
}

const Rule& rule(const Declared& declared, const std::string& name) {
  for (const Rule* each : declared.declarations().rules())
    if (each->name == name) return *each;
  throw std::runtime_error("no rule " + name);
}

/// Minsky 1995, section 6.3.8: "rolling hills (A3P100, A3P50, sometimes A3P25, and A1P7) and moguls (A19P100 and
/// A10P100). The remaining stimuli fall into a group which can be identified as flat textured surfaces." a*n* is 10 n
/// program units, but a1 10, a3 30, a10 100, a19 190 (table 8).
TEST(TextureClass, GroupsTheTwelveStimuliAsTheSubjectsDid) {
  const Declared declared("");
  const Rule& classes = rule(declared, "texture_class");
  const std::map<std::pair<int, int>, std::string> grouped = {
      {{10, 7}, "rolling hills"},  {{30, 7}, "flat texture"},    {{30, 12}, "flat texture"},
      {{30, 50}, "rolling hills"}, {{30, 100}, "rolling hills"}, {{100, 7}, "flat texture"},
      {{100, 12}, "flat texture"}, {{100, 25}, "flat texture"},  {{100, 50}, "flat texture"},
      {{100, 100}, "moguls"},      {{190, 100}, "moguls"}};
  for (const auto& [stimulus, group] : grouped) {
    const auto* found =
        classes.first({{"amplitude", stimulus.first * 10.0 / 512}, {"period", stimulus.second * 1e-4}}, "grating");
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->label, group) << stimulus.first << " pu at " << stimulus.second / 10.0 << " mm";
  }
}

TEST(SizeClass, HasItsBoundaryAtTwoAndAHalfMillimetres) {
  const Declared declared("");
  const Rule& sizes = rule(declared, "size_class");
  const auto at = [&](double period) { return sizes.first({{"period", period}}, "")->label; };
  EXPECT_EQ(at(0.0007), "texture");
  EXPECT_EQ(at(0.0012), "texture");
  EXPECT_EQ(at(0.0025), "transitional");
  EXPECT_EQ(at(0.0037), "transitional");
  EXPECT_EQ(at(0.0050), "separate features");
  EXPECT_EQ(at(0.010), "separate features");
}

TEST(TextureConfidence, OfTheThesisNonTextures) {
  const Declared declared("");
  const Rule& rules = rule(declared, "texture_confidence");
  const auto kind = [&](const std::string& name, double units = 0) {
    return rules.first({{"amplitude", units * 10 / 512}, {"period", name == "noise" ? 0.0006 : 0.03}}, name);
  };
  EXPECT_DOUBLE_EQ(kind("slick")->confidence.value(), 0.11);
  EXPECT_DOUBLE_EQ(kind("slick")->spread.value(), 0.18);
  EXPECT_DOUBLE_EQ(kind("viscous")->confidence.value(), 0.23);
  // Section 4.5: the mean over the non-textures is 26, and with the noises 38.
  double without = 0, with = 0;
  for (const std::string name : {"slick", "spring", "nothing", "bump", "viscous"})
    without += kind(name)->confidence.value() / 7;
  for (const double units : {30, 90}) without += kind("stripes", units)->confidence.value() / 7;
  with = 0.7 * without;
  for (const double units : {20, 35, 50}) with += kind("noise", units)->confidence.value() / 10;
  EXPECT_NEAR(without, 0.26, 0.005);
  EXPECT_NEAR(with, 0.38, 0.005);
  const auto grating = [&](double units, double period) -> std::string {
    const auto* found = rules.first({{"amplitude", units * 10 / 512}, {"period", period}}, "grating");
    return found ? found->label : "";
  };
  EXPECT_EQ(grating(20, 0.0095), "low");
  EXPECT_EQ(grating(40, 0.0095), "high");
  EXPECT_EQ(grating(20, 0.005), "high");
  for (const double units : {20, 40})
    for (const double period : {0.0005, 0.012}) EXPECT_EQ(grating(units, period), "") << "chapter 5 had none of these";
  EXPECT_EQ(rules.first({{"amplitude", 1}, {"period", 0.01}}, "irregular"), nullptr)
      << "nobody was asked of photographs";
}

}  // namespace
}  // namespace wale
