// QUEST+ trial by trial against the runs that Watson prints (2017, J Vision 17(3):10), as other implementations replay them.
#include "calibration/analysis/quest_plus.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "calibration/analysis/random.hpp"
#include "calibration/analysis/staircase.hpp"

namespace wale::analysis {
namespace {

std::vector<double> steps(double from, double to, double by) {
  std::vector<double> values;
  for (int i = 0; from + i * by <= to + 1e-9; ++i) values.push_back(from + i * by);
  return values;
}

/// Outcome 0 is right, 1 wrong. The parameters are threshold, slope, lapse; the guess rate is 0.5.
QuestPlus watsons(const std::vector<double>& slopes, const std::vector<double>& lapses) {
  return QuestPlus({steps(-40, 0, 1)}, {steps(-40, 0, 1), slopes, lapses}, 2,
                   [](std::size_t outcome, const std::vector<double>& stimulus, const std::vector<double>& at) {
                     const double right = weibull_in_decibels(stimulus[0], at[0], at[1], 0.5, at[2]);
                     return outcome == 0 ? right : 1 - right;
                   });
}

void replay(QuestPlus& quest, const std::vector<double>& contrasts, const std::string& answers) {
  ASSERT_EQ(contrasts.size(), answers.size());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const std::size_t next = quest.next_number();
    ASSERT_EQ(quest.stimulus(next)[0], contrasts[i]) << "trial " << i + 1;
    quest.update(next, answers[i] == '1' ? 0 : 1);
  }
}

TEST(QuestPlus, ReplaysWatsonsExample1) {
  QuestPlus quest = watsons({3.5}, {0.02});
  replay(quest,
         {-18, -22, -25, -28, -30, -22, -13, -15, -16, -18, -19, -20, -21, -22, -23, -19,
          -20, -20, -18, -18, -19, -17, -17, -18, -18, -18, -19, -19, -19, -19, -19, -19},
         "11110011111111011011011111111111");
  EXPECT_EQ(quest.mode()[0], -20);
  EXPECT_EQ(quest.answers(), 32u);
}

TEST(QuestPlus, ReplaysWatsonsImplementation) {  // threshold and slope
  QuestPlus quest = watsons(steps(2, 5, 1), {0.02});
  replay(quest, {-18, -22, -12, -13, -15, -16, -17, -18, -19, -21, -24, -25, -26, -27, -21, -22, -23, -20, -20, -20, -21, -19,
                 -19, -20, -20, -20, -19, -19, -19, -19, -19, -20, -20, -20, -20, -20, -21, -21, -20, -20, -20, -19, -18, -18,
                 -19, -19, -19, -18, -18, -17, -18, -18, -18, -17, -17, -17, -17, -17, -17, -17, -18, -18, -18, -18},
         "1011111111111011011101111011111111111011001111010111011111111111");
  EXPECT_EQ(quest.mode()[0], -20);
  EXPECT_EQ(quest.mode()[1], 3);
}

TEST(QuestPlus, ReplaysWatsonsExample2) {  // threshold, slope and lapse
  QuestPlus quest = watsons(steps(2, 5, 1), steps(0, 0.04, 0.01));
  replay(quest,
         {-18, -22, -25, -28, -30, -21, -12, -14, -15, -16, -18, -19, -20, -22, -23, -18, -19, -16, -17, -17, -18, -18,
          -18, -19, -19, -17, -17, -18, -18, -18, -18, -19, -19, -20, -18, -18, -18, -18, -18, -19, -19, -19, -19, -20,
          -18, -18, -18, -18, -18, -18, -18, -18, -18, -19, -19, -19, -20, -18, -18, -18, -18, -19, -19, -19, -18, -18,
          -18, -18, -19, -19, -19, -19, -19, -19, -19, -19, -20, -21, -19, -19, -19, -19, -19, -19, -19, -18, -19, -19,
          -16, -16, -16, -16, -16, -16, 0,   0,   -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19,
          -21, -21, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19},
         "11110011111111010111111101111111101111111110111011111111011111101111111111111010111101101111111011111111111111101110100111101111");
  EXPECT_EQ(quest.mode()[0], -20);
  EXPECT_EQ(quest.mode()[1], 5);
  EXPECT_NEAR(quest.mode()[2], 0.04, 1e-12);
}

TEST(QuestPlus, ExpectsTheEntropyThatTheAnswersLeave) {  // against the definition, by trying each answer
  QuestPlus quest = watsons({2, 4}, {0.02});
  quest.update(20, 0), quest.update(25, 1);
  for (const std::size_t stimulus : {0u, 15u, 22u, 40u}) {
    double expected = 0;
    for (std::size_t outcome = 0; outcome < 2; ++outcome) {
      double chance = 0;
      std::size_t point = 0;
      for (const auto& at : points_of({steps(-40, 0, 1), {2, 4}, {0.02}})) {
        const double right = weibull_in_decibels(quest.stimulus(stimulus)[0], at[0], at[1], 0.5, at[2]);
        chance += quest.posterior()[point++] * (outcome == 0 ? right : 1 - right);
      }
      QuestPlus after = quest;
      after.update(stimulus, outcome);
      expected += chance * after.entropy();
    }
    EXPECT_NEAR(quest.expected_entropy(stimulus), expected, 1e-10);
  }
}

TEST(QuestPlus, FindsPlantedThresholds) {
  int near = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    QuestPlus quest = watsons({3.5}, {0.02});
    const double threshold = -30 + static_cast<double>(seed);
    for (int trial = 0; trial < 64; ++trial) {
      const std::size_t next = quest.next_number();
      quest.update(next, random.uniform() < weibull_in_decibels(quest.stimulus(next)[0], threshold, 3.5, 0.5, 0.02) ? 0 : 1);
    }
    near += std::abs(quest.mean()[0] - threshold) <= 1.96 * quest.deviation()[0] ? 1 : 0;
  }
  EXPECT_GE(near, 17);
}

