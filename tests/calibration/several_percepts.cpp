// Several percepts in one material, each with its own carrier: sizes against the closed forms of the publications,
// computed independently here, and forces against textbook formulas.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "tests/calibration/declared.hpp"
#include "wale/memory.hpp"

namespace wale {
namespace {

using calibrating::bank_at;
using calibrating::Declared;
using calibrating::percept_index;

/// The carrier's size at a level, by the published exponents and reference stimuli, in SI units.
double size_of(const std::string& percept, double level) {
  static const std::map<std::string, std::pair<double, double>> closed_forms = {
      {"roughness", {194 * 10.0 / 512, 0.759593}},
      {"viscosity", {10, 0.44}},
      {"stickiness", {1, 1}},
      {"springiness", {200, 1}},
      {"hardness", {1000, 0.8}},
      {"vibration", {2, 0.89}},
      {"heaviness", {0.2, 1.45}},
      {"bumpiness", {3, 0.76}},
      {"crispness", {8, 1}}};
  const auto& [one, exponent] = closed_forms.at(percept);
  return one * std::pow(level, 1 / exponent);
}

const std::string five =
    "material m {\n  perceptual {\n    roughness 0.3\n    viscosity 0.4\n    stickiness 0.5\n    springiness 0.1\n"
    "    vibration 0.2\n  }\n  physical {\n    active 0.5 W\n    param period = 2 mm in 1 mm .. 5 mm\n"
    "    force a = lateral(grating(x, period: period))\n    force b = viscous()\n    force c = sticky()\n"
    "    force d = spring()\n    force e = vibrate()\n  }\n}\n";

TEST(FivePercepts, AreEachTheClosedFormOfTheirLevel) {
  const Program program = Declared(five).program();
  const Bank bank(program);
  for (const auto& [name, level] : std::map<std::string, double>{
           {"roughness", 0.3}, {"viscosity", 0.4}, {"stickiness", 0.5}, {"springiness", 0.1}, {"vibration", 0.2}}) {
    const std::size_t i = percept_index(program, name);
    const double size = size_of(name, level);
    EXPECT_NEAR(amplitude(bank, i), size, 1e-5 * size) << name;
    EXPECT_NEAR(predict(bank, i, amplitude(bank, i)).level, level, 1e-5) << name;
    EXPECT_FALSE(program.description().percepts[i].alone);
  }
  // Percepts are in the order of the file.
  EXPECT_EQ(program.description().percepts[0].name, "roughness");
  EXPECT_EQ(program.description().percepts[1].name, "viscosity");
}

TEST(FivePercepts, KeepTheirLevelsAtEveryCornerOfTheirRanges) {
  const Program program = Declared(five).program();
  for (int corner = 0; corner < 32; ++corner) {
    const auto level = [&](int i) { return corner >> i & 1 ? 0.35 : 0.15; };
    const std::map<std::string, double> levels = {{"roughness", level(0)},
                                                  {"viscosity", level(1)},
                                                  {"stickiness", level(2)},
                                                  {"springiness", level(3)},
                                                  {"vibration", level(4)}};
    auto values = levels;
    values["period"] = corner % 2 ? 0.001 : 0.005;
    const Bank bank = bank_at(program, values);
    for (const auto& [name, asked] : levels) {
      const std::size_t i = percept_index(program, name);
      EXPECT_NEAR(amplitude(bank, i), size_of(name, asked), 2e-5 * size_of(name, asked)) << name << corner;
      EXPECT_NEAR(predict(bank, i, amplitude(bank, i)).level, asked, 1e-5) << name << corner;
    }
  }
}

Hand moving(double x, double v, double a = 0) {
  Hand hand;
  hand.position = {static_cast<float>(x), 0};
  hand.velocity = {static_cast<float>(v), 0};
  hand.acceleration = {static_cast<float>(a), 0};
  return hand;
}

/// The force along x, in N, of a percept alone, rendered by the rule of the device.
double force_of(const std::string& percept, double level, const Hand& hand, const std::string& device = "sandpaper") {
  Declared declared("material m { perceptual { " + percept + " " + std::to_string(level) + " } }\n");
  Bank bank(declared.program("", device));
  return tick(bank, hand).x;
}

/// The same for a hand that has moved along x at that speed for 20 mm.
double force_after(const std::string& percept, double level, double speed, const std::string& device) {
  Declared declared("material m { perceptual { " + percept + " " + std::to_string(level) + " } }\n");
  const Program program = declared.program("", device);
  Bank bank(program);
  Memory memory(program);
  memory.enter(bank, moving(0, 0));
  double force = 0;
  const double step = speed / program.description().device.rate;
  for (double x = 0; std::abs(x) < 0.02; x += step) force = tick(bank, memory, moving(x, speed)).x;
  return force;
}

TEST(DeviceRules, GiveTheForcesOfTextbookFormulas) {
  for (const std::string device : {"sandpaper", "falcon"}) {
    const double b = size_of("viscosity", 0.5), k = size_of("springiness", 0.3), drag = size_of("stickiness", 0.6);
    EXPECT_NEAR(force_of("viscosity", 0.5, moving(0, 0.2), device), -b * 0.2, 1e-5);
    EXPECT_NEAR(force_of("springiness", 0.3, moving(0.02, 0.2), device), -k * 0.02, 1e-5);
    // Friction is the same at every speed, opposes the motion, and pushes no hand that has just come.
    for (const double v : {0.02, 0.3, -0.9})
      EXPECT_NEAR(force_after("stickiness", 0.6, v, device), std::copysign(drag, -v), 1e-5);
    EXPECT_EQ(force_of("stickiness", 0.6, moving(0, 0.2), device), 0);
    EXPECT_NEAR(force_of("heaviness", 0.4, moving(0, 0, 3), device), -3 * size_of("heaviness", 0.4), 1e-5);
    // The wall is right of 20 mm.
    EXPECT_NEAR(force_of("hardness", 0.4, moving(0.022, 0), device), -0.002 * size_of("hardness", 0.4), 1e-5);
    EXPECT_EQ(force_of("hardness", 0.4, moving(0.019, 0), device), 0);
    EXPECT_NEAR(force_of("crispness", 0.5, moving(0.021, 0.3), device), -0.3 * size_of("crispness", 0.5), 1e-5);
    EXPECT_EQ(force_of("crispness", 0.5, moving(0.021, -0.3), device), 0) << "it is free on the way out";
  }
}

/// The 99th percentile of the force along the patch without its rim, in N.
double pushed_over_the_patch(const std::string& percept, double level, const std::string& device) {
  Declared declared("material m { perceptual { " + percept + " " + std::to_string(level) + " } }\n");
  Bank bank(declared.program("", device));
  const double half = bank.size().width / 2 - bank.size().rim;
  constexpr int places = 20011;
  std::vector<double> forces;
  for (int i = 0; i < places; ++i) forces.push_back(std::abs(tick(bank, moving(half * (2.0 * i / places - 1), 0)).x));
  std::ranges::sort(forces);
  return forces[static_cast<std::size_t>(0.99 * places)];
}

TEST(DeviceRules, TexturesAndBumpsHaveTheForceOfTheirLevel) {
  for (const std::string device : {"sandpaper", "falcon"}) {
    for (const double level : {0.2, 0.6, 0.9}) {
      const double rough = size_of("roughness", level), bumpy = size_of("bumpiness", level);
      EXPECT_NEAR(pushed_over_the_patch("roughness", level, device), rough, 0.01 * rough);
      EXPECT_NEAR(pushed_over_the_patch("bumpiness", level, device), bumpy, 0.01 * bumpy);
    }
  }
}

TEST(DeviceRules, AVibrationShakesAHandAtRest) {
  Declared declared("material m { perceptual { vibration 0.5 } }\n");
  const Program program = declared.program();
  EXPECT_EQ(declared.codes(), "");
  Bank bank(program);
  Memory memory(program);
  memory.enter(bank, moving(0, 0));
  double squares = 0;
  for (int i = 0; i < 900; ++i) {  // 120 whole periods
    const double force = tick(bank, memory, moving(0, 0)).x;
    squares += force * force;
  }
  EXPECT_NEAR(std::sqrt(2 * squares / 900), size_of("vibration", 0.5), 1e-3);
}

TEST(DeviceRules, AddTheirForcesAndAreNamed) {
  Declared declared("material m { perceptual { viscosity 0.5; springiness 0.3 } }\n");
  const Program program = declared.program();
  Bank bank(program);
  EXPECT_NEAR(tick(bank, moving(0.02, 0.2)).x, -0.2 * size_of("viscosity", 0.5) - 0.02 * size_of("springiness", 0.3),
              1e-5);
  EXPECT_EQ(program.description().percepts[0].realisation, "viscous()");
  EXPECT_EQ(program.description().percepts[1].realisation, "spring()");
  EXPECT_EQ(Declared(five).program().description().percepts[0].realisation, "");
}

TEST(DeviceRules, OneFileBuildsForEachDevice) {
  Declared declared("material m { perceptual { roughness 0.6 } }\n");
  const Program here = declared.program("", "sandpaper"), there = declared.program("", "falcon");
  // Level 0.6 is 1.934 N on every device. On other devices than the one of the experiment, the evidence is weaker.
  EXPECT_NEAR(amplitude(Bank(here), 0), 1.934, 5e-4);
  EXPECT_NEAR(amplitude(Bank(there), 0), 1.934, 5e-4);
  EXPECT_EQ(here.description().percepts[0].handle, Evidence::measured);
  EXPECT_EQ(there.description().percepts[0].handle, Evidence::transferred);
  EXPECT_EQ(there.description().device.force_newton, 8);
}

TEST(Antonyms, AreTheSameScaleFromItsOtherEnd) {
  Declared declared("material soft { perceptual { softness 0.8 } }\nmaterial hard { perceptual { hardness 0.2 } }\n");
  const Program soft = declared.program("soft"), hard = declared.program("hard");
  EXPECT_NEAR(amplitude(Bank(soft), 0), size_of("hardness", 0.2), 1e-3);
  EXPECT_NEAR(amplitude(Bank(soft), 0), amplitude(Bank(hard), 0), 1e-4);
  EXPECT_TRUE(soft.parameter("hardness"));
  EXPECT_FALSE(soft.parameter("softness"));

  // The name of a level is the same place of the scale from either end. An antonym may also be an argument.
  Declared named(
      "material by_name { perceptual { softness soft } }\nmaterial firm { perceptual { hardness firm } }\n"
      "material softer = firm(softness: 0.8)\n");
  EXPECT_NEAR(amplitude(Bank(named.program("by_name")), 0), size_of("hardness", 0.2), 1e-3);
  EXPECT_NEAR(amplitude(Bank(named.program("firm")), 0), size_of("hardness", 0.5), 1e-3);
  EXPECT_NEAR(amplitude(Bank(named.program("softer")), 0), size_of("hardness", 0.2), 1e-3);
}

TEST(Choice, OfAMapIsTheAuthors) {
  Declared declared(
      "map roughness from amplitude {\n  name test.opinion\n  law magnitude = (amplitude / 1 N)^0.5\n"
      "  valid amplitude 0.1 N .. 5 N\n  scatter 0.05\n"
      "  evidence slope measured, anchor measured, handle measured\n  on sandpaper\n  source \"a test\"\n}\n"
      "material ours { perceptual { roughness 0.5, by test.opinion } }\n"
      "material theirs { perceptual { roughness 0.5, by minsky1995.figure19 } }\n");
  EXPECT_NEAR(amplitude(Bank(declared.program("ours")), 0), 194 * 10.0 / 512 * 0.25, 1e-5);
  EXPECT_NEAR(amplitude(Bank(declared.program("theirs")), 0), size_of("roughness", 0.5), 1e-5);
}

TEST(FixedCarriers, HaveAPerceptWhereTheyStandAlone) {
  Declared declared(
      "material oil { physical { force = viscous(3 N s/m) } }\n"
      "material rubbing { physical { force = hold(viscous(3 N s/m), 0.5 N) } }\n"
      "material half { physical { force = 0.5 * viscous(3 N s/m) } }\n"
      "material snow { physical { force = viscous(3 N s/m * clamp(x / 10 mm, 0, 1)) } }\n");
  const Program oil = declared.program("oil");
  const Bank bank(oil);
  const std::size_t i = percept_index(oil, "viscosity");
  EXPECT_NEAR(predict(bank, i, amplitude(bank, i)).level, std::pow(0.3, 0.44), 1e-5);
  EXPECT_EQ(oil.description().percepts[i].unit, "N s/m");
  for (const std::string name : {"rubbing", "half", "snow"})
    EXPECT_TRUE(declared.program(name).description().percepts.empty()) << name;
}

/// The order is roughness, viscosity, springiness. Each gets at most what those before it leave of 10 N.
TEST(Reduction, FollowsTheOrderOfTheFileForAllParameters) {
  Declared declared(
      "material m { perceptual { roughness 1; viscosity 1; springiness 0.8 } }\n"
      "material e { perceptual { roughness 1; viscosity 1; essential springiness 0.8 } }\n");
  const Program program = declared.program("m");
  EXPECT_EQ(declared.codes(), "W0421");
  for (const double r : {0.2, 0.7, 1.0})
    for (const double v : {0.1, 0.6, 1.0})
      for (const double s : {0.1, 0.5, 1.0}) {
        const Bank bank = bank_at(program, {{"roughness", r}, {"viscosity", v}, {"springiness", s}});
        double left = 10;
        const auto expect = [&](const std::string& name, double level, double reach) {
          const double size = std::min(size_of(name, level), left / reach);
          const std::size_t i = percept_index(program, name);
          EXPECT_NEAR(amplitude(bank, i), size, 1e-4 * size) << name << r << v << s;
          left -= size * reach;
        };
        expect("roughness", r, 1);
        expect("viscosity", v, 0.25);
        expect("springiness", s, 0.04);
        EXPECT_GE(left, -1e-9);
      }
  const Program essential = declared.program("e");
  const Bank bank(essential);
  EXPECT_NEAR(amplitude(bank, percept_index(essential, "springiness")), 160, 1e-3);
  EXPECT_NEAR(amplitude(bank, percept_index(essential, "roughness")), 10 - 6.4, 1e-4);
  EXPECT_NEAR(amplitude(bank, percept_index(essential, "viscosity")), 0, 1e-6);
}

TEST(Couples, KeepTheLevelTrueWhileTheOtherMoves) {
  Declared declared(
      "map stickiness from drag {\n  couples viscosity viscosity\n"
      "  law magnitude = drag / 1 N * (1 + viscosity / 20 N s/m)\n  valid drag 0.1 N .. 3 N\n  scatter 0.1\n"
      "  evidence slope estimated, anchor estimated, handle estimated\n  on sandpaper\n  source \"a test\"\n}\n"
      "material m { perceptual { stickiness 0.5; viscosity 0.5 } }\n"
      "material alone { perceptual { stickiness 0.5 } }\n"
      "material fixed { perceptual { stickiness 0.5 }\n  physical { force = sticky() + viscous(5 N s/m) } }\n");
  const Program program = declared.program("m");
  const std::size_t sticky = percept_index(program, "stickiness");
  for (const double v : {0.1, 0.5, 1.0}) {
    const Bank bank = bank_at(program, {{"viscosity", v}});
    EXPECT_NEAR(amplitude(bank, sticky), 0.5 / (1 + size_of("viscosity", v) / 20), 1e-5) << v;
    EXPECT_NEAR(predict(bank, sticky, amplitude(bank, sticky)).level, 0.5, 1e-5) << v;
  }
  EXPECT_NEAR(amplitude(Bank(declared.program("alone")), 0), 0.5, 1e-6);
  EXPECT_NEAR(amplitude(Bank(declared.program("fixed")), 0), 0.5 / 1.25, 1e-6);
}

/// The drag comes before the viscosity that its map couples, and the device's force allows only a part of that
/// viscosity. With v for the viscosity, the drag is s / (1 + v / 20). Both together are the force that roughness and
/// springiness leave of 10 N, so v is the positive root of a quadratic.
TEST(Couples, UseTheReducedSizeOfTheOther) {
  Declared declared(
      "map stickiness from drag {\n  couples viscosity viscosity\n"
      "  law magnitude = drag / 1 N * (1 + viscosity / 20 N s/m)\n  valid drag 0.1 N .. 3 N\n  scatter 0.1\n"
      "  evidence slope estimated, anchor estimated, handle estimated\n  on sandpaper\n  source \"a test\"\n}\n"
      "material m { perceptual { roughness 1; springiness 0.6; stickiness 0.5; viscosity 1 } }\n"
      "material turned { perceptual { roughness 1; springiness 0.6; viscosity 1; stickiness 0.5 } }\n");
  const Program program = declared.program("m");
  EXPECT_EQ(declared.codes(), "W0421");
  const auto at = [&](const Bank& bank, const std::string& name) {
    return amplitude(bank, percept_index(program, name));
  };
  bool met_part = false, met_whole = false, met_none = false;
  for (const double spring : {0.1, 0.5, 0.6, 0.7})
    for (const double s : {0.1, 0.3, 0.5, 1.0})
      for (const double full : {0.2, 1.0}) {
        const Bank bank = bank_at(program, {{"springiness", spring}, {"stickiness", s}, {"viscosity", full}});
        const double left = 10 - size_of("roughness", 1) - 0.04 * size_of("springiness", spring);
        const double most = size_of("viscosity", full);
        // 0.25 v + s / (1 + v / 20) = left
        const double b = 0.25 - left / 20, root = (-b + std::sqrt(b * b - 4 * 0.0125 * (s - left))) / (2 * 0.0125);
        const double v = s > left ? 0 : std::min(most, root);
        (v == 0 ? met_none : v < most ? met_part : met_whole) = true;
        const std::string where = testing::PrintToString(std::array{spring, s, full});
        EXPECT_NEAR(at(bank, "viscosity"), v, 2e-5) << where;
        EXPECT_NEAR(at(bank, "stickiness"), std::min(left, s / (1 + v / 20)), 2e-5) << where;
        const std::size_t sticky = percept_index(program, "stickiness");
        EXPECT_NEAR(predict(bank, sticky, amplitude(bank, sticky)).level, std::min(s, left), 2e-5) << where;
      }
  EXPECT_TRUE(met_part && met_whole && met_none);
  // In the other order the viscosity comes first and takes all the force that is left.
  const Program turned = declared.program("turned");
  const Bank bank(turned);
  const double left = 10 - size_of("roughness", 1) - 0.04 * size_of("springiness", 0.6);
  EXPECT_NEAR(amplitude(bank, percept_index(turned, "viscosity")), left / 0.25, 1e-4);
  EXPECT_NEAR(amplitude(bank, percept_index(turned, "stickiness")), 0, 1e-5);
}

/// One just noticeable difference of a force by the smallest published threshold (Pang, Tan and Durlach 1991): 7 %,
/// assumed to be that at d' = 1, and above the threshold's floor. The map's scatter is smaller.
TEST(Conflict, IsBeyondOneJustNoticeableDifference) {
  const auto agrees = [](double newton) {
    try {
      Declared(
          "percept grit { one lateral amplitude 4 N on sandpaper\n  cue amplitude }\n"
          "map grit from amplitude {\n  law magnitude = amplitude / 1 N\n  valid amplitude 0.1 N .. 4 N\n"
          "  scatter 0.001\n  evidence slope measured, anchor measured, handle measured\n  on sandpaper\n"
          "  source \"a test\"\n}\nmaterial m {\n  perceptual { grit 0.5 }\n"
          "  physical { force = lateral(grating(x, period: 2 mm), amplitude: " +
          std::to_string(newton) + " N) }\n}\n")
          .program();
      return true;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("error[W0403]"), std::string::npos) << error.what();
      return false;
    }
  };
  const double share = 0.07;
  EXPECT_TRUE(agrees(2));
  EXPECT_TRUE(agrees(2 * (1 + share) - 0.005));
  EXPECT_FALSE(agrees(2 * (1 + share) + 0.005));
  EXPECT_TRUE(agrees(2 / (1 + share) + 0.005));
  EXPECT_FALSE(agrees(2 / (1 + share) - 0.005));
}

TEST(Overdetermined, TwoPerceptsOfOneCarrierMustAgree) {
  const std::string grit =
      "percept grit { one lateral amplitude 194 pu on sandpaper\n  cue amplitude }\n"
      "map grit from amplitude {\n  law magnitude = (amplitude / 1 N)^0.759593\n  valid amplitude 0.1 N .. 4 N\n"
      "  scatter 0.01\n  evidence slope measured, anchor measured, handle measured\n  on sandpaper\n"
      "  source \"a test\"\n}\n";
  Declared agreeing(grit +
                    "material m { perceptual { roughness 0.6; grit 0.6 }\n"
                    "  physical { force = lateral(grating(x, period: 2 mm)) } }\n");
  const Program program = agreeing.program();
  const Bank bank = bank_at(program, {{"roughness", 0.4}});
  EXPECT_NEAR(amplitude(bank, percept_index(program, "grit")), size_of("roughness", 0.4), 1e-5);
  EXPECT_THROW(Declared(grit + "material m { perceptual { roughness 0.6; grit 0.3 }\n"
                               "  physical { force = lateral(grating(x, period: 2 mm)) } }\n")
                   .program(),
               std::runtime_error);
}

TEST(Lost, IsAnErrorOnlyWhereItIsEssential) {
  const std::string poor =
      "device poor {\n  workspace disc(100 mm)\n  position 2048 counts\n  force 5 N, 1024 counts\n  rate 1 kHz\n"
      "  speed 1 m/s\n  slew 100 N/s\n  velocity_filter 15, 1 counts\n  patch 80 mm, 80 mm, 4 mm\n"
      "  realise viscosity = viscous()\n}\n";
  Declared declared(poor + "material a { perceptual { viscosity 0.5; heaviness 0.5 } }\n");
  const Program program = declared.program("a", "poor");
  EXPECT_EQ(declared.codes(), "W0415");
  EXPECT_EQ(program.description().percepts.size(), 1u);
  Declared essential(poor + "material b { perceptual { viscosity 0.5; essential heaviness 0.5 } }\n");
  EXPECT_THROW(essential.program("b", "poor"), std::runtime_error);
  EXPECT_NO_THROW(
      Declared(poor + "material b { perceptual { viscosity 0.5; essential heaviness 0.5 } }\n").program("b"));
}

TEST(Sliders, NameThePerceptThatTheyDecalibrate) {
  Declared declared(
      "material m {\n  perceptual { roughness 0.5 }\n  physical {\n"
      "    param wear = 0.5 in 0 .. 1 \"so far\"\n    param period = 2 mm in 1 mm .. 5 mm \"from ridge to ridge\"\n"
      "    force = lateral(grating(x, period: period)) * (1 - wear * clamp(x / 1 mm, 0, 1))\n  }\n}\n");
  const Program program = declared.program();
  const auto& parameters = program.description().parameters;
  EXPECT_EQ(parameters[*program.parameter("wear")].description, "so far (decalibrates roughness)");
  EXPECT_EQ(parameters[*program.parameter("period")].description, "from ridge to ridge");
}

// The place of a wall is no factor, and a limit leaves its stiffness, as that of a spring; but a texture gets weaker.
TEST(Sliders, OfAWallAndOfALimitDecalibrateOnlyWhatTheyChange) {
  const auto description = [](const std::string& material, const std::string& parameter) {
    const Program program = Declared("material m { " + material + " }\n").program();
    return program.description().parameters[*program.parameter(parameter)].description;
  };
  const std::string top = " param top = 6 N in 1 N .. 9 N\n";
  EXPECT_EQ(description("perceptual { softness 0.8 } physical { param face = 12 mm in 5 mm .. 30 mm\n"
                        " force = firm(face: face) limit 8 N }", "face"), "");
  EXPECT_EQ(description("perceptual { hardness 0.5 } physical {" + top + "force = firm() limit top }", "top"), "");
  EXPECT_EQ(description("perceptual { springiness 0.5 } physical {" + top + "force = spring() limit top }", "top"), "");
  EXPECT_EQ(description("perceptual { roughness 0.5 } physical { param period = 2 mm in 1 mm .. 5 mm\n" + top +
                        "force = lateral(grating(x, period: period)) limit top }", "period"), "");
  EXPECT_EQ(description("perceptual { roughness 0.5 } physical {" + top +
                        "force = lateral(grating(x, period: 2 mm)) limit top }", "top"), "(decalibrates roughness)");
}

// A force that only a limit, a factor or a sign changes is alone: a run reads it back.
TEST(Records, AForceThatIsLimitedOrScaledIsAlone) {
  const auto alone = [](const std::string& material) {
    return Declared("material m { " + material + " }\n").program().description().percepts.at(0).alone;
  };
  EXPECT_TRUE(alone("perceptual { softness 0.8 } physical { force = firm() limit 8 N }"));
  EXPECT_TRUE(alone("perceptual { roughness 0.5 } physical { force = 2 * lateral(grating(x, period: 3 mm)) }"));
  EXPECT_TRUE(alone("perceptual { roughness 0.5 } physical { param g = 1 in 0 .. 2\n"
                    "force = g * lateral(grating(x, period: 3 mm)) / 2 limit 3 N }"));
  EXPECT_FALSE(alone("perceptual { roughness 0.5 } physical { force = 2 * lateral(grating(x, period: 3 mm)) + "
                     "spring(20 N/m) }"));
  EXPECT_FALSE(alone("perceptual { hardness 0.5 } physical { force a = firm() limit 8 N\n force b = sticky(0.3 N) }"));
}

TEST(Records, HoldTheFiguresForDescriptions) {
  const Program program = Declared(five).program();
  const PerceptRecord& roughness = program.description().percepts[percept_index(program, "roughness")];
  EXPECT_EQ(roughness.unit, "N");
  EXPECT_EQ(roughness.extractor, Extractor::lateral_force);
  EXPECT_FLOAT_EQ(roughness.period_low, 0.0007f);
  EXPECT_FLOAT_EQ(roughness.period_high, 0.01f);
  EXPECT_FLOAT_EQ(roughness.one, 194 * 10.0f / 512);
  EXPECT_EQ(roughness.uncertainty.observers, 15);
  EXPECT_EQ(roughness.uncertainty.stimuli, 30);
  // The smallest fraction is that of Pang, Tan and Durlach 1991; the floor is that of Tan 1992.
  EXPECT_NEAR(roughness.weber, 0.07, 1e-5);
  EXPECT_FLOAT_EQ(roughness.floor, 0.1f);
  EXPECT_EQ(roughness.weber_evidence, Evidence::transferred);
  EXPECT_EQ(roughness.map, "roughness from amplitude");
  const PerceptRecord& springiness = program.description().percepts[percept_index(program, "springiness")];
  EXPECT_EQ(springiness.unit, "N/m");
  EXPECT_EQ(springiness.extractor, Extractor::stiffness);
}

}  // namespace
}  // namespace wale
