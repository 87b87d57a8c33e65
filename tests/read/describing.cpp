// `wale describe` for programs with forces and without percepts, against the thesis.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "compiler/describe/describe.hpp"
#include "compiler/describe/describe_figure.hpp"
#include "compiler/modules/load_modules.hpp"
#include "tests/standard/standard.hpp"

namespace wale::describing_test {
namespace {

constexpr double program_unit = 10.0 / 512;  // N: Minsky 1995, 10 N over 512 units

Description described(const std::string& statements) {
  static const auto common = common_modules();
  const Program program = standard::material("material m { physical {\n" + statements + "\n} }", "m");
  return describe(Bank(program), common->declarations);
}

/// A sine force of this amplitude in program units and this period in mm.
std::string grating(double units, double period) {
  return "force = vector(" + std::to_string(-units * program_unit) + " N * sin(2 * pi * x / " + std::to_string(period) +
         " mm), 0 N)";
}

const DescribedPercept* percept(const Description& description, const std::string& name) {
  for (const DescribedPercept& each : description.percepts)
    if (each.name == name) return &each;
  return nullptr;
}

TEST(DescribingForces, ASpringWhoseForceIsCutInTheMiddlePullsToWhereItsLawSays) {
  struct Cut {
    const char* force;
    double x, y;  // mm
  };
  for (const Cut& cut : {Cut{"spring(120 N/m, rest: vector(30 mm, 0 mm)) limit 1.5 N", 30, 0},
                         Cut{"spring(500 N/m, rest: vector(50 mm, 20 mm))", 50, 20},
                         Cut{"spring(200 N/m, rest: vector(0 mm, -40 mm)) limit 2 N", 0, -40},
                         Cut{"spring(100 N/m, rest: vector(-25 mm, 10 mm))", -25, 10}}) {
    const Description description = described(std::string("force = ") + cut.force);
    ASSERT_TRUE(description.rest) << cut.force;
    EXPECT_NEAR(1e3 * description.rest->x, cut.x, 0.3) << cut.force;
    EXPECT_NEAR(1e3 * description.rest->y, cut.y, 0.3) << cut.force;
    if (cut.x == 0) EXPECT_EQ(description.rest->x, 0) << cut.force;
    if (cut.y == 0) EXPECT_EQ(description.rest->y, 0) << cut.force;
  }
}

TEST(DescribingForces, TheLargestForceOfAMovingHandIsOnlyTheLargestFoundUnlessItIsProved) {
  // A drag that is trebled within 0.3 mm of a place, where no search need come.
  const Description spot =
      described("force = (if length(hand - vector(31 mm, -17 mm)) < 0.3 mm then 3 else 1) * viscous(1 N s/m)");
  EXPECT_TRUE(spot.force.may_be_larger);
  EXPECT_NE(description_text(spot).find("N is the largest force found with these parameters"), std::string::npos);
  EXPECT_FALSE(described("force = viscous(2 N s/m)").force.may_be_larger);
  EXPECT_FALSE(described("force = vector(1 N * sin(2 * pi * x / 4 mm), 0 N)").force.may_be_larger);
}

TEST(DescribingForces, APushAlongItsLinesIsNoSlopeAsTheMapWasMeasuredWith) {
  const auto roughness_of = [](const std::string& force) {
    const Description description = described("force = " + force);
    const DescribedPercept* found = percept(description, "roughness");
    return found && found->domain ? *found->domain : Evidence::estimated;
  };
  EXPECT_EQ(roughness_of("vector(0 N, 0.7 N * sin(2 * pi * x / 4 mm))"), Evidence::extrapolated);
  EXPECT_EQ(roughness_of("vector(0.7 N * sin(2 * pi * y / 3 mm), 0 N)"), Evidence::extrapolated);
  EXPECT_EQ(roughness_of("vector(0.7 N * sin(2 * pi * x / 4 mm), 0 N)"), Evidence::measured);
  EXPECT_EQ(roughness_of("vector(0 N, 0.7 N * sin(2 * pi * y / 4 mm))"), Evidence::measured);
}

TEST(DescribingForces, TheRoughestStimulusOfTable6IsLevelOneHoweverItIsWritten) {
  const Description description = described(grating(194, 9.5));
  const DescribedPercept* roughness = percept(description, "roughness");
  ASSERT_TRUE(roughness);
  EXPECT_TRUE(roughness->extracted);
  EXPECT_NEAR(roughness->level, 1, 0.04);
  // Level 1 is this stimulus, so exponents do not matter there: s of figure 19, times the quantile of t with 28 degrees
  // of freedom. What is left for single people is the noise of their judgements.
  const LevelIntervals& intervals = roughness->intervals;
  EXPECT_NEAR(std::log10(intervals.means.high / roughness->level), 2.0484 * 0.0519, 2e-3);
  ASSERT_TRUE(intervals.people);
  EXPECT_NEAR(std::log10(intervals.people->high / roughness->level), 2.0484 * 0.0519 * std::sqrt(15), 2e-3);
  EXPECT_TRUE(description.no_percept.empty());
  EXPECT_TRUE(description.no_texture.empty());
}

TEST(DescribingForces, AQuarterOfTheForceIsAThirdAsRough) {
  const Description description = described(grating(194 / 4.0, 2.5));
  const DescribedPercept* roughness = percept(description, "roughness");
  ASSERT_TRUE(roughness);
  EXPECT_NEAR(roughness->level, std::pow(0.25, 0.759593), 0.02);
  ASSERT_TRUE(roughness->intervals.people);
  EXPECT_GT(roughness->intervals.people->high, 1.2 * roughness->intervals.means.high);
  EXPECT_LT(roughness->intervals.people->low, roughness->intervals.means.low / 1.2);
}

// What depends on one coordinate alone changes along one direction, whatever its waves and however it is turned.
TEST(DescribingForces, AReliefOfOneCoordinateIsOfOneDimension) {
  const char* const profiles[] = {"sin(2 pi * (u / 3 mm + 0.4 * sin(2 pi * u / 35 mm)))",
                                  "sin(2 pi * u / 3 mm) + 0.7 * sin(2 pi * u / 4.3 mm) + 0.4 * sin(2 pi * u / 7.7 mm)",
                                  "noise(u / 4 mm) - 0.5", "2 * fract(u / 5 mm) - 1"};
  for (std::string profile : profiles)
    for (const double degrees : {0.0, 1.0, 37.0}) {
      const std::string axis = fmt::format("(x * cos({0} deg) + y * sin({0} deg))", degrees);
      std::string text = profile;
      for (std::size_t at; (at = text.find("u / ")) != std::string::npos;) text.replace(at, 1, axis);
      const Description description = described("active 2 W\nforce = vector(1 N * (" + text + "), 0 N)");
      ASSERT_TRUE(description.texture) << text;
      const Relief& relief = description.texture->force;
      EXPECT_NEAR(relief.anisotropy, 1, 1e-3) << text;
      const double angle = degrees * std::numbers::pi / 180;
      EXPECT_NEAR(std::remainder(relief.orientation - angle, std::numbers::pi), 0, 2e-3) << text;
      EXPECT_EQ(description_text(description).find("two dimensions"), std::string::npos)
          << description_text(description);
    }
  // A wave of a fifth across the other is felt as a second dimension.
  const Description crossed =
      described("active 2 W\nforce = vector(1 N * (sin(2 pi * x / 3 mm) + 0.2 * sin(2 pi * y / 3 mm)), 0 N)");
  EXPECT_LT(crossed.texture->force.anisotropy, 0.98);
}

// 5 N s/m on hands that go in, beyond 20 mm: 1 N at 0.2 m/s there.
TEST(DescribingForces, ADragOnOneWayInAPartIsToldAsItIsFeltThere) {
  const Description description = described("force = crisp(5 N s/m)");
  EXPECT_NEAR(description.motion.most_by_place, 1, 0.03);
  EXPECT_EQ(description.motion.least_by_place, 0);
  const std::string text = description_text(description);
  EXPECT_NE(text.find("a drag in part of the patch only: at 200 mm/s up to 1 N"), std::string::npos) << text;
  EXPECT_NE(text.find("none to the left, on the mean over the patch"), std::string::npos) << text;
}

TEST(DescribingForces, ASwirlAndATravellingPatternHaveTheirWords) {
  const Description swirl = described("active 9 W\nforce = -20 N/m * perpendicular(hand)");
  EXPECT_NEAR(swirl.swirl, -20, 0.2);
  EXPECT_NE(description_text(swirl).find("  a swirl of 20 N/m, which turns a resting hand clockwise\n"),
            std::string::npos)
      << description_text(swirl);
  EXPECT_NE(descriptions_json({swirl}).find("\"swirl_newton_per_metre\": -20"), std::string::npos);
  const Description spring = described("force = -20 N/m * hand");
  EXPECT_EQ(description_text(spring).find("swirl"), std::string::npos);
  for (const int degrees : {0, 90, 180, 315}) {
    const Description travels = described(
        fmt::format("active 2 W\nforce = vector(1 N * sin(2 pi * ((x * cos({0} deg) + y * sin({0} deg)) / 4 mm - "
                    "phase(2 Hz))), 0 N)",
                    degrees));
    EXPECT_NE(description_text(travels).find(fmt::format("  a pattern that travels towards {} degrees\n", degrees)),
              std::string::npos)
        << description_text(travels);
    EXPECT_NE(descriptions_json({travels}).find("\"travel_rad\": "), std::string::npos);
  }
  const Description stands = described("active 2 W\nforce = vector(1 N * sin(2 pi * phase(2 Hz)), 0 N)");
  EXPECT_EQ(description_text(stands).find("travels"), std::string::npos);
}

TEST(DescribingForces, WhatComesAndWhatEndsSayWhen) {
  const auto text_of = [](const std::string& size) {
    const Description description = described("active 90 W\nforce = vector(" + size + ", 0 N)");
    return description_text(description) + descriptions_json({description});
  };
  const std::string comes = text_of("if time > 3 s then 2 N else 0 N"),
                    ends = text_of("if time < 3 s then 2 N else 0 N"),
                    late = text_of("if time > 12 s then 2 N else 0 N"), fades = text_of("3 N * exp(-time / 2 s)");
  EXPECT_NE(comes.find("up to 2 N that comes with time, half of it after 3 s,"), std::string::npos) << comes;
  EXPECT_NE(comes.find("\"goes\": false"), std::string::npos) << comes;
  EXPECT_NE(ends.find("up to 2 N that goes with time, half of it after 3 s,"), std::string::npos) << ends;
  EXPECT_NE(ends.find("\"goes\": true"), std::string::npos) << ends;
  EXPECT_NE(late.find("; a push of 2 N towards 0 degrees comes after 12"), std::string::npos) << late;
  EXPECT_NE(fades.find("that goes with time, half of it after 1.3"), std::string::npos) << fades;
}

/// sandpaper: 228 mm in 4096 counts. Sampled each count, a wave has as many waves less to the millimetre as the encoder
/// has counts.
TEST(DescribingForces, AWaveTooFineForTheEncoderIsItselfAndThePatternThatTheEncoderMakesOfIt) {
  for (const double period : {0.08, 0.1, 0.05, 0.04}) {
    const Description description = described(grating(100, period));
    ASSERT_TRUE(description.texture);
    EXPECT_NEAR(description.texture->force.period, 1e-3 * period, 0.02e-3 * period);
    const auto& device = description.device;
    const double counts_a_mm = 1e-3 * device.position_counts / device.workspace_diameter;
    const double left = std::abs(1 / period - counts_a_mm);
    ASSERT_TRUE(description.texture->encoder_pattern) << period;
    EXPECT_NEAR(description.texture->encoder_pattern->period, 1e-3 / left, 0.15e-3 / left) << period;
  }
  EXPECT_FALSE(described(grating(100, 0.12)).texture->encoder_pattern);
}

TEST(DescribingForces, AFaintStimulusIsNearTheThreshold) {
  const DescribedPercept* roughness = nullptr;
  const Description faint = described(grating(7, 2.5));
  ASSERT_TRUE(roughness = percept(faint, "roughness"));
  EXPECT_TRUE(roughness->near_threshold);
  EXPECT_TRUE(roughness->outside_validity());  // the experiment began at 9 units
  const Description plain = described(grating(100, 2.5));
  ASSERT_TRUE(roughness = percept(plain, "roughness"));
  EXPECT_FALSE(roughness->near_threshold || roughness->outside_validity());
}

TEST(DescribingForces, ClassesAreThoseInWhichTheSubjectsSorted) {
  EXPECT_EQ(described(grating(100, 0.9)).texture->texture_class, "flat texture");
  EXPECT_EQ(described(grating(190, 9)).texture->texture_class, "moguls");
  EXPECT_EQ(described(grating(30, 5)).texture->texture_class, "rolling hills");
  EXPECT_EQ(described(grating(100, 1.2)).texture->size_class, "texture");
  EXPECT_EQ(described(grating(100, 8)).texture->size_class, "separate features");
  EXPECT_EQ(described(grating(100, 1.2)).texture->confidence, "high");
}

/// Minsky 1995, section 4.5: mean ratings of the irregular stimuli and of stripes. Perlin's noise was rated low from 15
/// pixels (5.5 mm) on if its force was below 30 units. Nobody rated a mixture.
TEST(DescribingForces, ConfidenceIsThatOfTheKindsThatPeopleFelt) {
  const auto perlin = [](double units, double square) {
    return described("height h = noise2(x / " + std::to_string(square) + " mm, y / " + std::to_string(square) +
                     " mm)\nforce = lateral(h, amplitude: " + std::to_string(units) + " pu)");
  };
  const auto confidence = [](const Description& description) { return description.texture->confidence; };
  EXPECT_EQ(perlin(25, 4.5).texture->kind, "perlin");
  EXPECT_EQ(confidence(perlin(25, 4.5)), "high");
  EXPECT_EQ(confidence(perlin(25, 6.5)), "low");
  EXPECT_EQ(confidence(perlin(40, 6.5)), "high");
  EXPECT_EQ(perlin(40, 6.5).texture->texture_class, "") << "people sorted gratings";
  const auto noise = [](double units) {
    const std::string size = std::to_string(units);
    return described("force = vector((2 * lattice(x / 0.37 mm, y / 0.37 mm) - 1) * " + size +
                     " pu, (2 * lattice(x / 0.37 mm, y / 0.37 mm, 5) - 1) * " + size + " pu)");
  };
  EXPECT_EQ(noise(20).texture->kind, "noise");
  EXPECT_NEAR(noise(20).texture->confidence_mean.value_or(0), 0.70, 1e-9);
  EXPECT_NEAR(noise(50).texture->confidence_mean.value_or(0), 0.59, 1e-9);
  const Description stripes = described("patch 94.72 mm, 94.72 mm\n" + grating(30, 33));
  EXPECT_EQ(stripes.texture->kind, "stripes");
  EXPECT_NEAR(stripes.texture->confidence_mean.value_or(0), 0.43, 1e-9);
  const Description mixture = described(
      "height h = noise2(x / 6 mm, y / 6 mm) + 0.2 * noise2(x / 1.5 mm, y / 1.5 mm, seed: 9)\n"
      "force = lateral(h, amplitude: 1 N)");
  EXPECT_EQ(mixture.texture->kind, "irregular");
  EXPECT_EQ(confidence(mixture), "");
}

/// A wall of 400 N/m whose face is 15 mm left of the centre pushes with 400 N/m * 25 mm at the edge of a patch of 80
/// mm.
TEST(DescribingForces, AWallIsSaidWithItsPlaceAndItsLargestForce) {
  const Description wall = described("patch 80 mm, 80 mm\nforce = vector(400 N/m * max(0 mm, -15 mm - x), 0 N)");
  ASSERT_TRUE(wall.wall);
  EXPECT_NEAR(wall.wall->face.place.x, -0.015, 1e-4);
  EXPECT_NEAR(wall.wall->face.stiffness, 400, 4);
  EXPECT_NEAR(wall.wall->depth.depth, 0.025, 1e-4);
  EXPECT_NEAR(wall.wall->depth.newton, 10, 0.1);
  EXPECT_NE(description_text(wall).find("a wall left of x = -15 mm: 400 N/m, up to 9.99 N on a hand that goes 25 mm"),
            std::string::npos)
      << description_text(wall);
  EXPECT_FALSE(described("force = -120 N/m * hand").wall);
  // The device saturates 10 N / 600 N/m behind the face: a wall is flat on both sides, and the hand outside it is free.
  const Description ribbed = described(
      "force ribs = lateral(grating(y, period: 2.5 mm), amplitude: 1 N)\nforce wall = firm(600 N/m, face: 25 mm)");
  ASSERT_TRUE(ribbed.wall);
  EXPECT_NEAR(ribbed.wall->face.place.x, 0.025, 3e-4);
  EXPECT_GT(ribbed.wall->face.inward.x, 0.99);
  EXPECT_NEAR(ribbed.wall->depth.newton, 10, 0.1);
}

TEST(DescribingForces, WithoutATextureHaveNoRoughnessAndAReason) {
  struct Case {
    const char* force;
    const char* kind;
    double confidence;  // mean of the ratings, Minsky 1995, section 4.5
  };
  for (const Case& each :
       {Case{"force = -120 N/m * hand", "spring", 0.13}, Case{"force = -7 N s/m * velocity", "viscous", 0.23},
        Case{"force = vector(0 N, 0 N)", "nothing", 0.19}, Case{"force = 60 N/m * hand", "bump", 0.22},
        Case{"active 1 W\nforce = 3 N s/m * velocity", "slick", 0.11}}) {
    const Description description = described(each.force);
    EXPECT_FALSE(percept(description, "roughness")) << each.force;
    EXPECT_FALSE(description.no_texture.empty()) << each.force;
    EXPECT_EQ(description.texture->kind, each.kind);
    EXPECT_EQ(description.texture->force.amplitude, 0) << each.force;
    ASSERT_TRUE(description.texture->confidence_mean) << each.force;
    EXPECT_NEAR(*description.texture->confidence_mean, each.confidence, 1e-9) << each.force;
  }
}

TEST(DescribingForces, HaveAPerceptForEachCarrier) {
  const Description description =
      described(grating(100, 2.5) + "\nforce thick = -10 N s/m * velocity\nforce back = -50 N/m * hand");
  ASSERT_TRUE(percept(description, "roughness") && percept(description, "viscosity") &&
              percept(description, "springiness"));
  EXPECT_NEAR(percept(description, "roughness")->amplitude, 100 * program_unit, 0.06);
  EXPECT_NEAR(percept(description, "viscosity")->amplitude, 10, 0.1);
  EXPECT_NEAR(percept(description, "viscosity")->level, 1, 0.02);  // 10 N s/m is its level 1
  EXPECT_NEAR(percept(description, "springiness")->amplitude, 50, 0.5);
  EXPECT_FALSE(percept(description, "stickiness") || percept(description, "heaviness") ||
               percept(description, "vibration"));
  EXPECT_EQ(description.texture->kind, "grating");
}

TEST(DescribingForces, FromWhichValueOnTheDeviceCutsIsSearched) {
  struct Case {
    const char* statements;
    bool above;
    double value, range;
  };
  for (const Case& each : {
           Case{"param a = 2 N in 0 N .. 30 N\nforce = vector(a * sin(2 * pi * x / 4 mm), 0 N)", true, 10, 30},
           Case{"param a = 20 N in 0 N .. 30 N\nforce = vector(a * sin(2 * pi * x / 4 mm), 0 N)", true, 10, 30},
           // 10 N at the patch's edge, 80 mm from its middle.
           Case{"param k = 50 N/m in 10 N/m .. 400 N/m\nforce = vector(-k * x, 0 N)", true, 125, 390},
           Case{"param gap = 4 in 1 .. 9\nforce = vector(30 N / gap * sin(2 * pi * x / 3 mm), 0 N)", false, 3, 8},
       }) {
    const Description description = described(each.statements);
    ASSERT_EQ(description.cuts.size(), 1u) << each.statements;
    ASSERT_EQ(description.cuts[0].size(), 1u) << each.statements;
    EXPECT_EQ(description.cuts[0][0].above, each.above) << each.statements;
    EXPECT_NEAR(description.cuts[0][0].value, each.value, 0.01 * each.range) << each.statements;
  }
  EXPECT_NE(description_text(described("param a = 2 N in 0 N .. 30 N\nforce = vector(a * sin(2 * pi * x / 4 mm), 0 N)"))
                .find("from 10 N on, `sandpaper` cuts the force"),
            std::string::npos);
  for (const auto& ranges : described("param a = 2 N in 0 N .. 9 N\nforce = vector(a, 0 N)").cuts)
    EXPECT_TRUE(ranges.empty());
}

TEST(DescribingForces, WhatGoesByTimeAloneHasNoMemoryAndOneLargestForce) {
  const Description shaking = described("active 2 W\nforce = vibrate(0.5 N)");
  EXPECT_EQ(shaking.no_texture, "its force depends on time, and is the same at every place");
  const Description drag = described("force = -10 N s/m * velocity * length(velocity) / 1 m/s");
  EXPECT_EQ(drag.no_texture, "its force depends on the hand's velocity, and is the same at every place");
  EXPECT_TRUE(drag.no_percept.starts_with("its resistance is neither a friction nor")) << drag.no_percept;
  const Description slow = described("active 2 W\nforce = vector(1 N * sin(2 * pi * phase(0.2 Hz)), 0 N)");
  EXPECT_NEAR(slow.force.max_newton, 1, 1e-3);
  EXPECT_NEAR(slow.bound.found.newton, 1, 1e-3);
  EXPECT_EQ(slow.other.remembered, 0);
  const Description rubbed = described(
      "state trail : length = 0 mm in -50 mm .. 50 mm\ntrail' = (x - trail) / 1 s\nforce = vector(-20 N/m * trail, 0 "
      "N)");
  EXPECT_EQ(rubbed.no_texture, "its force depends on its memory, so it has no single texture");
  // It gives most where the hand has come from afar.
  EXPECT_GT(rubbed.other.remembered, 0.1);
  EXPECT_GE(rubbed.force.max_newton, rubbed.other.remembered - 1e-4);
  EXPECT_GE(rubbed.bound.found.newton, rubbed.force.max_newton - 1e-4);
  // A texture that is worn off after 0.1 m is missed wherever the hand then strokes, by its whole size at its slopes.
  for (const double newton : {0.5, 2.0}) {
    const Description worn = described(
        "state gone = 0 in 0 .. 1\ngone' = min(length(velocity) / 0.1 m, (1 - gone) / dt)\nforce = vector(" +
        std::to_string(newton) + " N * (1 - gone) * sin(2 * pi * x / 4 mm), 0 N)");
    EXPECT_NEAR(worn.other.remembered, newton, 0.03 * newton);
  }
  // A soft bristle is friction, which no other cue tells again.
  const Description soft = described("force = sticky(0.5 N, 6 N/m)");
  ASSERT_TRUE(percept(soft, "stickiness"));
  EXPECT_NEAR(percept(soft, "stickiness")->amplitude, 0.5, 0.015);
  EXPECT_EQ(soft.other.remembered, 0);
}

TEST(DescribingForces, ASquareWaveOfOneNewtonReadsOneNewtonAtAnyRate) {
  // 900 Hz is no multiple of most of these, so that one half of the wave has more ticks than the other.
  for (const char* rate : {"45", "60", "75", "100", "120", "150"}) {
    const Description description = described(std::string("active 2 W\nforce = vector(if fract(") + rate +
                                              " Hz * time) < 0.5 then 1 N else -1 N, 0 N)");
    ASSERT_TRUE(percept(description, "vibration")) << rate;
    EXPECT_NEAR(percept(description, "vibration")->amplitude, 1, 0.03) << rate;
  }
}

TEST(DescribingForces, AWallMayPushOtherwiseThanInProportionToTheDepth) {
  constexpr double begins = 12e-3, scale = 60e-3, newton = 2;  // newton * (depth / scale)^power
  for (const double power : {0.7, 1.3, 1.5, 2.0, 3.0})
    for (const double degrees : {0.0, 180.0, 90.0, 35.0}) {
      const double angle = degrees * std::numbers::pi / 180;
      const glm::dvec2 into(std::cos(angle), std::sin(angle));
      const Description bent = described(
          fmt::format("let deep = max(0 mm, x * {0:.6f} + y * {1:.6f} - 12 mm)\n"
                      "force = -2 N * (deep / 60 mm)^{2} * vector({0:.6f}, {1:.6f})", into.x, into.y, power));
      const std::string which = fmt::format("depth^{} at {} degrees", power, degrees);
      ASSERT_TRUE(bent.wall) << which;
      const WallFace& face = bent.wall->face;
      EXPECT_NEAR(glm::dot(face.place, face.inward), begins, 1e-3) << which;
      EXPECT_NEAR(face.power, power, 0.05 * power) << which;
      EXPECT_GT(glm::dot(face.inward, into), 0.9998) << which;
      // The depth at which its push has this ratio to it.
      const double deepest = scale * std::pow(face.stiffness * scale / newton, 1 / (power - 1));
      const double reach = 0.075 * (std::abs(into.x) + std::abs(into.y)) - begins;
      EXPECT_GT(deepest, 0.8 * reach) << which;
      EXPECT_LT(deepest, 1.05 * reach) << which;
      EXPECT_FALSE(percept(bent, "bumpiness") || percept(bent, "roughness")) << which;
      EXPECT_LT(bent.texture->force.amplitude, 0.02) << which;
    }
  // A texture over it is read as it is alone.
  const Description rough = described(
      "force = vector(-5 N * (max(0 mm, x - 12 mm) / 60 mm)^1.5 + 0.6 N * sin(2 pi * y / 4 mm), 0 N)");
  ASSERT_TRUE(rough.wall);
  EXPECT_NEAR(rough.wall->face.power, 1.5, 0.1);
  EXPECT_NEAR(rough.texture->force.period, 4e-3, 8e-5);
  EXPECT_NEAR(rough.texture->force.amplitude, 0.6, 0.03);
  // A wall in proportion to the depth has no power but 1.
  EXPECT_EQ(described("force = vector(if x > 20 mm then -200 N/m * (x - 20 mm) else 0 N, 0 N)").wall->face.power, 1);
}

TEST(DescribingForces, WhatDrivesTheHandAwayAndASpringThatEndsAreNoWalls) {
  // Each pushes with what is noted behind it, and nowhere back out of a face that it stands behind.
  const std::pair<const char*, double> forces[] = {
      {"vector(if x > 20 mm then 300 N/m * (x - 20 mm) else 0 N, 0 N)", 10},  // the device's limit
      {"vector(0 N, if y < -15 mm then 200 N/m * (y + 15 mm) else 0 N)", 10}};
  for (const auto& [force, most] : forces) {
    const Description description = described(std::string("active 9 W\nforce = ") + force);
    EXPECT_FALSE(percept(description, "hardness")) << force;
    EXPECT_EQ(description.constant_push, glm::dvec2(0)) << force;
    EXPECT_TRUE(!description.wall || description.wall->face.place.x == 0.02) << force;
    EXPECT_NEAR(description.unread, most, 0.15 * most) << force;
  }
  const Description spring = described("force = vector(-clamp(x * 200 N/m, -2 N, 2 N), 0 N)");
  ASSERT_TRUE(percept(spring, "springiness"));
  EXPECT_NEAR(percept(spring, "springiness")->amplitude, 200, 2);
  EXPECT_FALSE(percept(spring, "hardness") || spring.wall);
  EXPECT_EQ(spring.unread, 0);
  for (const char* stiffening : {"vector(-20 N/m * x * (1 + x / 200 mm), 0 N)", "vector(-30 N/m * x * (1 - x / 180 mm), 0 N)",
                                 "vector(0 N, -25 N/m * y * (1 + y / 220 mm))"}) {
    const Description bent = described(std::string("active 9 W\nforce = ") + stiffening);
    EXPECT_FALSE(percept(bent, "hardness") || bent.wall) << stiffening;
    EXPECT_GT(bent.unread, 1) << stiffening;
  }
  const Description wall = described("force = vector(if x > 20 mm then -300 N/m * (x - 20 mm) else 0 N, 0 N)");
  ASSERT_TRUE(wall.wall);
  EXPECT_NEAR(wall.wall->face.stiffness, 300, 3);
  EXPECT_EQ(wall.unread, 0);
}

TEST(DescribingForces, ASpringThatTheDeviceCutsEverywhereIsAPush) {
  const Description push = described("force = vector(-420 N/m * (x + 100 mm), 0 N)");
  EXPECT_FALSE(percept(push, "springiness"));
  EXPECT_NEAR(push.constant_push.x, -10, 0.01);
  // Along x it is cut, and along y it is a spring.
  const Description half = described("force = spring(400 N/m, rest: vector(110 mm, 0 mm))");
  ASSERT_EQ(half.directed.size(), 1u);
  EXPECT_NEAR(half.directed.front().size.greatest, 400, 8);
  EXPECT_EQ(half.directed.front().size.across, 0);
  EXPECT_NEAR(std::abs(half.directed.front().size.axis.y), 1, 1e-6);
  // One that is not cut in its middle is a spring.
  const Description spring = described("force = spring(2000 N/m)");
  ASSERT_TRUE(percept(spring, "springiness"));
  EXPECT_NEAR(percept(spring, "springiness")->amplitude, 2000, 40);
}

TEST(DescribingForces, AWallWithAPreloadIsReadAlsoIfItsAuthorLimitsIt) {
  std::mt19937 random(4);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  for (int i = 0; i < 10; ++i) {
    const double place = between(-30, 30), preload = between(0.3, 2.5), stiffness = between(60, 380);
    // The wall goes on for a centimetre at least before the limit, and its jump is a twelfth of that or more.
    const double limit = std::min({preload + stiffness * between(0.012, 0.03), 12 * preload, 9.9});
    if ((limit - preload) / stiffness < 0.01) continue;
    const char axis = i % 2 == 0 ? 'x' : 'y';
    const std::string push =
        fmt::format("if {0} > {1} mm then -{2} N - {3} N/m * ({0} - {1} mm) else 0 N", axis, place, preload, stiffness);
    const std::string text =
        fmt::format("force = vector({}, {}) limit {} N", axis == 'x' ? push : "0 N", axis == 'y' ? push : "0 N", limit);
    const Description description = described(text);
    ASSERT_TRUE(description.wall) << text;
    const WallFace& face = description.wall->face;
    EXPECT_NEAR(axis == 'x' ? face.place.x : face.place.y, 1e-3 * place, 2e-4) << text;
    EXPECT_NEAR(face.stiffness, stiffness, 0.03 * stiffness) << text;
    EXPECT_NEAR(face.preload, preload, 0.03 * preload) << text;
  }
}

TEST(DescribingForces, TheFlankOfAHillIsNoWall) {
  for (const char* hill :
       {"20 N/m * hand * max(0, 1 - length(hand) / 60 mm)", "100 N/m * hand * max(0, 1 - length(hand) / 40 mm)",
        "20 N/m * hand * max(0, 1 - length(hand) / 40 mm)", "-100 N/m * hand * max(0, 1 - length(hand) / 40 mm)"}) {
    const Description description = described(std::string("force = ") + hill);
    EXPECT_FALSE(description.wall) << hill;
    EXPECT_FALSE(percept(description, "hardness")) << hill;
  }
}

TEST(DescribingForces, WhatTheButtonAndTimeBringIsToldWhereItIsLargest) {
  const std::string ribs = "lateral(grating(x, period: 3 mm), amplitude: 2 N)";
  EXPECT_NEAR(described("force = if button then " + ribs + " else vector(0 N, 0 N)").other.button, 2, 0.02);
  EXPECT_NEAR(described("active 1 W\nforce = (if time > 3 s then 1 else 0) * " + ribs).other.slowly, 2, 0.02);
}

TEST(DescribingForces, SmallFeaturesSwaysAndWhatPushesOnAreTold) {
  const Description ridge =
      described("force = vector(2 N * (if abs(x) < 0.5 mm then sin(2 * pi * x / 1 mm) else 0), 0 N)");
  EXPECT_NEAR(ridge.small_feature, 2, 0.1);
  EXPECT_EQ(described("force = lateral(grating(x, period: 3 mm), amplitude: 1 N)").small_feature, 0);
  const Description sway = described("active 9 W\nforce = vector(0.6 N * sin(2 * pi * phase(3 Hz)), 0 N)");
  EXPECT_NEAR(sway.sway.amplitude, 0.6, 0.02);
  EXPECT_NEAR(sway.sway.frequency, 3, 0.05);
  // A triangle that begins at its crest is a vibration and nothing else.
  const Description triangle = described("active 9 W\nforce = vector(0.5 N * (4 * abs(phase(50 Hz) - 0.5) - 1), 0 N)");
  EXPECT_TRUE(percept(triangle, "vibration"));
  EXPECT_EQ(triangle.unread, 0);
  const Description away = described("force = 20 N/m * hand");
  ASSERT_EQ(away.directed.size(), 1u);
  EXPECT_NEAR(away.directed[0].size.greatest, -20, 0.1);
}

// firm(500 N/m) is its whole law, though the device gives 10 N only.
TEST(DescribingForces, AHardnessIsThatOfAllWallsInOnePlace) {
  const Description description = described(
      "force a = firm(500 N/m, face: 20 mm)\n"
      "force b = vector(if x > 20 mm then -300 N/m * (x - 20 mm) else 0 N, 0 N)");
  const DescribedPercept* const hardness = percept(description, "hardness");
  ASSERT_TRUE(hardness);
  EXPECT_NEAR(hardness->amplitude, 800, 8);
}

TEST(DescribingForces, FiguresHaveNoSizeThatIsAnError) {
  EXPECT_NEAR(figure(1e-310), 1e-310, 1e-312);
  EXPECT_FALSE(std::signbit(figure(-0.0)));
}

TEST(DescribingForces, OnlySoManyParametersAreSearchedForCuts) {
  const auto with = [](int moving, int idle) {
    std::string statements, sum = "0 N";
    for (int i = 0; i < moving + idle; ++i) statements += fmt::format("param p{} = 1 N in 0 N .. 20 N\n", i);
    for (int i = 0; i < moving; ++i) sum += fmt::format(" + p{}", i);
    return described(statements + "force = vector(" + sum + ", 0 N)");
  };
  EXPECT_EQ(with(5, 40).not_searched, 0);  // what moves nothing needs no search
  const Description many = with(100, 3);
  EXPECT_GE(many.not_searched, 100 - 64);
  EXPECT_LT(many.not_searched, 100);
  EXPECT_NE(description_text(many).find(fmt::format("{} of these that move the force were not", many.not_searched)),
            std::string::npos);
}

}  // namespace
}  // namespace wale::describing_test