TEST(Staircase, MovesAsLevittSays) {
  Staircase stairs({.start = 8, .down = 2, .up = 1, .factors = {2, 1.5}, .reversals = 4, .discarded = 0});
  EXPECT_EQ(stairs.size(), 8);
  stairs.update(true);
  EXPECT_EQ(stairs.size(), 8) << "one right answer is not enough";
  stairs.update(true);
  EXPECT_EQ(stairs.size(), 4);
  stairs.update(true), stairs.update(false);
  EXPECT_EQ(stairs.size(), 6) << "the direction changed at 4, and steps are smaller from there";
  EXPECT_EQ(stairs.reversals(), std::vector<double>{4});
  stairs.update(true), stairs.update(true);
  EXPECT_EQ(stairs.size(), 4);
  EXPECT_EQ(stairs.reversals().size(), 2u);
  stairs.update(false), stairs.update(true), stairs.update(true);
  EXPECT_TRUE(stairs.finished());
  EXPECT_NEAR(*stairs.estimate(), std::sqrt(4.0 * 6.0), 1e-12);
  EXPECT_NEAR(Staircase::converges_to(2), 0.707, 5e-4);
  EXPECT_NEAR(Staircase::converges_to(3), 0.794, 5e-4);
}

TEST(Staircase, ConvergesToItsShare) {
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Random random(seed);
    Staircase stairs({.start = 4, .down = 3, .factors = {1.5, 1.1}, .reversals = 30, .discarded = 6, .most_trials = 2000});
    while (!stairs.finished()) stairs.update(random.uniform() < 1 - 0.5 * std::exp(-std::pow(stairs.size(), 2)));
    sum += std::log(*stairs.estimate());
  }
  const double expected = std::sqrt(-std::log(2 * (1 - 0.7937)));
  EXPECT_NEAR(std::exp(sum / 50), expected, 0.05 * expected);
}

TEST(Staircase, StaysWithinItsLimits) {
  Staircase stairs({.start = 1, .least = 0.5, .most = 2, .most_trials = 40});
  for (int i = 0; i < 20; ++i) stairs.update(false);
  EXPECT_EQ(stairs.size(), 2);
  EXPECT_FALSE(stairs.estimate());
  for (int i = 0; i < 20; ++i) stairs.update(true);
  EXPECT_EQ(stairs.size(), 0.5);
  EXPECT_TRUE(stairs.finished());
}

}  // namespace
}  // namespace wale::analysis
