// wale compare: differences in just noticeable differences, against the definition computed by hand.

#include "compiler/compare/compare.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "compiler/modules/load_modules.hpp"
#include "tests/standard/standard.hpp"

namespace wale::compare_test {
namespace {

using standard::material;

const Declarations& declarations() {
  static const auto common = common_modules();
  return common->declarations;
}

Cues cues(const std::string& statements) {
  return cues_of(Bank(material("material m { physical {\n" + statements + "\n} }", "m")), declarations());
}

/// d' of three correct answers of four in a choice of two: sqrt(2) z(0.75).
constexpr double three_of_four = 0.67448975;  // z(0.75), from a table of the normal distribution
const double d_prime = std::sqrt(2.0) * three_of_four;

Comparison compare(const Cues& a, const Cues& b) { return Comparer(declarations(), a.device).compare(a, b); }

const CueDifference* cue(const Comparison& comparison, CueKind kind) {
  for (const CueDifference& each : comparison.cues)
    if (each.kind == kind) return &each;
  return nullptr;
}

TEST(Compare, AmplitudesDifferByTheirRatioOverTheWeberFraction) {
  Cues a{"a", "sandpaper", {}}, b = a;
  a[CueKind::amplitude] = 3, b[CueKind::amplitude] = 4;
  const Comparison comparison = compare(a, b);
  const CueDifference* amplitude = cue(comparison, CueKind::amplitude);
  ASSERT_TRUE(amplitude && amplitude->noticeable && amplitude->threshold);
  // Pang, Tan and Durlach 1991: 0.07 for forces of 2.5 to 10 N, at an assumed d' = 1.
  EXPECT_NEAR(*amplitude->noticeable, std::log(4.0 / 3) / std::log1p(0.07), 1e-3);
  EXPECT_EQ(amplitude->evidence, Evidence::transferred);
  EXPECT_TRUE(amplitude->outside.empty());
  EXPECT_EQ(comparison.verdict, Verdict::apart);
  EXPECT_EQ(comparison.plainest(), amplitude);
}

TEST(Compare, WaveformsOfOnePeriodAndSizeAreToldApart) {
  const Cues sine = cues("force = vector(1 N * sin(2 pi * x / 4 mm), 0 N)");
  const Cues square = cues("force = vector(if fract(x / 4 mm) < 0.5 then 1 N else -1 N, 0 N)");
  const Cues saw = cues("force = vector(2 N * (fract(x / 4 mm) - 0.5), 0 N)");
  const Cues triangle = cues("force = vector(4 N * abs(fract(x / 4 mm) - 0.5) - 1 N, 0 N)");
  EXPECT_NEAR(sine[CueKind::crest].value_or(0), std::numbers::sqrt2, 0.03);
  EXPECT_NEAR(triangle[CueKind::crest].value_or(0), std::sqrt(3.0), 0.04);
  EXPECT_EQ(compare(sine, square).verdict, Verdict::apart);
  EXPECT_EQ(compare(saw, triangle).verdict, Verdict::apart) << "they have the same crest";
  // The estimates are made so that these two are just told apart: d' is 0.95 of their criterion.
  const Comparison just = compare(sine, triangle);
  EXPECT_NEAR(cue(just, CueKind::crest)->noticeable.value_or(0), 0.95, 0.15);
  EXPECT_NEAR(cue(just, CueKind::abruptness)->noticeable.value_or(0), 0.95, 0.15);
}

TEST(Compare, DampingBeyondAFaceIsToldApartWithoutAWall) {
  const Cues soft = cues("force = crisp(2 N s/m)"), hard = cues("force = crisp(8 N s/m)");
  // Moving in at 0.25 m/s.
  EXPECT_NEAR(soft[CueKind::other_force].value_or(0), 0.5, 0.01);
  EXPECT_NEAR(hard[CueKind::other_force].value_or(0), 2, 0.04);
  EXPECT_EQ(compare(soft, hard).verdict, Verdict::apart);
}

TEST(Compare, BeyondWhatWasComparedAThresholdIsExtrapolated) {
  Cues a{"a", "sandpaper", {}}, b{"b", "sandpaper", {}};
  a[CueKind::amplitude] = 3, b[CueKind::amplitude] = 4, a[CueKind::mass] = 1, b[CueKind::mass] = 2;
  const auto text = [&] { return comparison_text(ComparisonMatrix({a, b}, declarations())); };
  const auto json = [&] {
    return nlohmann::json::parse(comparison_json(ComparisonMatrix({a, b}, declarations())))["pairs"][0]["cues"];
  };
  EXPECT_NE(text().find("(0.07 at d' = 1, transferred, criterion assumed: Pang"), std::string::npos) << text();
  EXPECT_EQ(json()["amplitude"]["evidence"], "transferred");
  EXPECT_EQ(json()["amplitude"]["valid"][0], "amplitude 2.5 N .. 10 N");
  EXPECT_TRUE(json()["amplitude"]["outside"].empty());
  EXPECT_EQ(json()["amplitude"]["assumed"], nlohmann::json({"criterion"}));
  EXPECT_TRUE(json()["mass"]["valid"].is_null()) << "its publication states no range";
  EXPECT_NE(text().find("range not stated"), std::string::npos) << text();
  b[CueKind::amplitude] = 2.4;
  EXPECT_NE(text().find("(0.07 at d' = 1, extrapolated from amplitude 2.5 N .. 10 N, criterion assumed: Pang"),
            std::string::npos)
      << text();
  EXPECT_EQ(json()["amplitude"]["evidence"], "extrapolated");
  EXPECT_EQ(json()["amplitude"]["outside"], nlohmann::json({"amplitude 2.5 N .. 10 N"}));
}

TEST(Compare, DifferentFiguresAreWrittenWithEnoughDigits) {
  Cues a{"a", "sandpaper", {}}, b{"b", "sandpaper", {}};
  a[CueKind::orientation] = 0.6 * std::numbers::pi / 180, b[CueKind::orientation] = 1.4 * std::numbers::pi / 180;
  a[CueKind::amplitude] = 1.001, b[CueKind::amplitude] = 1.0049;
  a[CueKind::period] = b[CueKind::period] = 0.0025;
  const std::string text = comparison_text(ComparisonMatrix({a, b}, declarations()));
  for (const char* part : {" 0.6 degrees ", " 1.4 degrees ", " 1.001 N ", " 1.005 N ", " 2.5 mm "})
    EXPECT_NE(text.find(part), std::string::npos) << part << '\n' << text;
  b[CueKind::orientation] = std::numbers::pi / 4, b[CueKind::amplitude] = 2;
  const std::string far = comparison_text(ComparisonMatrix({a, b}, declarations()));
  for (const char* part : {" 1 degree ", " 45 degrees ", " 1 N ", " 2 N "})
    EXPECT_NE(far.find(part), std::string::npos) << part << '\n' << far;
}

TEST(Compare, SmallForcesAreComparedWithTheFloorOfTheThreshold) {
  Cues a{"a", "sandpaper", {}}, b = a;
  a[CueKind::amplitude] = 0.02, b[CueKind::amplitude] = 0.05;
  const Comparison comparison = compare(a, b);
  // 0.03 N of the 0.1 N that Tan 1992 is given as a floor, at three of four.
  EXPECT_NEAR(*comparison.cues.front().noticeable, 0.03 / (0.1 / d_prime), 0.03 / (0.1 / d_prime) * 0.5);
  EXPECT_EQ(comparison.verdict, Verdict::alike);
}

TEST(Compare, WhoSaysHowSmallADifferenceIsNoticedIsNamed) {
  Cues a{"a", "sandpaper", {}}, b = a;
  a[CueKind::amplitude] = 0.5, b[CueKind::amplitude] = 0.58;
  const Comparison small = compare(a, b);
  const CueDifference* amplitude = cue(small, CueKind::amplitude);
  ASSERT_TRUE(amplitude && amplitude->noticeable && amplitude->floor);
  // 0.08 N over the floor of tan1992.wale, 0.1 N; by Pang's 7 % it would be 2.2.
  EXPECT_NEAR(*amplitude->noticeable, 0.08 / amplitude->least, 1e-6);
  EXPECT_NEAR(amplitude->least, 0.1, 1e-6);
  EXPECT_NE(amplitude->floor->source.find("Tan 1992"), std::string::npos);
  EXPECT_NE(floor_words(*amplitude->floor, amplitude->least, "N").find("assumed: Tan 1992"), std::string::npos);
  a[CueKind::amplitude] = 3, b[CueKind::amplitude] = 4;
  const Comparison large = compare(a, b);
  ASSERT_TRUE(cue(large, CueKind::amplitude));
  EXPECT_EQ(cue(large, CueKind::amplitude)->floor, nullptr);
}

/// What only one number tells, how hard it pushes, may be of any course: that two are as hard says nothing.
TEST(Compare, OtherForcesOfTheSameSizeAreNotKnownToBeAlike) {
  const auto of = [](const std::string& force) { return cues("active 3 W\nforce = " + force); };
  const auto held = [&](const std::string& force) { return of("if button then " + force + " else vector(0 N, 0 N)"); };
  const auto verdict = [](const Cues& a, const Cues& b) { return compare(a, b).verdict; };
  const Cues fine = held("vector(1 N * sin(2 * pi * x / 3 mm), 0 N)");
  EXPECT_EQ(verdict(fine, held("vector(1 N * sin(2 * pi * x / 9 mm), 0 N)")), Verdict::unknown);
  EXPECT_EQ(verdict(fine, held("vector(0 N, 1 N * sin(2 * pi * y / 3 mm))")), Verdict::unknown);
  EXPECT_EQ(verdict(held("vector(-50 N/m * x, 0 N)"), held("vector(0 N, -50 N/m * y)")), Verdict::unknown);
  EXPECT_EQ(verdict(of("vector(1 N * sin(2 * pi * x / 4 mm), 0 N) * smoothstep(time / 2 s)"),
                    of("vector(1 N * sin(2 * pi * x / 9 mm), 0 N) * smoothstep(time / 2 s)")),
            Verdict::unknown);
  // The same program is the same, whatever it is called; and a push is known by its direction.
  EXPECT_EQ(verdict(fine, held("vector(1 N * sin(2 * pi * x / 3 mm), 0 N)")), Verdict::alike);
  EXPECT_EQ(verdict(held("vector(1 N, 0 N)"), held("vector(1 N, 0.01 N)")), Verdict::alike);
}

TEST(Compare, ACueThatOneMaterialLacksIsComparedByForce) {
  Cues a{"a", "sandpaper", {}}, b = a;
  a[CueKind::stiffness] = 100;
  const Comparison comparison = compare(a, b);
  ASSERT_TRUE(comparison.cues.front().noticeable);
  EXPECT_GT(*comparison.cues.front().noticeable, 20);  // 4 N at 40 mm against nothing
  EXPECT_EQ(comparison.verdict, Verdict::apart);
}

TEST(Compare, ThePublishedThresholdHoldsForAMissingCue) {
  Cues a{"a", "sandpaper", {}}, b = a;
  a[CueKind::viscosity] = 6;
  const Comparison comparison = compare(a, b);
  ASSERT_TRUE(comparison.cues.front().threshold);
  // Jones and Hunter compared 2 to 1024 N s/m. Their figure is used, and not one that is only recalled.
  EXPECT_EQ(comparison.cues.front().threshold->evidence, Evidence::published);
}

// What a unit of a size pushes with, by the hand `normal` and an assumed depth (schema/percepts.wale).
TEST(Compare, NoCueHasAThresholdOfAnotherUnit) {
  const std::map<std::string, std::string> dimensions = {
      {"N", "force"}, {"m", "length"},  {"N/m", "stiffness"}, {"N s/m", "viscosity"},
      {"kg", "mass"}, {"Hz", "frequency"}};
  const auto newtons = [](const CueFacts& facts) {
    const std::string unit = facts.unit;
    if (unit == "N/m") return std::string(facts.threshold) == "wall_stiffness" ? 0.005 : 0.04;
    return unit == "N s/m" ? 0.25 : unit == "kg" ? 1.6 : unit == "N" ? 1 : 0;
  };
  std::size_t thresholds = 0;
  for (const CueFacts& facts : cue_table()) {
    const auto look_at = [&](const Declarations& known) {
      for (const Threshold& each : known.own_thresholds) {
        if (each.cue != facts.threshold) continue;
        ++thresholds;
        const auto name = dimensions.find(facts.unit);
        EXPECT_EQ(each.dimension, name == dimensions.end() ? Dimension{} : declarations().dimension(name->second))
            << facts.name << ", by " << each.source;
      }
    };
    look_at(declarations());
    if (declarations().common) look_at(*declarations().common);
    if (!facts.exerts || !*facts.threshold) continue;
    ASSERT_GT(newtons(facts), 0) << facts.name << " exerts a force, and its unit has none";
    // 1 N against nothing, with 0.1 N as the smallest force that is noticed at an assumed 75 %.
    Cues none{"none", "sandpaper", {}}, some = none;
    some[facts.kind] = 1 / newtons(facts);
    const Comparison comparison = compare(none, some);
    const CueDifference* found = cue(comparison, facts.kind);
    ASSERT_TRUE(found && found->noticeable) << facts.name;
    EXPECT_NEAR(*found->noticeable, 10, 1) << facts.name;
  }
  EXPECT_GT(thresholds, 20u);
}

TEST(Compare, ASecondWallIsComparedAsAWall) {
  const Cues one = cues("force = firm(600 N/m, 15 mm)");
  const Cues two = cues("force = firm(600 N/m, 15 mm) + vector(-max(0 N, 200 N/m * (x - 10 mm)), 0 N)");
  const Comparison comparison = compare(one, two);
  const CueDifference* found = cue(comparison, CueKind::more_walls);
  ASSERT_TRUE(found && found->noticeable);
  // 200 N/m are 1 N in 5 mm.
  EXPECT_NEAR(*found->noticeable, 10, 1);
  const std::string text = comparison_text(ComparisonMatrix({one, two}, declarations()));
  EXPECT_NE(text.find("other walls          none            200 N/m"), std::string::npos) << text;
  EXPECT_EQ(text.find(" 0.1 N/m"), std::string::npos) << text;
}

TEST(Compare, AVibrationAgainstNoneIsAForceThatIsFelt) {
  const std::string strong = "active 0.8 W\nforce = vector(0.6 N * sin(2 pi * phase(30 Hz)), 0 N)";
  const Cues shaking = cues(strong), still = cues("force = firm(600 N/m, 15 mm)");
  const Comparison against_none = compare(shaking, still);
  ASSERT_TRUE(cue(against_none, CueKind::vibration)->noticeable);
  EXPECT_NEAR(*cue(against_none, CueKind::vibration)->noticeable, 6, 1);
  // Nobody has published by how much two vibrations must differ: a little is neither alike nor apart, and it says why.
  Cues hardly = shaking;
  hardly[CueKind::vibration] = 0.62;
  const Comparison little = compare(shaking, hardly);
  EXPECT_FALSE(cue(little, CueKind::vibration)->noticeable);
  EXPECT_NE(cue(little, CueKind::vibration)->why_unknown, "");
  EXPECT_EQ(little.verdict, Verdict::unknown);
  const std::string text = comparison_text(ComparisonMatrix({shaking, hardly}, declarations()));
  EXPECT_NE(text.find("unknown  (no threshold of its own"), std::string::npos) << text;
}

Cues sum_of_sines(const std::vector<std::pair<double, double>>& newtons_and_millimetres) {
  std::string force;
  for (const auto& [newton, period] : newtons_and_millimetres)
    force += (force.empty() ? "" : " + ") + std::to_string(newton) + " N * sin(2 pi * x / " + std::to_string(period) +
             " mm)";
  return cues("force = vector(" + force + ", 0 N)");
}

TEST(Compare, SumsOfWavesAreComparedWaveByWave) {
  const auto apart = [](const Cues& a, const Cues& b, CueKind kind) {
    const Comparison comparison = compare(a, b);
    const CueDifference* found = cue(comparison, kind);
    return found && found->noticeable ? *found->noticeable : -1;
  };
  // Weber's fraction of periods at d' = 1.
  const auto periods = [](double ratio) { return std::log(ratio) / std::log1p(0.14 / d_prime); };
  const Cues sum = sum_of_sines({{1, 3}, {1, 5}}), near = sum_of_sines({{1, 3}, {1, 5.05}});
  const Cues pure = sum_of_sines({{1, 15}});
  EXPECT_NEAR(*sum[CueKind::period], 0.015, 1e-4) << "it has the period after which it repeats";
  EXPECT_NEAR(apart(sum, near, CueKind::period), periods(5.05 / 5), 0.03);
  EXPECT_LT(apart(sum, near, CueKind::abruptness), 0.3);
  EXPECT_EQ(apart(sum, near, CueKind::regularity), 0);
  EXPECT_EQ(apart(sum, near, CueKind::other_waves), 0) << "the amplitude tells it";
  EXPECT_EQ(compare(sum, near).verdict, Verdict::alike)
      << comparison_text(ComparisonMatrix({sum, near}, declarations()));
  EXPECT_NEAR(apart(sum, pure, CueKind::period), periods(15.0 / 5), 0.2);
  EXPECT_NEAR(apart(sum, sum_of_sines({{1, 4}, {1, 5}}), CueKind::period), periods(4.0 / 3), 0.1);
  EXPECT_NEAR(apart(sum_of_sines({{1, 3}}), sum, CueKind::period), 0, 0.02) << "and its other wave tells it";
  EXPECT_NEAR(apart(pure, sum_of_sines({{1, 12}}), CueKind::period), periods(15.0 / 12), 0.1);
  // A weak wave changes the period after which all repeats, and nobody feels that.
  EXPECT_NEAR(apart(sum_of_sines({{1, 3}}), sum_of_sines({{1, 3}, {0.2, 5}}), CueKind::period), 0, 0.02);
  EXPECT_EQ(compare(sum, sum).verdict, Verdict::alike);
  // A search leaves out none of what is near.
  const Comparer comparer(declarations(), "sandpaper");
  for (const Cues& each : {sum, near, pure, sum_of_sines({{1, 3}}), sum_of_sines({{1, 3}, {0.2, 5}})})
    for (const Cues& other : {sum, near, pure, sum_of_sines({{1, 5}}), sum_of_sines({{1, 3}})})
      for (const CueKind kind : {CueKind::period, CueKind::abruptness, CueKind::regularity}) {
        const double most = apart(each, other, kind);
        if (most < 0) continue;
        const SizeRange range = comparer.within(kind, each, most + 1e-3);
        EXPECT_TRUE(range.holds(*other[kind]))
            << cue_table()[static_cast<std::size_t>(kind)].name << ' ' << *other[kind];
      }
}

TEST(Compare, ACueWithoutAThresholdIsUnknownAndNeverTheSame) {
  Cues a{"a", "sandpaper", {}}, b = a;
  a[CueKind::amplitude] = b[CueKind::amplitude] = 2;
  a[CueKind::regularity] = 0.9, b[CueKind::regularity] = 0.2;
  Comparison comparison = compare(a, b);
  EXPECT_EQ(comparison.verdict, Verdict::unknown);
  EXPECT_FALSE(cue(comparison, CueKind::regularity)->noticeable);
  b[CueKind::regularity] = 0.9;
  EXPECT_EQ(compare(a, b).verdict, Verdict::alike);
  // An unknown cue does not matter where another cue tells them apart.
  b[CueKind::regularity] = 0.2, b[CueKind::amplitude] = 4;
  EXPECT_EQ(compare(a, b).verdict, Verdict::apart);
}

TEST(Compare, OrientationsAreTheSameAfterHalfATurn) {
  Cues a{"a", "sandpaper", {}}, b = a;
  a[CueKind::orientation] = 0.0, b[CueKind::orientation] = 3.14159265358979;
  EXPECT_EQ(compare(a, b).verdict, Verdict::alike);
  b[CueKind::orientation] = 1.0;
  EXPECT_EQ(compare(a, b).verdict, Verdict::unknown);
}

TEST(Compare, CuesAreTheFiguresOfTheMaterial) {
  const Cues grating = cues("force = vector(1.2 N * sin(2 * pi * x / 2.5 mm), 0 N)");
  EXPECT_NEAR(*grating[CueKind::amplitude], 1.2, 0.05);
  EXPECT_NEAR(*grating[CueKind::period], 2.5e-3, 0.05e-3);
  EXPECT_NEAR(std::sin(*grating[CueKind::orientation]), 0, 0.03);
  EXPECT_FALSE(grating[CueKind::stiffness] || grating[CueKind::friction] || grating[CueKind::wall_stiffness]);
  const Cues spring = cues("force = -120 N/m * hand");
  EXPECT_NEAR(*spring[CueKind::stiffness], 120, 1);
  EXPECT_FALSE(spring[CueKind::amplitude] || spring[CueKind::period]);
  const Cues oil = cues("force = -7 N s/m * velocity");
  EXPECT_NEAR(*oil[CueKind::viscosity], 7, 0.05);
  EXPECT_FALSE(oil[CueKind::amplitude] || oil[CueKind::stiffness] || oil[CueKind::mass]);
}

TEST(Compare, AFieldThatNoOtherCueReadsIsComparedByItsForce) {
  // 1 N (p / 40 mm)^1.5 along each axis, like the thesis's Bowl, on a patch of 200 mm.
  const std::string bowl = "let u = x / 40 mm\nlet v = y / 40 mm\npatch 200 mm, 200 mm\nforce = ";
  const std::string outward = "1 N * vector(u * sqrt(abs(u)), v * sqrt(abs(v)))";
  const Cues nothing = cues("force = vector(0 N, 0 N)"), dish = cues(bowl + "-" + outward), dome = cues(bowl + outward);
  ASSERT_TRUE(dish[CueKind::other_force] && dome[CueKind::other_force]);
  // The largest force is at the corners of the patch without its rim of 5 mm; the 99th percentile is a little lower.
  const double corner = std::pow((100.0 - 5) / 40, 1.5) * std::sqrt(2.0);
  EXPECT_GT(*dish[CueKind::other_force], 0.85 * corner);
  EXPECT_LT(*dish[CueKind::other_force], corner);
  EXPECT_NEAR(*dome[CueKind::other_force], -*dish[CueKind::other_force], 1e-6);
  EXPECT_FALSE(nothing[CueKind::other_force]);
  EXPECT_EQ(compare(nothing, dish).verdict, Verdict::apart);
  EXPECT_EQ(compare(dish, dome).verdict, Verdict::apart);
  EXPECT_EQ(compare(dish, dish).verdict, Verdict::alike);
  const Cues constant = cues("force = vector(2 N, 0 N)");
  EXPECT_NEAR(*constant[CueKind::push_x], 2, 1e-6);
  EXPECT_FALSE(constant[CueKind::push_y] || constant[CueKind::other_force]);
  EXPECT_EQ(compare(nothing, constant).verdict, Verdict::apart);
  // 4 N s/m resist along x and push along y, so the mean over all directions is 0.
  const Cues askew = cues("active 0.1 W\nforce = 4 N s/m * vector(-velocity.x, velocity.y)");
  EXPECT_NEAR(askew[CueKind::viscosity].value_or(0), 4, 1e-3);
  EXPECT_NEAR(askew[CueKind::viscosity_across].value_or(0), -4, 1e-3);
  EXPECT_FALSE(askew[CueKind::other_force]);
  EXPECT_EQ(compare(nothing, askew).verdict, Verdict::apart);
  // A force that another cue describes is not counted twice.
  for (const char* force : {"vector(1.2 N * sin(2 * pi * x / 2.5 mm), 0 N)", "-120 N/m * hand", "-7 N s/m * velocity"})
    EXPECT_FALSE(cues(std::string("force = ") + force)[CueKind::other_force]) << force;
}

TEST(Compare, TheNearestPairHasTheSmallestDifference) {
  std::vector<Cues> materials;
  for (const double amplitude : {1.0, 3.0, 3.1, 6.0}) {
    materials.push_back({std::to_string(amplitude), "sandpaper", {}});
    materials.back()[CueKind::amplitude] = amplitude;
  }
  const ComparisonMatrix matrix(materials, declarations());
  EXPECT_EQ(matrix.pair_count(), 6u);
  const std::vector<ComparedPair> nearest = matrix.nearest(2);
  ASSERT_EQ(nearest.size(), 2u);
  EXPECT_EQ(nearest[0].a, 1u);
  EXPECT_EQ(nearest[0].b, 2u);
  // 3.1 N and 6 N are a smaller ratio than 1 N and 3 N.
  EXPECT_EQ(nearest[1].a, 2u);
  EXPECT_EQ(nearest[1].b, 3u);
  EXPECT_TRUE(matrix.nearest(0).empty());
  EXPECT_EQ(matrix.nearest(99).size(), 6u);
}

TEST(Compare, AMatrixHoldsTheComparisonsOfItsPairs) {
  std::vector<Cues> materials;
  for (int i = 0; i < 23; ++i) {
    materials.push_back({std::to_string(i), "sandpaper", {}});
    materials.back()[CueKind::amplitude] = 0.2 + (i * 7 % 23) * 0.3;
    if (i % 3 == 0) materials.back()[CueKind::regularity] = 0.1 * (i % 5);
    if (i % 4 == 0) materials.back()[CueKind::viscosity] = 1.0 + i;
  }
  const ComparisonMatrix matrix(materials, declarations());
  std::size_t pairs = 0, alike = 0;
  for (std::size_t a = 0; a < materials.size(); ++a)
    for (std::size_t b = a + 1; b < materials.size(); ++b) {
      const Comparison whole = compare(materials[a], materials[b]);
      EXPECT_EQ(matrix.distance(b, a).verdict, whole.verdict);
      EXPECT_FLOAT_EQ(matrix.distance(a, b).noticeable, static_cast<float>(*whole.plainest()->noticeable));
      alike += whole.verdict == Verdict::alike;
      ++pairs;
    }
  EXPECT_EQ(matrix.pair_count(), pairs);
  EXPECT_EQ(matrix.count(Verdict::alike), alike);
}

}  // namespace
}  // namespace wale::compare_test
