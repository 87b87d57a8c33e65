// Every law and its inverse against closed forms, and the shipped maps against the exponents of their publications.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>

#include "compiler/solve/law.hpp"
#include "tests/calibration/declared.hpp"

namespace wale {
namespace {

using calibrating::Declared;

/// A percept `grit` with level 1 at the amplitude `one`, and a map `test.map` with the given law.
Declared grit(const std::string& law, const std::string& one = "4 N", const std::string& more = "") {
  return Declared(
      "percept grit { one lateral amplitude " + one +
      " on sandpaper }\nmap grit from amplitude {\n  name test.map\n  " + law + "\n  " + more +
      "\n  valid amplitude 0.1 N .. 4 N\n  scatter 0.05\n"
      "  evidence slope measured, anchor measured, handle measured\n  on sandpaper\n  source \"a test\"\n}\n");
}

TEST(PowerLaw, AndItsInverse) {
  const Declared declared = grit("law magnitude = 2 * (amplitude / 1 N)^1.7");
  const Law law(declared.map("test.map"), declared.percept("grit"));
  for (const double size : {0.05, 0.3, 1.0, 4.0, 9.0}) {
    EXPECT_NEAR(law.magnitude_of(size), 2 * std::pow(size, 1.7), 1e-12 * std::pow(size, 1.7));
    EXPECT_NEAR(law.level_of(size), std::pow(size / 4, 1.7), 1e-12);
    EXPECT_NEAR(law.carrier_of(std::pow(size / 4, 1.7)), size, 1e-12 * size);
    EXPECT_NEAR(law.exponent_at(size), 1.7, 1e-6);
  }
  EXPECT_EQ(law.carrier_of(0), 0);
  EXPECT_TRUE(law.reaches(0.001) && law.reaches(1));
}

TEST(LogLinearLaw, AndItsInverse) {
  const Declared declared = grit("law log10(magnitude) = 0.8 * log10(amplitude / 1 N) + 0.3");
  const Law law(declared.map("test.map"), declared.percept("grit"));
  for (const double size : {0.05, 0.3, 1.0, 4.0}) {
    EXPECT_NEAR(law.magnitude_of(size), std::pow(10, 0.3) * std::pow(size, 0.8), 1e-12);
    EXPECT_NEAR(law.carrier_of(std::pow(size / 4, 0.8)), size, 1e-12);
  }
}

TEST(LinearLaw, WithAMagnitudeAboveZeroAtNoForce) {
  const Declared declared = grit("law magnitude = 2 + 3 * amplitude / 1 N", "1 N");
  const Law law(declared.map("test.map"), declared.percept("grit"));
  for (const double size : {0.05, 0.3, 1.0, 4.0}) {
    EXPECT_NEAR(law.magnitude_of(size), 2 + 3 * size, 1e-12);
    EXPECT_NEAR(law.level_of(size), (2 + 3 * size) / 5, 1e-12);
    EXPECT_NEAR(law.carrier_of((2 + 3 * size) / 5), size, 1e-12);
  }
  EXPECT_TRUE(law.reaches(0.4));
  EXPECT_FALSE(law.reaches(0.39)) << "without force the level is 2 / 5";
  EXPECT_NEAR(law.exponent_at(1), 3.0 / 5, 1e-6);
}

/// log10 magnitude = 0.5 u - 2 u^2 of u = log10 of newtons: an inverted U whose vertex is at u = 1/8.
constexpr const char* inverted = "law log10(magnitude) = 0.5 * log10(amplitude / 1 N) - 2 * log10(amplitude / 1 N)^2";

TEST(QuadraticLaw, OnEitherBranch) {
  for (const bool rising : {true, false}) {
    const Declared declared = grit(inverted, "1 N", rising ? "branch rising" : "branch falling");
    const Law law(declared.map("test.map"), declared.percept("grit"));
    for (const double level : {0.01, 0.3, 0.9, 1.0, 1.05}) {
      // 2 u^2 - 0.5 u + log10(level) = 0
      const double root = std::sqrt(0.25 - 8 * std::log10(level));
      const double u = (0.5 + (rising ? -root : root)) / 4;
      EXPECT_NEAR(law.carrier_of(level), std::pow(10, u), 1e-9 * std::pow(10, u)) << level << rising;
      EXPECT_NEAR(law.level_of(std::pow(10, u)), level, 1e-9);
    }
    // The largest level is that of the vertex, 10^(1/32).
    EXPECT_TRUE(law.reaches(std::pow(10, 1.0 / 32) - 1e-3));
    EXPECT_FALSE(law.reaches(std::pow(10, 1.0 / 32) + 1e-3));
    EXPECT_NEAR(law.carrier_of(2), std::pow(10, 0.125), 1e-9) << "the vertex is nearest";
    EXPECT_NEAR(law.exponent_at(1), 0.5, 1e-6);
  }
}

TEST(QuadraticLaw, NeedsABranchWhereItTurnsWithinItsRange) {
  const Declared turning = grit(inverted);
  EXPECT_TRUE(std::isnan(Law(turning.map("test.map"), turning.percept("grit")).carrier_of(0.5)));
  // A law that rises over its whole range needs no branch; the vertex of this one is at 10^1.25 N.
  const Declared rising = grit("law log10(magnitude) = log10(amplitude / 1 N) - 0.4 * log10(amplitude / 1 N)^2");
  const Law law(rising.map("test.map"), rising.percept("grit"));
  for (const double size : {0.1, 0.5, 1.0, 4.0}) EXPECT_NEAR(law.carrier_of(law.level_of(size)), size, 1e-9);
  const Declared square = grit("law magnitude = (amplitude / 1 N)^2 + amplitude / 2 N");
  const Law by_formula(square.map("test.map"), square.percept("grit"));
  EXPECT_NEAR(by_formula.carrier_of(0.5), (-0.5 + std::sqrt(0.25 + 4 * 0.5 * 18)) / 2, 1e-9);
}

TEST(TabulatedLaw, IsStraightInLogarithms) {
  const Declared declared = grit("table 0.1 N = 0.2, 1 N = 2, 4 N = 3");
  const Law law(declared.map("test.map"), declared.percept("grit"));
  const double last = std::log(3.0 / 2) / std::log(4.0);  // the exponent of the last segment; that of the first is 1
  const auto magnitude = [&](double size) { return size < 1 ? 2 * size : 2 * std::pow(size, last); };
  for (const double size : {0.05, 0.1, 0.3, 1.0, 2.0, 4.0, 6.0}) {
    EXPECT_NEAR(law.magnitude_of(size), magnitude(size), 1e-9) << size;
    EXPECT_NEAR(law.carrier_of(magnitude(size) / 3), size, 1e-9) << size;
  }
}

TEST(TabulatedLaw, MayFallButNotTurnBack) {
  const Declared falling = grit("table 0.1 N = 8, 1 N = 2, 4 N = 1");
  const Law law(falling.map("test.map"), falling.percept("grit"));
  for (const double size : {0.1, 0.3, 2.0, 4.0}) EXPECT_NEAR(law.carrier_of(law.level_of(size)), size, 1e-9);
  EXPECT_NEAR(law.level_of(std::sqrt(0.1)), 4, 1e-9);  // halfway, by ratio, between 8 and 2
  const Declared turning = grit("table 0.1 N = 1, 1 N = 3, 4 N = 2");
  EXPECT_TRUE(std::isnan(Law(turning.map("test.map"), turning.percept("grit")).carrier_of(0.5)));
}

TEST(CoupledLaw, UsesTheSizeOfTheOtherCarrier) {
  const Declared declared =
      grit("law magnitude = (amplitude / 1 N)^0.8 * (1 + viscosity / 10 N s/m)", "4 N", "couples viscosity viscosity");
  const Law law(declared.map("test.map"), declared.percept("grit"));
  for (const double viscosity : {0.0, 2.0, 10.0}) {
    const double level = 0.5, size = 4 * std::pow(level / (1 + viscosity / 10), 1 / 0.8);
    EXPECT_NEAR(law.carrier_of(level, {viscosity}), size, 1e-12);
    EXPECT_NEAR(law.level_of(size, {viscosity}), level, 1e-12);
  }
  EXPECT_EQ(law.carrier_of(0.5), law.carrier_of(0.5, {0.0}));
}

/// The exponent of a shipped map as published, and the carrier's size at level 1 in SI units.
struct Published {
  std::string percept;
  double exponent, one;
  bool of_carrier = true;  ///< of the percept's own carrier, not of a vibration in its place
};

/// Independent of calibration/maps; by the name of the map.
const std::map<std::string, Published> published = {
    {"minsky1995.figure19", {"roughness", 0.759593, 194 * 10.0 / 512}},
    {"estimates.bumps", {"bumpiness", 0.76, 3}},
    {"harper1964.squeezing", {"hardness", 0.8, 1000}},
    {"estimates.crispness", {"crispness", 1, 8}},
    {"varadharajan2008.spring", {"springiness", 1, 200}},
    {"smith1996.line", {"stickiness", 1, 1}},
    {"stevens1964.stirring", {"viscosity", 0.44, 10}},
    {"stevens1975.lifting", {"heaviness", 1.45, 0.2}},
    {"stevens1975.vibration_60", {"vibration", 0.95, 2}},
    {"verrillo1970.hand", {"vibration", 0.89, 2}},
    {"estimates.shaken_roughness", {"roughness", 0.76, 12, false}},
    {"estimates.shaken_vibration", {"vibration", 0.89, 12, false}},
};

TEST(ShippedMaps, AreTheClosedFormsOfTheirExponents) {
  const Declared declared("");
  std::size_t tied = 0;
  for (const Map* map : declared.declarations().maps()) {
    EXPECT_FALSE(map->name.empty()) << map->source;
    EXPECT_FALSE(map->source.empty());
    if (!map->tied) continue;
    ++tied;
    ASSERT_TRUE(published.contains(map->name)) << map->name;
    const Published& known = published.at(map->name);
    EXPECT_EQ(map->percept, known.percept);
    const Law law(*map, declared.percept(known.percept));
    for (const double level : {0.05, 0.1, 0.25, 0.5, 0.6, 0.9, 1.0}) {
      const double size = known.one * std::pow(level, 1 / known.exponent);
      EXPECT_NEAR(law.carrier_of(level), size, 1e-9 * known.one) << map->name << " at " << level;
      EXPECT_NEAR(law.level_of(size), level, 1e-9) << map->name;
    }
  }
  EXPECT_EQ(tied, published.size());
}

TEST(ShippedMaps, LevelOneIsThatOfThePublicationOrDefinition) {
  const Declared declared("");
  std::map<std::string, double> ones;
  declared.declarations().percepts.each([&](const std::string& name, const Percept& percept) {
    if (percept.has_reference) ones[name] = percept.one;
    EXPECT_FALSE(percept.documentation.empty()) << name;
    EXPECT_FALSE(percept.words.empty()) << name;
    EXPECT_NE(percept.extractor, Extractor::none) << name;
  });
  std::set<std::string> with_maps;
  for (const auto& [name, known] : published) {
    EXPECT_NEAR(known.of_carrier ? ones.at(known.percept) : known.one, known.one, 1e-12) << name;
    with_maps.insert(known.percept);
  }
  for (const auto& [name, one] : ones) EXPECT_TRUE(with_maps.contains(name)) << name << " has levels and no map";
  EXPECT_FALSE(declared.percept("sharpness").has_reference);
  EXPECT_FALSE(declared.percept("regularity").has_reference);
}

TEST(ShippedMaps, MapsThatAreNotTiedToTheReferenceHaveTheirExponents) {
  const Declared declared("");
  const Map& groove = declared.map("kornbrot2007.groove");
  EXPECT_FALSE(groove.tied);
  EXPECT_FALSE(groove.of_carrier);
  const Law law(groove, declared.percept("roughness"));
  EXPECT_NEAR(law.exponent_at(0.002), -0.80, 1e-6);
  EXPECT_NEAR(Law(declared.map("minsky1995.without_earplugs"), declared.percept("roughness")).exponent_at(1), 0.6,
              1e-6);
  EXPECT_NEAR(Law(declared.map("minsky1995.with_earplugs"), declared.percept("roughness")).exponent_at(1), 1.2, 1e-6);
}

/// Eleven observers have 0.6, three 0.9 and one 2.1 (sections 5.3.1 and 5.6.1; 1.2 with earplugs is the mean of the
/// last four). Their mean is the pooled slope, and their standard deviation is the spread of the map.
TEST(Minsky1995, SpreadOfTheObserversExponents) {
  double sum = 0, squares = 0;
  const auto add = [&](int count, double exponent) { sum += count * exponent, squares += count * exponent * exponent; };
  add(11, 0.6), add(3, 0.9), add(1, 2.1);
  EXPECT_NEAR(sum / 15, 0.76, 1e-9);
  EXPECT_NEAR((3 * 0.9 + 2.1) / 4, 1.2, 1e-9);
  const Declared declared("");
  EXPECT_NEAR(declared.map("minsky1995.figure19").uncertainty.spread, std::sqrt((squares - sum * sum / 15) / 14),
              0.005);
}

/// At constant height the force of a grating is proportional to 1 / period, so Minsky's map must have nearly the
/// exponent of Kornbrot's.
TEST(CrossCheck, ConstantHeightHasNearlyTheExponentOfKornbrot) {
  Declared declared(
      "material grooves {\n  physical {\n    param period = 2 mm in 0.7 mm .. 10 mm\n"
      "    force = lateral(grating(x, period: period), amplitude: 1 N mm / period)\n  }\n}\n");
  const Program program = declared.program();
  const auto magnitude = [&](double period) {
    const Bank bank = calibrating::bank_at(program, {{"period", period}});
    return predict(bank, 0, amplitude(bank, 0)).magnitude;
  };
  const double slope = std::log(magnitude(0.01) / magnitude(0.0007)) / std::log(0.01 / 0.0007);
  const double theirs = Law(declared.map("kornbrot2007.groove"), declared.percept("roughness")).exponent_at(0.002);
  EXPECT_NEAR(slope, -0.7596, 1e-3);
  EXPECT_NEAR(slope, theirs, 0.05);
}

}  // namespace
}  // namespace wale
