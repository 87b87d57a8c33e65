// What comes and goes with time, alone and beside a vibration, and what remains all the time.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <string>

#include "compiler/modules/load_modules.hpp"
#include "compiler/read/read.hpp"
#include "compiler/read/tolerances.hpp"
#include "tests/standard/standard.hpp"

namespace wale::slowly_test {
namespace {

ForceReading read_of(const std::string& force) {
  static const auto common = common_modules();
  const std::string text = "\nmaterial m { physical {\nactive 90 W\nforce = " + force + "\n} }";
  return read(Bank(standard::material(text, "m")), common->declarations);
}

TEST(ReadingTime, APushThatComesOrGoesIsConstantAsFarAsItRemains) {
  std::mt19937 random(11);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  for (int i = 0; i < 24; ++i) {
    const double before = i % 3 == 0 ? 0 : between(0.3, 3), after = i % 3 == 1 ? 0 : between(0.3, 3);
    const double moment = between(1.5, 5.5), size = between(0.5, 3), rate = between(30, 170);
    const std::string step = fmt::format("vector(if time < {} s then {} N else {} N, 0 N)", moment, before, after);
    const std::string shaking = fmt::format(" + vector(0 N, {} N * sin(2 pi * {} Hz * time))", size, rate);
    const std::string text = i % 2 == 0 ? step : step + shaking;
    const ForceReading found = read_of(text);
    const double remains = std::min(before, after);
    EXPECT_NEAR(found.constant.x, remains, std::max(least_force, 0.03 * remains)) << text;
    EXPECT_NEAR(found.constant.y, 0, least_force) << text;
    EXPECT_NEAR(found.other.slowly, std::abs(after - before), 0.02 * std::max(before, after) + 0.02 * size) << text;
    EXPECT_LT(found.sway.amplitude, least_force) << text;
    if (i % 2 != 0) {
      EXPECT_NEAR(found.vibration.amplitude, size, 0.06 * size) << text;  // few ticks fall on its peaks
      EXPECT_NEAR(found.vibration.frequency, rate, 0.02 * rate) << text;
    }
  }
}

TEST(ReadingTime, WhatFadesOrWandersIsNoConstantPush) {
  for (const char* text :
       {"vector(1.8 N * exp(-time / 2 s), 0 N)", "vector(2.1 N * exp(-time / 3 s), 0 N)",
        "vector(2 N * (noise(time / 3 s) - 0.5), 0 N)",
        "vector(2 N * (noise(time / 2 s) - 0.5), 2 N * (noise(time / 2 s, seed: 3) - 0.5))",
        "vibrate(2 N, rate: 90 Hz) + vector(1.8 N * exp(-time / 2 s), 0 N)",
        "vector(0 N, 0.9 N * sin(2 pi * 67 Hz * time)) + vector(0.2 N * time / 1 s, 0 N) limit 3 N"}) {
    const ForceReading found = read_of(text);
    EXPECT_EQ(found.constant, glm::dvec2(0)) << text;
    EXPECT_GT(found.other.slowly, 0.5) << text;
  }
}

TEST(ReadingTime, ASlowSwayAndWhatComesBesideItAreParted) {
  std::mt19937 random(12);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  for (int i = 0; i < 24; ++i) {
    const double rate = between(0.35, 1.2), sways = between(0.5, 2), comes = between(0.5, 2), after = between(1, 3);
    const std::string phase = fmt::format("{:.4f}", between(0, 6));
    const char* const way = i % 2 == 0 ? "vector(0 N, {1} N * {0})" : "vector({1} N * {0}, 0 N)";
    const std::string course = i % 4 < 2 ? fmt::format("(1 - exp(-time / {} s))", 0.5 * after)
                                         : fmt::format("(if time > {} s then 1 else 0)", after);
    const std::string text = fmt::format("vector({} N * sin(2 pi * {} Hz * time + {}), 0 N) + ", sways, rate, phase) +
                             fmt::format(fmt::runtime(way), course, comes);
    const ForceReading found = read_of(text);
    EXPECT_NEAR(found.sway.amplitude, sways, 0.05 * sways) << text;
    EXPECT_NEAR(found.sway.frequency, rate, 0.02 * rate) << text;
    EXPECT_NEAR(found.other.slowly, comes, 0.08 * comes + 0.02 * sways) << text;
    EXPECT_LT(glm::length(found.constant), 0.05 * sways + least_force) << text;
  }
}

}  // namespace
}  // namespace wale::slowly_test
