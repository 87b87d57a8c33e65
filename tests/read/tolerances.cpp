// The least that counts of each cue, against the records of what people notice.

#include "compiler/read/tolerances.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "compiler/modules/load_modules.hpp"

namespace wale::tolerances_test {
namespace {

TEST(Tolerances, NothingBelowTheLeastThatCountsIsFelt) {
  const auto common = common_modules();
  const Declarations& declared = common->declarations;
  double floor = 0, fraction = 1;
  for (const Threshold* each : declared.thresholds()) {
    if (each->cue != "amplitude" || each->recognised > 0) continue;
    floor = std::max(floor, each->floor);
    fraction = std::min(fraction, each->published);
  }
  ASSERT_GT(floor, 0);
  const HandDeclaration& hand = *declared.hands.find("normal");
  const double turns = 2 * std::numbers::pi * hand.lateral_frequency;
  EXPECT_LE(least_force, floor / 10 * 1.001);
  EXPECT_LT(least_stiffness * hand.lateral_amplitude, floor);
  EXPECT_LT(least_damping * turns * hand.lateral_amplitude, floor / 5);
  EXPECT_LT(least_mass * turns * turns * hand.lateral_amplitude, floor / 5);
  EXPECT_LT(std::sqrt(1 + least_of_relief * least_of_relief) - 1, fraction / 5);
  EXPECT_LT(reading, fraction / 3);
}

TEST(Tolerances, LeastSharesAreBelowWhatPeopleNotice) {
  const auto common = common_modules();
  int told = 0;
  common->declarations.percepts.each([&](const std::string& name, const Percept& percept) {
    if (percept.extractor != Extractor::lateral_force) return;
    ++told;
    EXPECT_GT(percept.least_share, reading) << name;
    EXPECT_LT(percept.least_share, 0.07) << name << ": Pang 1991";
    EXPECT_GE(percept.least_irregular_share, percept.least_share) << name;
  });
  EXPECT_GE(told, 2);
}

}  // namespace
}  // namespace wale::tolerances_test
