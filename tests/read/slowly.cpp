// What comes and goes with time, alone and beside a vibration, and what remains all the time.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>
#include <string>
#include <vector>

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

TEST(ReadingTime, ASlowSwayAloneBringsNothingElse) {
  std::mt19937 random(13);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  for (int i = 0; i < 24; ++i) {
    const double rate = between(0.26, 1.4), sways = between(0.15, 2);
    const std::string sway = fmt::format("{} N * sin(2 pi * phase({} Hz) + {:.3f})", sways, rate, between(0, 6));
    const std::string beside = i % 3 == 0   ? ""
                               : i % 3 == 1 ? " + vector(0.4 N, 0 N)"
                                            : " + sticky(0.6 N) + lateral(grating(x, period: 4 mm), amplitude: 1 N)";
    const std::string text = fmt::format("vector(0 N, {}){}", sway, beside);
    const ForceReading found = read_of(text);
    EXPECT_NEAR(found.sway.amplitude, sways, 0.03 * sways) << text;
    EXPECT_NEAR(found.sway.frequency, rate, 0.02 * rate) << text;
    EXPECT_LT(found.other.slowly, least_force) << text;
    EXPECT_NEAR(found.constant.x, i % 3 == 1 ? 0.4 : 0, least_force) << text;
    EXPECT_NEAR(found.constant.y, 0, least_force) << text;
    EXPECT_FALSE(found.sway.course) << text;
  }
}

/// The 99th percentile of |sin| under an envelope over 8 s, by counting.
double percentile_under(const std::function<double(double seconds)>& envelope, double rate) {
  std::vector<double> sizes;
  for (int i = 0; i < 200000; ++i) {
    const double seconds = 8.0 * i / 200000;
    sizes.push_back(std::abs(envelope(seconds) * std::sin(2 * std::numbers::pi * rate * seconds)));
  }
  std::ranges::sort(sizes);
  return sizes[static_cast<std::size_t>(0.99 * static_cast<double>(sizes.size()))];
}

TEST(ReadingTime, WhatDiesAwayOrGrowsIsToldWithHowLongItLasts) {
  std::mt19937 random(14);
  const auto between = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  for (int i = 0; i < 24; ++i) {
    const bool sways = i % 4 == 3, grows = i % 4 == 2;
    const double size = between(0.3, 2), rate = sways ? between(2, 7) : between(20, 200);
    const double lasts = sways ? between(1, 3) : grows ? between(2, 7) : between(0.4, 3);
    const std::string course = grows ? fmt::format("min(1, time / {} s)", lasts) : fmt::format("exp(-time / {} s)", lasts);
    const std::string text = fmt::format("vector({} N * sin(2 pi * {} Hz * time) * {}, 0 N)", size, rate, course);
    const ForceReading found = read_of(text);
    const Swing& swing = sways ? found.sway : found.vibration;
    const double expected = percentile_under(
        [&](double seconds) { return size * (grows ? std::min(1.0, seconds / lasts) : std::exp(-seconds / lasts)); },
        rate);
    EXPECT_NEAR(swing.amplitude, expected, 0.05 * expected) << text;
    EXPECT_NEAR(swing.frequency, rate, 0.02 * rate) << text;
    ASSERT_TRUE(swing.course) << text;
    EXPECT_EQ(swing.course->grows, grows) << text;
    const double half = grows ? 0.5 * lasts : std::log(2.0) * lasts;
    EXPECT_NEAR(swing.course->half_after, half, 0.1 * half + 0.25 / rate + 0.1) << text;
    double most = 0;  // of the forces that come out at 900 ticks a second
    for (int tick = 0; tick < 7200; ++tick) {
      const double now = tick / 900.0, strength = grows ? std::min(1.0, now / lasts) : std::exp(-now / lasts);
      most = std::max(most, std::abs(size * strength * std::sin(2 * std::numbers::pi * rate * now)));
    }
    EXPECT_NEAR(swing.course->greatest, most, 0.08 * most) << text;
    EXPECT_LT(found.other.slowly, 0.02 * size + least_force) << text;
  }
}

TEST(ReadingTime, WhatStaysOrComesAndGoesDoesNotDieAway) {
  for (const char* text : {"vibrate(1 N, rate: 60 Hz)", "vector(1 N * sin(2 pi * 2 Hz * time), 0 N)",
                           "vector(0.5 N * (sin(2 pi * 60 Hz * time) + sin(2 pi * 64 Hz * time)), 0 N)",
                           "vector(1 N * exp(-time / 0.3 s), 0 N)", "vector(if time > 3 s then 1 N else 0 N, 0 N)",
                           "vector(1 N * exp(-time / 2 s), 0 N) + vibrate(0.4 N, rate: 90 Hz)"}) {
    const ForceReading found = read_of(text);
    EXPECT_FALSE(found.sway.course) << text;
    EXPECT_FALSE(found.vibration.course) << text;
  }
}

}  // namespace
}  // namespace wale::slowly_test
