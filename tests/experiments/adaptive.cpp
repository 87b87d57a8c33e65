// Methods that choose the next level by the answers.
#include <fmt/format.h>

#include <cmath>

#include "calibration/analysis/sensitivity_law.hpp"
#include "calibration/experiment/level_chooser.hpp"
#include "calibration/experiment/trial_session.hpp"
#include "tests/experiments/texts.hpp"

namespace wale::experiments_test {
namespace {

/// By hand, for one up and two down: from level 8 in steps of two, which are halved at reversals.
TEST(UpDown, MovesByItsRule) {
  const auto track = up_down({.levels = 9, .up = 1, .down = 2, .reversals = 3, .trials = 100});
  std::vector<std::size_t> levels;
  for (const bool right : {true, true, true, true, false, true, true, false}) {
    levels.push_back(track->next());
    track->take(track->next(), right);
  }
  // 8, 8 right: down to 6; 6, 6 right: down to 4; 4 wrong: up (first reversal, step 1) to 5; 5, 5 right: down (second) to 4;
  // 4 wrong: up (third): over.
  EXPECT_EQ(levels, (std::vector<std::size_t>{8, 8, 6, 6, 4, 5, 5, 4}));
  EXPECT_TRUE(track->over());
}

TEST(UpDown, EndsAfterItsTrialsAndStaysOnItsLevels) {
  const auto track = up_down({.levels = 3, .up = 1, .down = 1, .reversals = 1000, .trials = 20});
  int trials = 0;
  for (; !track->over(); ++trials) {
    ASSERT_LT(track->next(), 3u);
    track->take(track->next(), false);
  }
  EXPECT_EQ(trials, 20);
}

/// One up and three down goes where three right answers in a row are as likely as not: at p = 0.5^(1/3) = 0.794 (Levitt
/// 1971). The mean level of many seeds' last trials is there.
TEST(UpDown, GoesToTheLevelOfItsRule) {
  double sum = 0;
  int count = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const auto track = up_down({.levels = 101, .up = 1, .down = 3, .reversals = 100000, .trials = 300});
    const Draws draws(seed, 50);
    for (std::uint64_t trial = 0; !track->over(); ++trial) {
      const auto level = track->next();
      const double p = 0.5 + 0.5 * static_cast<double>(level) / 100;
      track->take(level, draws.uniform(trial) < p);
      if (trial >= 150) sum += p, ++count;
    }
  }
  EXPECT_NEAR(sum / count, 0.794, 0.02);
}

TEST(QuestPlus, BeginsInTheMiddleAndGoesToTheThreshold) {
  std::vector<double> levels;
  for (int i = 0; i < 21; ++i) levels.push_back(0.1 * std::pow(10.0, i / 20.0));  // 0.1 to 1
  double error = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const auto track = quest_plus({levels, 0.5, 0.02, 60});
    EXPECT_GT(track->next(), 4u);
    EXPECT_LT(track->next(), 20u);
    const Draws draws(seed, 51);
    std::vector<std::size_t> last;
    for (std::uint64_t trial = 0; !track->over(); ++trial) {
      const auto level = track->next();
      const double p = 0.5 + 0.48 * (1 - std::exp(-std::pow(levels[level] / 0.3, 3.5)));
      track->take(level, draws.uniform(trial) < p);
      if (trial >= 50) last.push_back(level);
    }
    double mean = 0;
    for (const auto each : last) mean += std::log10(levels[each]) / static_cast<double>(last.size());
    error += (mean - std::log10(0.3)) / 20;
  }
  // Levels that tell the slope lie on both sides of the threshold. An eighth of a power of ten is two and a half levels.
  EXPECT_NEAR(error, 0, 0.125);
}

