// What is asked for, what the finished program reads, and on what evidence, against closed forms.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "compiler/describe/describe.hpp"
#include "compiler/modules/load_modules.hpp"
#include "tests/calibration/declared.hpp"

namespace wale::asked_and_read_test {
namespace {

using calibrating::bank_at;
using calibrating::Declared;
using Json = nlohmann::json;

// Minsky 1995, figure 19: level 1 is 194 program units of 10 N / 512, the exponent 0.759593.
constexpr double exponent = 0.759593, newton_one = 194 * 10.0 / 512;
double newton(double level) { return newton_one * std::pow(level, 1 / exponent); }
double level_of(double force) { return std::pow(force / newton_one, exponent); }

/// A material that asks for percepts, its codes when compiled for a device, and its description.
struct Made {
  Declared declared;
  Program program;

  Made(const std::string& perceptual, const std::string& physical, const std::string& device = default_device)
      : declared("material m {\n  perceptual { " + perceptual + " }\n  physical {\n" + physical + "\n  }\n}\n"),
        program(declared.program("m", device)) {}

  Description description() const { return describe(Bank(program), declared.declarations()); }
  Json json() const { return Json::parse(descriptions_json({description()})); }
  std::string codes() const { return declared.codes(); }
};

const DescribedPercept& percept(const Description& description, const std::string& name) {
  for (const DescribedPercept& each : description.percepts)
    if (each.name == name) return each;
  throw std::runtime_error("no percept " + name);
}

const FateRecord& fate(const Description& description, const std::string& name) {
  for (const DescribedFate& each : description.fates)
    if (each.record.name == name) return each.record;
  throw std::runtime_error("no fate of " + name);
}

/// A grating in two sizes: a solved one, and one of this size against it.
std::string against(const std::string& newton) {
  return "    height ribs = grating(x, period: 2.5 mm)\n    force felt = lateral(ribs)\n"
         "    force other = -lateral(ribs, amplitude: " +
         newton + ")";
}

TEST(AskedAndRead, AGratingAloneReadsAsAsked) {
  const Made made("roughness 0.6", "    force = lateral(grating(x, period: 2.5 mm))");
  EXPECT_EQ(made.codes(), "");
  const Description description = made.description();
  const DescribedPercept& roughness = percept(description, "roughness");
  EXPECT_NEAR(*roughness.asked, 0.6, 1e-6);
  EXPECT_NEAR(roughness.level, 0.6, 0.005);
  EXPECT_NEAR(roughness.amplitude, newton(0.6), 0.01);
  EXPECT_EQ(roughness.evidence(), Evidence::measured);
  EXPECT_EQ(roughness.domain, Evidence::measured);
  EXPECT_EQ(fate(description, "roughness").fate, Fate::kept);
  ASSERT_EQ(roughness.settings.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(roughness.settings[i].asked, 0.5 * static_cast<double>(i), 1e-6);
    EXPECT_NEAR(roughness.settings[i].reads, 0.5 * static_cast<double>(i), 0.01);
  }
}

TEST(AskedAndRead, GratingsInPhaseOppositionReadAsWhatIsLeft) {
  const Made made("roughness 0.6", against("1.5 N"));
  EXPECT_EQ(made.codes(), "W0425");
  const Description description = made.description();
  const DescribedPercept& roughness = percept(description, "roughness");
  const double left = level_of(newton(0.6) - 1.5);
  EXPECT_NEAR(*roughness.asked, 0.6, 1e-6);
  EXPECT_NEAR(roughness.level, left, 0.02);
  const FateRecord& told = fate(description, "roughness");
  EXPECT_EQ(told.fate, Fate::approximated);
  EXPECT_NEAR(told.given, left, 0.02);
  EXPECT_EQ(told.reason, "another force takes from it");
  // The program file says the same.
  EXPECT_EQ(made.program.description().fates.front().fate, Fate::approximated);
  EXPECT_NEAR(made.program.description().fates.front().given, left, 0.02);
  // At level 0 the other grating is all there is, and at level 1 it takes 1.5 N.
  EXPECT_NEAR(roughness.settings[0].reads, level_of(1.5), 0.02);
  EXPECT_NEAR(roughness.settings[2].reads, level_of(newton_one - 1.5), 0.02);
  const Json json = made.json()["percepts"]["roughness"];
  EXPECT_NEAR(json["asked"].get<double>(), 0.6, 1e-4);
  EXPECT_NEAR(json["level"].get<double>(), left, 0.02);
  EXPECT_TRUE(json["evidence"].is_string());
}

// The compiler corrects the fates of a program, and `describe` those at chosen parameters: at the defaults, the same.
TEST(AskedAndRead, FatesAtTheDefaultsAreThoseOfTheProgram) {
  const std::pair<const char*, std::string> cases[] = {
      {"roughness 0.6", against("1.5 N")},
      {"roughness 0.6", "    force = lateral(grating(x, period: 2.5 mm))"},
      {"roughness 0.4", against("0.2 N")},
      {"roughness 0.6", "    force = lateral(grating(x, period: 14 mm))"},
      {"bumpiness 0.5", "    force = bumps(grating(x, period: 25 mm, smooth: 0.25)) + spring(60 N/m)"}};
  for (const auto& [perceptual, physical] : cases) {
    const Made made(perceptual, physical);
    const Description description = made.description();
    for (const FateRecord& kept : made.program.description().fates) {
      if (!kept.percept) continue;
      const FateRecord& now = fate(description, kept.name);
      EXPECT_EQ(now.fate, kept.fate) << physical;
      EXPECT_EQ(now.given, kept.given) << physical;
      EXPECT_EQ(now.reason, kept.reason) << physical;
    }
  }
}

TEST(AskedAndRead, GratingsThatCancelReadAsNothing) {
  // 1.93406 N is the size for 0.6.
  const Made made("roughness 0.6", against("1.93406 N"));
  EXPECT_EQ(made.codes(), "W0425");
  const Description description = made.description();
  EXPECT_EQ(percept(description, "roughness").level, 0);
  EXPECT_NE(description_text(description).find("nothing in the finished program carries it"), std::string::npos);
}

TEST(AskedAndRead, GratingsInPhaseAddUp) {
  const Made made("roughness 0.4",
                  "    height ribs = grating(x, period: 2.5 mm)\n    force felt = lateral(ribs)\n"
                  "    force more = lateral(ribs, amplitude: 1 N)");
  EXPECT_EQ(made.codes(), "W0425");
  const Description description = made.description();
  EXPECT_NEAR(percept(description, "roughness").level, level_of(newton(0.4) + 1), 0.02);
  EXPECT_EQ(fate(description, "roughness").reason, "another force adds to it");
}

TEST(AskedAndRead, ADifferenceThatNobodyNoticesIsNone) {
  // 4 % of force: less than the smallest noticeable ratio, and less than the scatter of the map.
  const Made made("roughness 0.6", against("0.08 N"));
  EXPECT_EQ(made.codes(), "");
  EXPECT_EQ(fate(made.description(), "roughness").fate, Fate::kept);
}

TEST(AskedAndRead, AToleranceAcceptsADifference) {
  const Made made("roughness 0.6 +- 0.45", against("1.5 N"));
  EXPECT_EQ(made.codes(), "");
  EXPECT_EQ(fate(made.description(), "roughness").fate, Fate::kept);
  EXPECT_NEAR(percept(made.description(), "roughness").level, level_of(newton(0.6) - 1.5), 0.02);
}

TEST(AskedAndRead, ASpringLeavesAGratingAsItIs) {
  const Made made("roughness 0.5",
                  "    force felt = lateral(grating(x, period: 2.5 mm))\n    force back = spring(60 N/m)");
  EXPECT_EQ(made.codes(), "");
  const Description description = made.description();
  EXPECT_NEAR(percept(description, "roughness").level, 0.5, 0.01);
  EXPECT_NEAR(percept(description, "springiness").amplitude, 60, 1);
  EXPECT_FALSE(percept(description, "springiness").asked);
  EXPECT_EQ(fate(description, "roughness").fate, Fate::kept);
  // Nobody measured a grating on a spring.
  EXPECT_EQ(percept(description, "roughness").evidence(), Evidence::extrapolated);
  EXPECT_EQ(percept(description, "roughness").domain_why, "beside stiffness, measured alone");
}

TEST(AskedAndRead, AFactorIsToldOnce) {
  const Made made("roughness 0.3", "    force felt = 2 * lateral(grating(x, period: 2.5 mm))");
  EXPECT_EQ(made.codes(), "W0414");
  // The level that the doubled force has by Minsky's law, beside the one that was asked for.
  char figure[8];
  std::snprintf(figure, sizeof figure, "%.2g", level_of(2 * newton(0.3)));
  EXPECT_NE(made.declared.said().find("roughness 0.3 is asked for, and the finished program reads " + std::string(figure)),
            std::string::npos)
      << made.declared.said();
  const Description description = made.description();
  EXPECT_NEAR(percept(description, "roughness").level, level_of(2 * newton(0.3)), 0.02);
  EXPECT_EQ(fate(description, "roughness").fate, Fate::approximated);
}

TEST(AskedAndRead, NeverBesideALevelThatTheDeviceCannotGive) {
  const Made made("roughness 1", "    force = lateral(grating(x, period: 2.5 mm))", "openffboard");
  EXPECT_EQ(made.codes().find("W0425"), std::string::npos);
}

TEST(AskedAndRead, WhatTheDevicesLimitHidesIsNotJudged) {
  // A wall of 318 N/m reaches the 10 N of the device within the patch.
  const Made made("roughness 0.15; hardness 0.4",
                  "    force felt = lateral(grating(x, period: 2.5 mm))\n    force wall = firm()");
  EXPECT_EQ(made.codes(), "");
  EXPECT_NEAR(percept(made.description(), "roughness").level, 0.15, 0.01);
  EXPECT_NEAR(percept(made.description(), "hardness").level, 0.4, 0.02);
}

TEST(AskedAndRead, OtherCarriersAreReadToo) {
  const Made made("viscosity 0.6; springiness 0.3",
                  "    force slow = viscous()\n    force thicker = viscous(6 N s/m)\n    force back = spring()");
  EXPECT_EQ(made.codes(), "W0425");
  const Description description = made.description();
  // Stevens and Guirao 1964: exponent 0.44, level 1 at 10 N s/m.
  const double size = 10 * std::pow(0.6, 1 / 0.44) + 6;
  EXPECT_NEAR(percept(description, "viscosity").amplitude, size, 0.03 * size);
  EXPECT_NEAR(percept(description, "viscosity").level, std::pow(size / 10, 0.44), 0.02);
  EXPECT_NEAR(percept(description, "springiness").level, 0.3, 0.01);
}

// ---- outside what was measured ----

TEST(Outside, APeriodIsSaidAndNeverGradedMeasured) {
  struct Case {
    const char* period;
    const char* words;
  };
  for (const Case& each : {Case{"14 mm", "outside what was measured (period 14 mm, measured to 10)"},
                           Case{"40 mm", "outside what was measured (period 40 mm, measured to 10)"},
                           Case{"0.3 mm", "outside what was measured (period 0.3 mm, measured from 0.7)"}}) {
    const Made made("roughness 0.6", "    force = lateral(grating(x, period: " + std::string(each.period) + "))");
    EXPECT_EQ(made.codes(), "W0407") << each.period;
    const Description description = made.description();
    EXPECT_NE(description_text(description).find(each.words), std::string::npos) << description_text(description);
    EXPECT_EQ(percept(description, "roughness").evidence(), Evidence::extrapolated);
    EXPECT_TRUE(percept(description, "roughness").unknown) << "its period counts for no roughness";
    EXPECT_NE(description_text(description).find("reads     unknown"), std::string::npos);
    EXPECT_TRUE(made.json()["percepts"]["roughness"]["level"].is_null());
    EXPECT_FLOAT_EQ(fate(description, "roughness").given, fate(description, "roughness").asked) << "no other is known";
    EXPECT_EQ(fate(description, "roughness").fate, Fate::approximated);
    const Json outside = made.json()["percepts"]["roughness"]["outside"];
    ASSERT_EQ(outside.size(), 1u);
    EXPECT_EQ(outside[0]["quantity"], "period");
    EXPECT_NEAR(outside[0]["low_si"].get<double>(), 0.7e-3, 1e-8);
    EXPECT_NEAR(outside[0]["high_si"].get<double>(), 10e-3, 1e-8);
  }
}

TEST(Outside, APeriodALittleBeyondTheRangeIsNotMeasured) {
  for (const char* period : {"10.2 mm", "10.1 mm", "0.69 mm"}) {
    const Made made("roughness 0.6", "    force = lateral(grating(x, period: " + std::string(period) + "))");
    EXPECT_EQ(made.codes(), "W0407") << period;
    EXPECT_EQ(percept(made.description(), "roughness").evidence(), Evidence::extrapolated) << period;
  }
}

// ---- parameters ----

/// The described material of these percepts and statements at other values of its parameters.
Description described_at(const Made& made, const std::vector<float>& values) {
  return describe(Bank(made.program, values, made.program.default_size()), made.declared.declarations());
}

TEST(Parameters, TheFateIsWhatIsReadWhereverTheValuesComeFrom) {
  const Made made("roughness 0.5",
                  "    param p = 2 mm in 0.5 mm .. 30 mm\n    param g = 1 in 0 .. 5\n"
                  "    force = g * lateral(grating(x, period: p))");
  const auto& parameters = made.program.description().parameters;
  std::vector<float> values;
  for (const Parameter& each : parameters) values.push_back(each.value);
  const auto place = [&](const char* name) {
    return static_cast<std::size_t>(std::ranges::find(parameters, name, &Parameter::name) - parameters.begin());
  };
  for (const auto& [gain, reads] : {std::pair{0.0f, 0.0}, {5.0f, level_of(5 * newton(0.5))}}) {
    values[place("g")] = gain;
    const Description description = described_at(made, values);
    EXPECT_NEAR(percept(description, "roughness").level, reads, 0.02) << gain;
    EXPECT_EQ(fate(description, "roughness").fate, Fate::approximated) << gain;
    EXPECT_NEAR(fate(description, "roughness").given, percept(description, "roughness").level, 1e-3) << gain;
  }
  values[place("g")] = 1, values[place("p")] = 0.014f;
  EXPECT_TRUE(percept(described_at(made, values), "roughness").unknown);
}

TEST(Parameters, TheEndsOfARangeThatFeelOtherwiseAreTold) {
  const Made made("roughness 0.5",
                  "    param p = 2 mm in 1 mm .. 30 mm\n    param g = 1 in 0 .. 3\n    param k = 1 N/m in 0.5 N/m .. 2 "
                  "N/m\n    force a = g * lateral(grating(x, period: p))\n    force b = spring(k)");
  const Description description = made.description();
  const auto& ends = percept(description, "roughness").ends;
  ASSERT_EQ(ends.size(), 3u) << description_text(description);
  const std::string text = description_text(description);
  EXPECT_NE(text.find("at 30 mm roughness reads unknown"), std::string::npos) << text;
  EXPECT_NE(text.find("; at 0 roughness reads 0.00; at 3 roughness reads "), std::string::npos) << text;
}

TEST(Parameters, ALevelTooSmallToBeReadIsNotGiven) {
  const Made made("viscosity 0.05", "    force = viscous()");
  const Description description = made.description();
  EXPECT_EQ(percept(description, "viscosity").level, 0);
  EXPECT_EQ(fate(description, "viscosity").fate, Fate::approximated);
  EXPECT_EQ(fate(description, "viscosity").given, 0);
  EXPECT_EQ(made.codes(), "W0407") << "few people feel what was asked for, which is said";
}

TEST(Outside, APeriodAtTheEndOfTheRangeIsInside) {
  for (const char* period : {"0.7 mm", "10 mm"}) {
    const Made made("roughness 0.6", "    force = lateral(grating(x, period: " + std::string(period) + "))");
    EXPECT_EQ(made.codes(), "") << period;
    EXPECT_EQ(percept(made.description(), "roughness").evidence(), Evidence::measured) << period;
  }
}

TEST(Outside, ARateIsSaid) {
  const Made inside("vibration 0.3", "    active 100 W\n    force = vibrate(rate: 200 Hz)");
  EXPECT_EQ(inside.codes().find("W0407"), std::string::npos);
  const Made made("vibration 0.3", "    active 100 W\n    force = vibrate(rate: 400 Hz)");
  EXPECT_NE(made.codes().find("W0407"), std::string::npos);
  EXPECT_NE(
      description_text(made.description()).find("outside the range assumed for its map (rate 400 Hz, assumed to 350)"),
      std::string::npos)
      << description_text(made.description());
}

TEST(Outside, ASizeThatNobodyAskedForIsSaidToo) {
  const Made made("roughness 0.5",
                  "    force felt = lateral(grating(x, period: 2.5 mm))\n    force drag = sticky(0.2 N)");
  const DescribedPercept stickiness = percept(made.description(), "stickiness");
  ASSERT_EQ(stickiness.outside.size(), 1u);
  EXPECT_EQ(in_words(stickiness.outside[0]), "drag 0.2 N, assumed from 0.43");
  EXPECT_EQ(stickiness.evidence(), Evidence::extrapolated);
}

// ---- assumed ----

TEST(Assumed, FiguresAreMarkedWhereTheyAreUsed) {
  const Made made("stickiness 0.6", "    force = sticky()");
  const Json json = made.json()["percepts"]["stickiness"];
  EXPECT_EQ(json["assumed"], (Json{"drag", "scatter"}));
  EXPECT_NE(description_text(made.description()).find("(scatter assumed)"), std::string::npos);
  const Made rough("roughness 0.6", "    force = lateral(grating(x, period: 2.5 mm))");
  EXPECT_EQ(rough.json()["percepts"]["roughness"]["assumed"], (Json{"crest", "spread", "noise"}));
  const std::string text = description_text(rough.description());
  EXPECT_NE(text.find("(spread and noise assumed)"), std::string::npos) << text;
  EXPECT_EQ(text.find("(scatter assumed)"), std::string::npos) << text;
}

}  // namespace
}  // namespace wale::asked_and_read_test
