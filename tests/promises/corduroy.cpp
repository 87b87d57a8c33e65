// Promise 3 for corduroy: what is asked for by percept comes out of the handle. The simulated hand rubs a corduroy of
// roughness 0.6, and the published regression, written independently here, converts the actuator's force to a level.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "tests/promises/running.hpp"

namespace wale::corduroy_test {
namespace {

// Minsky 1995, figure 19: log10 R = 0.759593 log10 F - 0.513365, F in program units of 10 N / 512 up to 194 of them,
// where level 1 is. A level is linear in R, so level = (F / 194 pu)^0.759593.
constexpr double newtons_per_unit = 10.0 / 512, loudest_units = 194, slope = 0.759593;
double force_of_level(double level) { return loudest_units * newtons_per_unit * std::pow(level, 1 / slope); }
double level_of_force(double newtons) { return std::pow(newtons / (loudest_units * newtons_per_unit), slope); }

// 10 N in 2048 steps from zero.
constexpr double force_step = 10.0 / 2048;

/// The text of library/fabric/corduroy.wale with `from` replaced by `to`.
std::string corduroy(const std::string& from = "", const std::string& to = "") {
  std::ifstream file(std::string(WALE_SOURCE_DIR) + "/library/fabric/corduroy.wale");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!from.empty()) {
    const auto at = text.find(from);
    if (at == std::string::npos) throw std::runtime_error("the corduroy has no " + from);
    text.replace(at, from.size(), to);
  }
  return text;
}

TEST(TheMap, GivesTheForcesOfFigure19) {
  for (const auto& [asked, newton] : {std::pair{"roughness 0.6", 1.934}, {"roughness 0.3", 0.777}})
    EXPECT_NEAR(amplitude(Bank(promises::compiled(corduroy("roughness 0.6", asked))), 0), newton, 0.0005) << asked;
}

TEST(Corduroy, TheAskedLevelComesOutOfTheHandle) {
  const Felt felt = promises::rubbed(promises::compiled(corduroy()));
  const double asked = force_of_level(0.6);
  EXPECT_NEAR(felt.force_rubbing.p99, asked, 0.01 * asked + force_step);
  EXPECT_NEAR(level_of_force(felt.force_rubbing.p99), 0.60, 0.01);
  EXPECT_LE(felt.force_rubbing.maximum, asked + force_step);
}

TEST(Corduroy, RubbingForceHasTheGratingsOwnMean) {
  // The slope of a period is a Gaussian of 24/256 of the period up and one down, so its mean square is
  // 2 sqrt(pi) 24/256 of the square of its maximum.
  const double share = std::sqrt(2 * std::sqrt(std::acos(-1.0)) * 24 / 256);
  EXPECT_NEAR(share, 0.576, 0.001);
  const Felt felt = promises::rubbed(promises::compiled(corduroy()));
  EXPECT_NEAR(felt.force_rubbing.rms, share * force_of_level(0.6), 0.1 * share * force_of_level(0.6));
}

TEST(Corduroy, IsCrossedRidgeByRidge) {
  // 5 s at 1 Hz are ten strokes over all ridges in the hand's range, and each ridge has two flanks.
  const Felt felt = promises::rubbed(promises::compiled(corduroy()));
  const double flanks = 10 * felt.position_range / 0.0025 * 2;
  EXPECT_GT(felt.position_range, 0.06);
  EXPECT_NEAR(felt.crossings, flanks, 0.1 * flanks);
  EXPECT_LT(felt.stuck, 0.2);
}

TEST(Corduroy, AnotherRoughnessIsAnotherForce) {
  const Felt felt = promises::rubbed(promises::compiled(corduroy("roughness 0.6", "roughness 0.3")));
  const double asked = force_of_level(0.3);
  EXPECT_NEAR(felt.force_rubbing.p99, asked, 0.01 * asked + force_step);
  EXPECT_NEAR(level_of_force(felt.force_rubbing.p99), 0.30, 0.01);
}

TEST(Corduroy, AnotherPeriodIsTheSameRoughness) {
  const Felt felt =
      promises::rubbed(promises::compiled(corduroy()), [](Patch& patch) { EXPECT_TRUE(patch.set("wale", 0.005f)); });
  EXPECT_NEAR(felt.force_rubbing.p99, force_of_level(0.6), 0.01 * force_of_level(0.6) + force_step);
}

TEST(Corduroy, AnotherPeriodWhileRubbingIsTheSameRoughness) {
  // The parameter changes at 2 s; the measurement begins after it.
  const Program program = promises::compiled(corduroy());
  auto joystick = promises::joystick();
  Stage stage(*joystick);
  Patch patch = *stage.add(program);
  bool moved = false;
  RunOptions run{.seconds = 7, .virtual_time = true};
  run.progress = [&](const Now& now) {
    if (now.time >= 2 && !std::exchange(moved, true)) {
      EXPECT_TRUE(patch.set("wale", 0.005f));
    }
  };
  const auto result = stage.run(run);
  ASSERT_TRUE(result);
  ASSERT_TRUE(moved);
  const Felt after = promises::measured(program, result->record, 2.5);
  EXPECT_NEAR(after.force_rubbing.p99, force_of_level(0.6), 0.01 * force_of_level(0.6) + force_step);
  // 4.5 s over ridges twice as wide as before.
  const double flanks = 9 * after.position_range / 0.005 * 2;
  EXPECT_NEAR(after.crossings, flanks, 0.1 * flanks);
}

class AtRest : public testing::TestWithParam<double> {};

TEST_P(AtRest, NothingOscillates) {
  // The hand's target is on a ridge's top, on a flank, in a valley, or in between. The hand may slide downhill until
  // its own spring holds it, and then it stays.
  const Program program = promises::compiled(corduroy());
  auto joystick = promises::joystick(Rest{{GetParam(), 0.0}});
  Stage stage(*joystick);
  Patch patch = *stage.add(program);
  const auto result = stage.run({.seconds = 4, .virtual_time = true});
  ASSERT_TRUE(result);
  const Felt felt = promises::measured(program, result->record, 2);
  EXPECT_EQ(felt.alternations, 0);
  EXPECT_LT(felt.position_rms, 0.2286 / 4096) << "more than an encoder count";
}

// Eighths of a period of 2.5 mm, and one place far from the centre.
INSTANTIATE_TEST_SUITE_P(PlacesInAPeriod, AtRest,
                         testing::Values(0.0, 0.0003125, 0.000625, 0.0009375, 0.00125, 0.0015625, 0.001875, 0.0021875,
                                         0.0306));

TEST(Corduroy, TheSameRunGivesTheSameBits) {
  const Program program = promises::compiled(corduroy());
  const auto bits = [&] {
    auto joystick = promises::joystick();
    Stage stage(*joystick);
    Patch patch = *stage.add(program);
    const auto result = stage.run({.seconds = 2, .virtual_time = true});
    std::ostringstream csv;
    write_csv(csv, result->record);
    return csv.str();
  };
  const std::string first = bits();
  EXPECT_GT(first.size(), 1800u * 20);
  EXPECT_EQ(first, bits());
}

}  // namespace
}  // namespace wale::corduroy_test
