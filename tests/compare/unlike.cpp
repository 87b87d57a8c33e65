// wale compare: materials that differ in one thing each are never called alike.

#include <gtest/gtest.h>

#include "compiler/compare/compare.hpp"
#include "compiler/modules/load_modules.hpp"
#include "tests/standard/standard.hpp"

namespace wale::compare_test {
namespace {

Verdict verdict_between(const std::string& one, const std::string& other) {
  static const auto common = common_modules();
  const auto read_of = [&](const std::string& statements) {
    return cues_of(Bank(standard::material("material m { physical {\n" + statements + "\n} }", "m")),
                   common->declarations);
  };
  return Comparer(common->declarations, default_device).compare(read_of(one), read_of(other)).verdict;
}

constexpr const char* ribs = "force = lateral(grating(x, period: 3 mm), amplitude: 1 N)";

TEST(CompareUnlike, AConstantPushTellsApartBesideAnyCue) {
  for (const std::string beside :
       {"lateral(grating(x, period: 3 mm), amplitude: 1 N)", "sticky(0.5 N)", "spring(80 N/m)", "firm(500 N/m)"}) {
    EXPECT_EQ(verdict_between("force = " + beside, "active 1 W\nforce = " + beside + " + vector(3 N, 0 N)"),
              Verdict::apart)
        << beside;
    EXPECT_EQ(verdict_between("force = " + beside, "force = " + beside), Verdict::alike) << beside;
  }
  EXPECT_EQ(verdict_between("force = vector(3 N, 0 N)", "force = vector(-3 N, 0 N)"), Verdict::apart);
}

TEST(CompareUnlike, AForceThatNoCueExplainsIsNotNothing) {
  for (const char* force :
       {"force = vector(if button then 8 N else 0 N, 0 N)",
        "active 2 W\nforce = vector(if time > 1 s then 3 N else 0 N, 0 N)",
        "active 2 W\nstate met = 0 in 0 .. 1\nnext met = if x > 20 mm then 1 else met\nforce = vector(3 N * met, 0 N)",
        "active 2 W\nforce = vector(3 N * sin(2 * pi * phase(0.2 Hz)), 0 N)",
        "force = 2 N s/m * perpendicular(velocity)"})
    EXPECT_EQ(verdict_between("force = vector(0 N, 0 N)", force), Verdict::apart) << force;
}

TEST(CompareUnlike, AWallsDampingAndAWallBesideATextureAreCompared) {
  EXPECT_EQ(verdict_between("force = firm(500 N/m) + crisp(2 N s/m)", "force = firm(500 N/m) + crisp(8 N s/m)"),
            Verdict::apart);
  EXPECT_EQ(verdict_between(ribs, ribs + std::string(" + firm(400 N/m)")), Verdict::apart);
  EXPECT_EQ(verdict_between(ribs + std::string(" + firm(500 N/m)"), ribs + std::string(" + firm(900 N/m)")),
            Verdict::apart);
}

TEST(CompareUnlike, SmallFeaturesAndHowAWallBeginsAndEndsAreCompared) {
  EXPECT_EQ(verdict_between("force = vector(0 N, 0 N)",
                            "force = vector(2 N * (if abs(x) < 0.5 mm then sin(2 * pi * x / 1 mm) else 0), 0 N)"),
            Verdict::apart);
  const auto wall = [](const char* law) {
    return "force = vector(if x > 20 mm then " + std::string(law) + " else 0 N, 0 N)";
  };
  const std::string plain = wall("-300 N/m * (x - 20 mm)");
  EXPECT_EQ(verdict_between(plain, wall("-3 N - 300 N/m * (x - 20 mm)")), Verdict::apart);
  EXPECT_EQ(verdict_between(plain, wall("-min(300 N/m * (x - 20 mm), 3 N)")), Verdict::apart);
  EXPECT_EQ(verdict_between(plain, plain), Verdict::alike);
}

// People's thresholds for these are not published.
TEST(CompareUnlike, ADifferenceOfDirectionOrGrainIsUnknown) {
  const std::pair<const char*, const char*> pairs[] = {
      {ribs, "force = lateral(grating(x, period: 3 mm) + grating(y, period: 3 mm), amplitude: 1 N)"},
      {"force = lateral(grating(length(hand), period: 2.5 mm), amplitude: 1 N)",
       "force = lateral(noise2(x / 2 mm, y / 2 mm), amplitude: 1 N)"},
      {"force = vector(1 N * sin(2 * pi * x / 3 mm), 0 N)", "force = vector(0 N, 1 N * sin(2 * pi * x / 3 mm))"},
      {"force = vector(-50 N/m * x, 0 N)", "force = vector(0 N, -50 N/m * y)"}};
  for (const auto& [one, other] : pairs) {
    EXPECT_EQ(verdict_between(one, other), Verdict::unknown) << one << '\n' << other;
    EXPECT_EQ(verdict_between(one, one), Verdict::alike) << one;
    EXPECT_EQ(verdict_between(other, other), Verdict::alike) << other;
  }
}

// A force has a way, and not only a size.
TEST(CompareUnlike, WhereAForcePushesTellsApart) {
  const std::pair<const char*, const char*> pairs[] = {
      {"force = vector(if button then 3 N else 0 N, 0 N)", "force = vector(if button then -3 N else 0 N, 0 N)"},
      {"active 2 W\nforce = vector(if time > 1 s then 3 N else 0 N, 0 N)",
       "active 2 W\nforce = vector(0 N, if time > 1 s then 3 N else 0 N)"},
      {"force = vector(2 N * (x / 8 mm) * exp(-(x / 8 mm)^2), 0 N)",
       "force = vector(-2 N * (x / 8 mm) * exp(-(x / 8 mm)^2), 0 N)"},
      {"force = 2 N * hand / 8 mm * exp(-dot(hand, hand) / 64 mm / 1 mm)",
       "force = -2 N * hand / 8 mm * exp(-dot(hand, hand) / 64 mm / 1 mm)"}};
  for (const auto& [one, other] : pairs) {
    EXPECT_EQ(verdict_between(one, other), Verdict::apart) << one << '\n' << other;
    EXPECT_EQ(verdict_between(one, one), Verdict::alike) << one;
    EXPECT_EQ(verdict_between(other, other), Verdict::alike) << other;
  }
}

TEST(CompareUnlike, AVibrationHasAnAxis) {
  const std::string along_x = "active 2 W\nforce = vector(0.5 N * sin(2 pi * phase(50 Hz)), 0 N)";
  const std::string along_y = "active 2 W\nforce = vector(0 N, 0.5 N * sin(2 pi * phase(50 Hz)))";
  const std::string round = "active 2 W\nforce = 0.5 N * vector(cos(2 pi * phase(50 Hz)), sin(2 pi * phase(50 Hz)))";
  EXPECT_EQ(verdict_between(along_x, along_y), Verdict::unknown);
  EXPECT_EQ(verdict_between(along_x, round), Verdict::unknown);
  for (const std::string& each : {along_x, along_y, round}) EXPECT_EQ(verdict_between(each, each), Verdict::alike);
}

// Of these a size is read, and nobody has measured how well people know it again.
TEST(CompareUnlike, ASizeWithoutAThresholdOfItsOwnIsNeverCalledAlike) {
  const std::pair<const char*, const char*> pairs[] = {
      {"force = vector(if button then 2 N else 0 N, 0 N)", "force = vector(if button then 2.1 N else 0 N, 0 N)"},
      {"force = -2 N s/m * (1 + x / 100 mm) * velocity", "force = -2 N s/m * (1 + x / 106 mm) * velocity"},
      {"force = viscous(4 N s/m)", "force = viscous(4 N s/m) limit 1 N"}};
  for (const auto& [one, other] : pairs) {
    EXPECT_NE(verdict_between(one, other), Verdict::alike) << one << '\n' << other;
    EXPECT_EQ(verdict_between(one, one), Verdict::alike) << one;
    EXPECT_EQ(verdict_between(other, other), Verdict::alike) << other;
  }
}

}  // namespace
}  // namespace wale::compare_test
