// wale compare: a force and its mirror image, or the same force turned about, are never called alike.

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "compiler/compare/compare.hpp"
#include "compiler/modules/load_modules.hpp"
#include "tests/standard/standard.hpp"

namespace wale::compare_test {
namespace {

struct OneOfAKind {
  const char* name;
  const char* forces;  ///< of which `P` is the sign, `X` and `Y` are the axes, and `U` and `V` the vectors along them
};

/// A formula mirrored (`sign`), and turned by a right angle.
std::string laid(std::string text, const std::string& sign, bool turned) {
  const std::map<char, std::string> words = {{'P', sign},
                                             {'X', turned ? "y" : "x"},
                                             {'Y', turned ? "x" : "y"},
                                             {'U', turned ? "vector(0, 1)" : "vector(1, 0)"},
                                             {'V', turned ? "vector(1, 0)" : "vector(0, 1)"}};
  std::string found;
  for (const char each : text) {
    const auto word = words.find(each);
    found += word == words.end() ? std::string(1, each) : word->second;
  }
  return "active 3 W\nforce = " + found;
}

Cues cues_of_force(const std::string& statements) {
  static const auto common = common_modules();
  return cues_of(Bank(standard::material("material m { physical {\n" + statements + "\n} }", "m")),
                 common->declarations);
}

Verdict between(const std::string& one, const std::string& other) {
  static const auto common = common_modules();
  return Comparer(common->declarations, default_device).compare(cues_of_force(one), cues_of_force(other)).verdict;
}

TEST(CompareLimits, AreNeverCalledAlike) {
  const std::string spring = "active 3 W\nforce = -vector(150 N/m * x, 90 N/m * y)";
  EXPECT_NE(between(spring, spring + " limit 5 N"), Verdict::alike);
  EXPECT_NE(between(spring + " limit 2 N", spring + " limit 5 N"), Verdict::alike);
  EXPECT_EQ(between(spring + " limit 5 N", spring + " limit 5 N"), Verdict::alike);
  const std::string flat = "active 3 W\nforce = firm(600 N/m, face: 40 mm) limit 8 N";
  const std::string round =
      "active 3 W\nforce = (if length(hand) > 40 mm then -600 N/m * (length(hand) - 40 mm) * normalise(hand) else "
      "vector(0 N, 0 N)) limit 8 N";
  EXPECT_NE(between(flat, round), Verdict::alike);
}

TEST(CompareMirrors, ASignIsHeard) {
  const OneOfAKind all[] = {
      {"push", "P * 1 N * U"},
      {"step", "P * (if X > 10 mm then 1 N else 0 N) * U"},
      {"step across", "P * (if X > 10 mm then 1 N else 0 N) * V"},
      {"side of a step", "(if P * X > 10 mm then 1 N else 0 N) * U"},
      {"ridge of steps", "P * (if abs(X) < 20 mm then 1 N else 0 N) * U"},
      {"two steps", "P * ((if X > 10 mm then 1 N else 0 N) + (if X > 30 mm then 0.6 N else 0 N)) * U"},
      {"spring", "P * 40 N/m * hand"},
      {"swirl", "P * 20 N/m * perpendicular(hand)"},
      {"aside", "P * 3 N s/m * perpendicular(velocity)"},
      {"one way", "(if P * velocity.X > 0 m/s then -6 N s/m * velocity.X else 0 N) * U"},
      {"viscosity", "P * 3 N s/m * velocity.X * U"},
      {"mass", "P * 0.2 kg * acceleration"},
      {"late", "P * (if time > 3 s then 2 N else 0 N) * U"},
      {"later", "P * (if time > 12 s then 2 N else 0 N) * U"},
      {"button", "P * (if button then 2 N else 0 N) * U"},
      {"travelling", "1 N * sin(2 pi * (X / 4 mm - P * phase(2 Hz))) * U"},
      {"travelling fast", "1 N * sin(2 pi * (X / 7 mm - P * phase(40 Hz))) * U"},
      {"travelling slowly", "1 N * sin(2 pi * (X / 20 mm - P * phase(0.2 Hz))) * U"},
      {"travelling aslant", "1 N * sin(2 pi * (X / 9 mm + Y / 12 mm - P * phase(3 Hz))) * V"},
      {"jumping on", "1 N * sign(sin(2 pi * (X / 6 mm - P * phase(2 Hz)))) * U"},
      {"sawtooth", "P * 1 N * (2 * fract(X / 5 mm) - 1) * U"},
      {"sawtooth across", "P * 1 N * (2 * fract(X / 5 mm) - 1) * V"},
      {"pulses", "P * ((if fract(X / 10 mm) < 0.1 then 1 N else 0 N) - 0.1 N) * U"},
      {"pulses across", "P * ((if fract(X / 10 mm) < 0.1 then 1 N else 0 N) - 0.1 N) * V"},
      {"sawtooth on a wave", "(P * 1 N * (2 * fract(X / 5 mm) - 1) + 0.8 N * sin(2 pi * X / 13.3 mm)) * U"},
      {"wall", "(if P * X > 20 mm then -P * 300 N/m * (P * X - 20 mm) else 0 N) * U"}};
  for (const OneOfAKind& each : all)
    for (const bool turned : {false, true}) {
      const std::string one = laid(each.forces, "1", turned), other = laid(each.forces, "(-1)", turned);
      EXPECT_NE(between(one, other), Verdict::alike) << each.name << '\n' << one;
      EXPECT_EQ(between(one, one), Verdict::alike) << each.name << '\n' << one;
    }
}

TEST(CompareMirrors, AnAxisIsHeard) {
  const OneOfAKind all[] = {{"square", "-8 N s^2/m^2 * velocity.X * abs(velocity.X) * U"},
                            {"cube", "-30 N s^3/m^3 * velocity.X^3 * U"},
                            {"step", "(if X > 10 mm then 1 N else 0 N) * vector(0.7, 0.7)"},
                            {"noise", "2 N * (noise(time / 50 ms) - 0.5) * U"},
                            {"crossed", "0.5 N * sin(2 pi * X / 3 mm) * U + 0.5 N * sin(2 pi * Y / 7 mm) * V"},
                            {"sway", "1 N * sin(2 pi * phase(2 Hz)) * U"}};
  for (const OneOfAKind& each : all) {
    const std::string one = laid(each.forces, "1", false), other = laid(each.forces, "1", true);
    EXPECT_NE(between(one, other), Verdict::alike) << each.name << '\n' << one;
    EXPECT_EQ(between(other, other), Verdict::alike) << each.name << '\n' << other;
  }
}

TEST(CompareMirrors, WhereTheOriginLiesIsNotFelt) {
  const char* const all[] = {"vector(0.5 N * sin(2 pi * (x + S) / 2 mm) + 0.5 N * sin(2 pi * (x + S) / 2.718 mm), 0 N)",
                             "vector(0.5 N * sin(2 pi * (x + S) / 3 mm), 0.5 N * sin(2 pi * (y + S) / 7 mm))",
                             "vector(1 N * sin(2 pi * ((x + S) / 4 mm - phase(2 Hz))), 0 N)",
                             "vector(1 N * (2 * fract((x + S) / 5 mm) - 1), 0 N)",
                             "vector((if fract((x + S) / 10 mm) < 0.1 then 1 N else 0 N) - 0.1 N, 0 N)"};
  for (std::string force : all) {
    const auto shifted = [&](const std::string& by) {
      std::string text = "active 3 W\nforce = " + force;
      for (std::size_t at; (at = text.find('S')) != std::string::npos;) text.replace(at, 1, by);
      return text;
    };
    EXPECT_EQ(between(shifted("0 mm"), shifted("17.3 mm")), Verdict::alike) << force;
    EXPECT_EQ(between(shifted("0 mm"), shifted("5.1 mm")), Verdict::alike) << force;
  }
}

TEST(CompareMirrors, TheRateOfANoiseAndTheTimeOfAForceAreHeard) {
  const auto noise = [](const char* time) {
    return "active 2 W\nforce = vector(2 N * (noise(time / " + std::string(time) + ") - 0.5), 0 N)";
  };
  EXPECT_NE(between(noise("50 ms"), noise("5 ms")), Verdict::alike);
  EXPECT_EQ(between(noise("50 ms"), noise("50 ms, seed: 3")), Verdict::alike);
  const auto late = [](const char* time) {
    return "active 2 W\nforce = vector(if time > " + std::string(time) + " then 2 N else 0 N, 0 N)";
  };
  EXPECT_NE(between(late("1 s"), late("5 s")), Verdict::alike);
  EXPECT_NE(between(late("12 s"), late("40 s")), Verdict::alike);
}

}  // namespace
}  // namespace wale::compare_test
