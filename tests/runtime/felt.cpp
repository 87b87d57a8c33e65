#include "wale/felt.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "tests/runtime/figures.hpp"
#include "tests/runtime/programs.hpp"

namespace wale::felt_test {
namespace {

constexpr double pi = std::numbers::pi, step = 0.2286 / 4096;

/// A second of ticks; `tick_at` gives each tick for its time in s.
Record one_second(const std::function<TickRecord(double)>& tick_at) {
  Record record{.seconds_per_tick = 1.0 / 900, .ticks = {}};
  for (int i = 0; i < 900; ++i) {
    TickRecord tick = tick_at(i / 900.0);
    tick.time = i / 900.0;
    tick.inside = true;
    record.ticks.push_back(tick);
  }
  return record;
}

/// A hand that moves at 0.1 m/s over a sine texture of 2.5 mm and 2 N.
TickRecord rubbing(double t) {
  const double x = 0.1 * t;
  return {.position = {x, 0},
          .velocity = {0.1, 0},
          .force = {2 * std::sin(2 * pi * x / 0.0025 + 0.1), 0},
          .interaction = {0, 3}};
}

MeasureOptions options(float amplitude = 2) { return {.position_step = step, .predicted_amplitude = amplitude}; }

TEST(Felt, CountsEachFlankOfATexture) {
  // 40 periods in a second have 80 swings, and the first has none before it
  const Felt felt = measure(one_second(rubbing), options());
  EXPECT_EQ(felt.crossings, 79);
  EXPECT_EQ(felt.alternations, 79);
  EXPECT_EQ(felt.stuck, 0);
  EXPECT_EQ(felt.ticks_rubbing, 900);
}

TEST(Felt, FiguresAreThoseOfASine) {
  const Felt felt = measure(one_second(rubbing), options());
  EXPECT_NEAR(felt.force_rubbing.rms, 2 / std::sqrt(2.0), 0.01);
  EXPECT_NEAR(felt.force_rubbing.maximum, 2, 0.01);
  EXPECT_NEAR(felt.force_rubbing.p99, 2 * std::sin(pi / 2 * 0.99), 0.01);
  ASSERT_TRUE(felt.interaction);
  EXPECT_FLOAT_EQ(felt.interaction->rms, 3);
}

/// Ticks of 1/900 s divided into steps of a microsecond, in each of which the force goes towards what was told.
std::vector<double> slowly_exerted(const Record& record, double bandwidth) {
  constexpr int steps = 1111;
  const double share = 2 * pi * bandwidth * record.seconds_per_tick / steps;
  std::vector<double> means;
  double force = 0;
  for (const TickRecord& tick : record.ticks) {
    double sum = 0;
    for (int i = 0; i < steps; ++i) force += share * (tick.force.x - force), sum += force;
    means.push_back(sum / steps);
  }
  return means;
}

TEST(Felt, AnActuatorExertsWhatItsBandwidthLetsThrough) {
  for (const double bandwidth : {4.0, 40.0, 400.0}) {
    MeasureOptions slow = options();
    slow.settling = 0.5, slow.bandwidth = {bandwidth, 0};
    const Record told = one_second(rubbing);
    const Felt felt = measure(told, slow);
    const std::vector<double> exerted = slowly_exerted(told, bandwidth);
    double squares = 0, largest = 0;
    for (std::size_t i = 450; i < 900; ++i)
      squares += exerted[i] * exerted[i] / 450, largest = std::max(largest, std::abs(exerted[i]));
    EXPECT_NEAR(felt.force_rubbing.rms, std::sqrt(squares), 0.003 * felt.force_rubbing.rms) << bandwidth;
    EXPECT_NEAR(felt.force_rubbing.maximum, largest, 0.003 * largest) << bandwidth;
    // 40 Hz through a low-pass; a force that is held for a tick has a little less of it.
    const double through = 1 / std::hypot(1, 40 / bandwidth);
    EXPECT_NEAR(felt.force_rubbing.rms, through * std::sqrt(2.0), 0.02 * through) << bandwidth;
    EXPECT_EQ(felt.crossings, measure(told, [&] { MeasureOptions at_once = slow; at_once.bandwidth = {0, 0}; return at_once; }()).crossings);
  }
}

TEST(Felt, TicksThatWereSkippedGiveAnActuatorTime) {
  Record record{.seconds_per_tick = 0.01, .ticks = {}};
  for (int i = 0; i < 3; ++i)
    record.ticks.push_back({.time = 0.01 * i + (i == 2 ? 1 : 0), .force = {0, 1}, .skipped = i == 2 ? 100u : 0u, .inside = true});
  MeasureOptions slow = options();
  slow.bandwidth = {0, 1 / (2 * pi * 0.01)};  // a tick is one time constant
  const Felt felt = measure(record, slow);
  EXPECT_NEAR(felt.force.maximum, 1, 1e-6) << "more than a second after the step";
  // The first tick's mean of 1 - exp(-t), 1/e; the second lasts for 101.
  const double first = std::exp(-1.0), second = 1 - (std::exp(-1.0) - std::exp(-102.0)) / 101;
  EXPECT_NEAR(felt.force.rms, std::sqrt((first * first + second * second + 1) / 3), 1e-6);
}

TEST(Felt, P99LeavesOnePercentAbove) {
  int i = 0;
  const Record record = one_second([&](double) { return TickRecord{.force = {0, static_cast<float>(++i)}}; });
  const Felt felt = measure(record, options());
  EXPECT_EQ(felt.force.p99, 891);
  EXPECT_EQ(felt.force.maximum, 900);
}

TEST(Felt, SizeOfATwoAxisForceIsItsMagnitude) {
  const Felt felt = measure(one_second([](double) { return TickRecord{.force = {3, -4}}; }), options());
  EXPECT_EQ(felt.force.p99, 5);
  EXPECT_EQ(felt.force.rms, 5);
}

TEST(Felt, ALimitCycleOnTheSpotCrossesNothing) {
  // 30 Hz around one ridge, 0.2 mm to each side: the force swings fully, at opposite velocities.
  const Felt felt = measure(one_second([](double t) {
                              const double a = 2 * pi * 30 * t + 0.1;
                              return TickRecord{.position = {2e-4 * std::sin(a), 0},
                                                .velocity = {2e-4 * 2 * pi * 30 * std::cos(a), 0},
                                                .force = {2 * std::sin(a - 0.4), 0}};
                            }),
                            options());
  EXPECT_GE(felt.alternations, 58);
  EXPECT_EQ(felt.crossings, 0);
}

TEST(Felt, SpringAndOilHaveNoCrossings) {
  for (const double lag : {0.0, pi / 2}) {
    const Felt felt = measure(one_second([&](double t) {
                                const double a = 2 * pi * 5 * t + 0.1;
                                return TickRecord{.position = {0.04 * std::sin(a), 0},
                                                  .velocity = {0.04 * 2 * pi * 5 * std::cos(a), 0},
                                                  .force = {-2 * std::sin(a + lag), 0}};
                              }),
                              options());
    EXPECT_GE(felt.alternations, 9);
    EXPECT_EQ(felt.crossings, 0) << lag;
  }
}

TEST(Felt, SwingsBelowHalfTheAmplitudeDoNotCount) {
  EXPECT_EQ(measure(one_second(rubbing), options(3.9f)).crossings, 79);
  EXPECT_EQ(measure(one_second(rubbing), options(4.1f)).crossings, 0);
  EXPECT_EQ(measure(one_second(rubbing), options(0)).crossings, 79) << "without a prediction, half of the P99 counts";
}

// Ridges with a steep and a gentle flank push with 2 N to one side and with less to the other, down to almost nothing,
// and a hand that crosses 40 of them feels both flanks of each.
TEST(Felt, FlanksNeedNotBeAlike) {
  for (const double gentle : {1.0, 0.5, 0.2, 0.02}) {
    const Felt felt = measure(one_second([&](double t) {
                                TickRecord tick = rubbing(t);
                                if (tick.force.x < 0) tick.force.x *= static_cast<float>(gentle);
                                return tick;
                              }),
                              options());
    // Where one side is hardly anything, the rest at which the hand begins counts as on it.
    EXPECT_NEAR(felt.crossings, 79, 1) << gentle;
  }
}

TEST(Felt, AWallThatIsPressedIsNotCrossed) {
  const Felt felt = measure(one_second([](double t) {
                              const double a = 2 * pi * 5 * t;
                              return TickRecord{.position = {0.01 * std::sin(a), 0},
                                                .velocity = {0.01 * 2 * pi * 5 * std::cos(a), 0},
                                                .force = {-2 * std::max(0.0, std::sin(a)), 0}};
                            }),
                            options());
  EXPECT_LE(felt.crossings, 1);  // of five: when the hand goes in first
}

// A relief may push across the hand's way.
TEST(Felt, CrossingsNeedNoForceAlongTheWay) {
  const Felt felt = measure(one_second([](double t) {
                              TickRecord tick = rubbing(t);
                              tick.force = {0, tick.force.x};
                              return tick;
                            }),
                            options());
  EXPECT_EQ(felt.crossings, 79);
}

TEST(Felt, CrossingsAreCountedAlongTheAxisWithMoreForce) {
  const Felt felt = measure(one_second([](double t) {
                              TickRecord tick = rubbing(t);
                              tick.velocity = {-tick.velocity.y, tick.velocity.x};
                              tick.force = {0.1f, tick.force.x};
                              return tick;
                            }),
                            options());
  EXPECT_EQ(felt.crossings, 79);
}

TEST(Felt, StuckIsMovingAtMostAFewCountsForAWhile) {
  // half the time creeping at one count in 50 ms, half the time rubbing
  const Record record = one_second([](double t) {
    if (t >= 0.5) return rubbing(t);
    return TickRecord{.position = {0.05 - (0.5 - t) * 20 * step, 0}, .force = {1, 0}};
  });
  const Felt felt = measure(record, options());
  EXPECT_NEAR(felt.stuck, 0.5, 0.03);
  EXPECT_NEAR(felt.force_rubbing.rms, std::sqrt(2.0), 0.05) << "the constant 1 N while stuck does not count as rubbing";
  EXPECT_NEAR(felt.force.rms, std::sqrt((2 + 1) / 2.0), 0.05);
}

TEST(Felt, SettlingAndOutsideDoNotCount) {
  Record record = one_second([](double t) {
    TickRecord tick = rubbing(t);
    if (t < 0.25) tick.force = {9, 0};
    return tick;
  });
  for (int i = 600; i < 900; ++i) {
    record.ticks[i].inside = false;
    record.ticks[i].force = {0, 0};
  }
  MeasureOptions settled = options();
  settled.settling = 0.25;
  const Felt felt = measure(record, settled);
  EXPECT_EQ(felt.ticks, 675);
  EXPECT_EQ(felt.ticks_rubbing, 375);
  EXPECT_LE(felt.force.maximum, 2);
  EXPECT_NEAR(felt.force_rubbing.rms, std::sqrt(2.0), 0.02);
  EXPECT_NEAR(felt.force.rms, std::sqrt(2.0 * 375 / 675), 0.02);
}

TEST(Felt, MovementAboutTheMean) {
  const Felt felt = measure(one_second([](double t) {
                              return TickRecord{.position = {0.05 + 0.01 * std::sin(2 * pi * t), 0.02}};
                            }),
                            options());
  EXPECT_NEAR(felt.position_rms, 0.01 / std::sqrt(2.0), 1e-5);
  EXPECT_NEAR(felt.position_range, 0.02, 1e-5);
}

TEST(Felt, AnUnknownInteractionIsAbsent) {
  const float unknown = std::numeric_limits<float>::quiet_NaN();
  const Felt felt = measure(one_second([&](double) {
                              return TickRecord{.interaction = {unknown, unknown}};
                            }),
                            options());
  EXPECT_FALSE(felt.interaction);
  EXPECT_FALSE(felt.interaction_rubbing);
}

TEST(Felt, AnEmptyRecordHasZeroFigures) {
  const Felt felt = measure({.seconds_per_tick = 1.0 / 900, .ticks = {}}, options());
  EXPECT_EQ(felt.ticks, 0);
  EXPECT_EQ(felt.force.p99, 0);
  EXPECT_FALSE(felt.interaction);
}

TEST(LevelsBack, InvertTheMapAtTheMeasuredAmplitude) {
  const Bank bank(corduroy(1.934f));
  EXPECT_FLOAT_EQ(predicted_amplitude(bank), 1.934f);
  Felt felt;
  felt.crossings = 50;
  felt.force_rubbing.p99 = 1.934f;
  const std::vector<LevelBack> levels = levels_back(bank, felt);
  ASSERT_EQ(levels.size(), 1u);
  EXPECT_EQ(levels[0].name, "roughness");
  ASSERT_TRUE(levels[0].back);
  EXPECT_NEAR(levels[0].back->level, 0.6, 0.001);  // schema/LANGUAGE.md: 1.934 N is roughness 0.6
}

TEST(LevelsBack, AreRefusedWithTheReason) {
  const Bank bank(corduroy(1.934f));
  Felt felt;
  felt.crossings = 49;
  EXPECT_EQ(levels_back(bank, felt)[0].back.error().sentence,
            "the hand crossed the texture 49 times, expected at least 50");

  PatchProgram program = corduroy(1.934f).description();
  program.percepts[0].alone = false;
  program.percepts[0].basis.summand = true;
  const Bank mixed(*Program::load(program));
  felt.crossings = 1000;
  EXPECT_EQ(levels_back(mixed, felt)[0].back.error().sentence,
            "other forces push besides the lateral amplitude, so the force at the handle does not give the level of "
            "roughness");
}

TEST(LevelsBack, NoPerceptsNoLevels) {
  const Bank bank(oil(2));
  EXPECT_EQ(predicted_amplitude(bank), 0);
  EXPECT_TRUE(levels_back(bank, {}).empty());
}

}  // namespace
}  // namespace wale::felt_test
