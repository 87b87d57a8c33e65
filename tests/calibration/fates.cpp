// Fates of percepts follow the parameters, and `describe` gives the values at which they change. The expectations come
// from the closed forms of the publications and the device's 10 N.

#include <gtest/gtest.h>

#include <cmath>

#include "compiler/describe/fates_at.hpp"
#include "tests/calibration/declared.hpp"

namespace wale::fates_test {
namespace {

using calibrating::bank_at;
using calibrating::Declared;

// The force of each level on the joystick of 1995, in N, by level 1 and the exponent of the publication. Viscosity
// counts at 0.25 m/s, springiness at 40 mm.
double roughness_newton(double level) { return 194 * 10.0 / 512 * std::pow(level, 1 / 0.759593); }
double viscosity_newton(double level) { return 0.25 * 10 * std::pow(level, 1 / 0.44); }
double springiness_newton(double level) { return 0.04 * 200 * level; }

const DescribedFate& fate(const std::vector<DescribedFate>& all, const std::string& name) {
  for (const DescribedFate& each : all)
    if (each.record.name == name) return each;
  throw std::runtime_error("there is no fate of " + name);
}

const FateChange* change(const DescribedFate& fate, const std::string& parameter, bool above) {
  for (const FateChange& each : fate.changes)
    if (each.parameter == parameter && each.above == above) return &each;
  return nullptr;
}

TEST(FatesAt, FollowTheParameters) {
  Declared declared("material m { perceptual { roughness 0.6; springiness 0.6; viscosity 0.9 } }\n");
  const Program program = declared.program();
  const auto usual = fates_at(Bank(program), declared.declarations());
  for (const DescribedFate& each : usual) {
    EXPECT_EQ(each.record.fate, Fate::approximated) << each.record.name;
    EXPECT_EQ(each.record.reason.find("gives no more"), std::string::npos);
  }
  // The last percept saturates where the others leave less force than it needs.
  const DescribedFate& viscosity = fate(usual, "viscosity");
  const double left = 10 - viscosity_newton(0.9);
  const FateChange* springier = change(viscosity, "springiness", true);
  ASSERT_TRUE(springier);
  EXPECT_EQ(springier->fate, Fate::saturated);
  EXPECT_NEAR(springier->value, (left - roughness_newton(0.6)) / 8, 1e-3);
  const FateChange* rougher = change(viscosity, "roughness", true);
  ASSERT_TRUE(rougher);
  EXPECT_NEAR(roughness_newton(rougher->value), left - springiness_newton(0.6), 5e-3);
  EXPECT_EQ(viscosity.changes.size(), 2u);
  EXPECT_TRUE(fate(usual, "roughness").changes.empty());

  const auto springy = fates_at(bank_at(program, {{"springiness", 0.9}, {"roughness", 0.4}}), declared.declarations());
  const FateRecord& less = fate(springy, "viscosity").record;
  EXPECT_EQ(less.fate, Fate::saturated);
  EXPECT_NE(less.reason.find("`sandpaper` gives no more to all together; rendered as viscous()"), std::string::npos)
      << less.reason;
  EXPECT_FLOAT_EQ(less.asked, 0.9f);
  EXPECT_NEAR(viscosity_newton(less.given), 10 - roughness_newton(0.4) - springiness_newton(0.9), 1e-3);
  // Below the level that the rest of the force allows, it is not saturated.
  const FateChange* milder = change(fate(springy, "viscosity"), "viscosity", false);
  ASSERT_TRUE(milder);
  EXPECT_EQ(milder->fate, Fate::approximated);
  EXPECT_NEAR(milder->value, less.given, 2e-3);
}

TEST(FatesAt, AreThoseOfTheProgramAtItsDefaults) {
  Declared declared(
      "material m { perceptual { roughness 1; viscosity 1; springiness 0.8 } }\n"
      "material shared { perceptual { roughness 0.3 }\n"
      "  physical { force = lateral(grating(x, period: 2 mm)) + viscous(1 N s/m) } }\n");
  for (const char* material : {"m", "shared"})
    for (const char* device : {"sandpaper", "falcon", "touch_pad", "gamepad"}) {
      const Program program = declared.program(material, device);
      const auto found = fates_at(Bank(program), declared.declarations());
      const auto& recorded = program.description().fates;
      ASSERT_EQ(found.size(), recorded.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].record.fate, recorded[i].fate) << recorded[i].name << " on " << device;
        EXPECT_EQ(found[i].record.reason, recorded[i].reason) << recorded[i].name << " on " << device;
        EXPECT_NEAR(found[i].record.given, recorded[i].given, 1e-3) << recorded[i].name << " on " << device;
      }
    }
}

TEST(FatesAt, GiveAParameterInItsUnit) {
  Declared declared(
      "material m { perceptual { roughness 1 }\n  physical {\n    param b = 1 N s/m in 0 N s/m .. 60 N s/m\n"
      "    force ribs = lateral(grating(x, period: 2 mm))\n    force oil = viscous(b)\n  }\n}\n");
  const auto found = fates_at(Bank(declared.program()), declared.declarations());
  const FateChange* thicker = change(fate(found, "roughness"), "b", true);
  ASSERT_TRUE(thicker);
  EXPECT_NEAR(thicker->value, (10 - roughness_newton(1)) / 0.25, 0.1);
  EXPECT_EQ(thicker->unit, "N s/m");
  EXPECT_NE(changes_text(fate(found, "roughness")).find("saturated above b 24."), std::string::npos);
}

}  // namespace
}  // namespace wale::fates_test