/// People whose d' is in proportion to the size, 40 answers each: a track tells threshold and exponent only together, and
/// an interval about the most likely exponent held the mean of 200 such studies in 154 to 176 of them.
TEST(QuestPlus, IntervalsOfItsTracksCoverThePopulationsMean) {
  std::vector<double> levels;
  for (int i = 0; i < 21; ++i) levels.push_back(0.05 * std::pow(40.0, i / 20.0));  // 0.05 to 2
  int covered = 0;
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    std::vector<analysis::ObserverAnswers> people;
    for (std::uint64_t person = 0; person < 6; ++person) {
      const Draws draws(seed * 100 + static_cast<std::uint32_t>(person), 52);
      const double own = 0.3 * std::exp(0.3 * draws.normal(1 << 20));
      const auto track = quest_plus({levels, 0.5, 0.02, 40});
      std::vector<analysis::Level> counts(levels.size());
      for (std::uint64_t trial = 0; !track->over(); ++trial) {
        const auto level = track->next();
        // d' = size / threshold in two intervals, and 2 % lapses to either side: 0.5 erfc(-d' / 2).
        const bool right = draws.uniform(trial) < 0.02 + 0.96 * 0.5 * std::erfc(-levels[level] / own / 2);
        track->take(level, right);
        counts[level].size = levels[level], ++counts[level].trials, counts[level].right += right ? 1 : 0;
      }
      std::erase_if(counts, [](const auto& each) { return each.trials == 0; });
      people.push_back({.levels = counts});
    }
    const auto fit = analysis::fit_sensitivity(people, {.intervals = false});
    covered += fit && fit->mean && fit->mean->interval.holds(0.3) ? 1 : 0;
  }
  EXPECT_GE(covered, 181);
}

/// A participant that is asked on numbers: right above the level, wrong below.
TEST(AdaptiveSessions, AreAFunctionOfTheAnswersThatStand) {
  const Design made(design("stimulus bench(amplitude: reference * ratio)\nstandard bench(amplitude: reference)\n"
                           "factor reference 0.2 N, 0.8 N\nfactor ratio 1.05 .. 2, steps 9\ntask two_interval\n"
                           "method up_down, over ratio, up 1, down 3, reversals 4\npractice 2"));
  const auto& experiment = made.experiment();
  EXPECT_EQ(experiment.standards.size(), 2u);
  ASSERT_EQ(tracks_of(experiment).size(), 2u);
  TrialSession session(experiment, 3);
  std::vector<SessionEntry> entries;
  std::vector<Trial> trials;
  const auto write = [&](const SessionEvent& event) {
    entries.push_back({.number = entries.size() + 1, .time = {}, .seconds = 0, .event = event});
    session.take(entries.back());
  };
  while (const auto trial = session.next_trial()) {
    trials.push_back(*trial);
    const auto level = *experiment.stimuli[trial->stimulus].levels[1];
    const bool right = level >= 4;
    write(SessionAnswer{"response", std::to_string(trial->number), std::to_string(right ? trial->target : 3 - trial->target)});
    ASSERT_LT(trials.size(), 200u);
  }
  EXPECT_GT(trials.size(), 30u);
  // Taken again from the log, it is at the same end; taken back and answered alike, too.
  TrialSession again(experiment, 3);
  for (const auto& each : entries) again.take(each);
  EXPECT_FALSE(again.next_trial());
  const std::size_t at = 20;
  TrialSession changed(experiment, 3);
  for (std::size_t i = 0; i <= at; ++i) changed.take(entries[i]);
  EXPECT_EQ(changed.latest_answers(), std::vector<std::uint64_t>{at + 1});
  changed.take({.number = 1000, .time = {}, .seconds = 0, .event = SessionTakenBack{changed.latest_answers()}});
  const auto redone = changed.next_trial();
  ASSERT_TRUE(redone);
  EXPECT_EQ(*redone, trials[at]) << "the same trial, since nothing before it has changed";
  for (const Trial& trial : trials)
    for (const Presented& each : trial.intervals) {
      EXPECT_TRUE(!each.is_standard || each.index == *experiment.stimuli[trial.stimulus].standard);
    }
}

}  // namespace
}  // namespace wale::experiments_test
