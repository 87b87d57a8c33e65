// Psychometric functions against published fits, and d' against tables.
#include "calibration/analysis/psychometric.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calibration/analysis/detection.hpp"
#include "calibration/analysis/random.hpp"

namespace wale::analysis {
namespace {

std::vector<Level> levels_of(std::vector<double> sizes, std::vector<std::size_t> right, std::size_t trials) {
  std::vector<Level> levels;
  for (std::size_t i = 0; i < sizes.size(); ++i) levels.push_back({sizes[i], right[i], trials});
  return levels;
}

/// The example of psignifit 4 (Schuett, Harmeling, Macke and Wichmann 2016): 13 levels, two alternatives.
std::vector<Level> psignifits_example() {
  return levels_of({.0010, .0015, .0020, .0025, .0030, .0035, .0040, .0045, .0050, .0060, .0070, .0080, .0100},
                   {45, 50, 44, 44, 52, 53, 62, 64, 76, 79, 88, 90, 90}, 90);
}

// psignifit prints the posterior's mode, whose other priors are weak: threshold 0.00464485, width 0.00468384.
TEST(Psychometric, FitsPsignifitsExample) {
  const auto fit = fit_psychometric(psignifits_example(), {.prior = true});
  ASSERT_TRUE(fit) << in_words(fit.error());
  EXPECT_NEAR(fit->function.threshold, 0.004645, 0.01 * 0.004645);
  EXPECT_NEAR(fit->function.width, 0.004684, 0.02 * 0.004684);
  EXPECT_LT(fit->function.lapse, 1e-4);
  EXPECT_LT(fit->threshold.low, 0.004645);
  EXPECT_GT(fit->threshold.high, 0.004645);
  EXPECT_LT(fit->threshold.high - fit->threshold.low, 0.001);
  EXPECT_EQ(fit->trials, 1170u);
}

// A second opinion: maximum likelihood by psignifit 2.5.6 on the demonstration data of Palamedes, with the lapse rate held
// at 0.02. Its alpha is the middle of a logistic function and beta its scale.
TEST(Psychometric, AgreesWithPsignifit2) {
  const auto levels = levels_of({.01, .03, .05, .07, .09, .11}, {59, 53, 68, 83, 92, 99}, 100);
  const auto fit = fit_psychometric(levels, {.shape = Sigmoid::logistic, .lapse = 0.02});
  ASSERT_TRUE(fit) << in_words(fit.error());
  EXPECT_NEAR(fit->function.threshold, 0.0584006, 2e-6);
  EXPECT_NEAR(fit->function.width / (2 * std::log(19.0)), 0.0140818, 2e-6);
  EXPECT_NEAR(fit->deviance, 5.02214, 2e-4);
}

TEST(Psychometric, SharesTheLapseRate) {
  Random random(3);
  std::vector<std::vector<Level>> conditions;
  for (const double threshold : {1.0, 2.0, 4.0}) {
    const PsychometricFunction planted{.threshold = threshold, .width = 0.8 * threshold, .lapse = 0.04};
    std::vector<Level> levels;
    for (int i = 1; i <= 8; ++i) {
      const double size = 0.3 * i * threshold;
      levels.push_back({size, static_cast<std::size_t>(random.binomial(200, planted.at(size))), 200});
    }
    conditions.push_back(levels);
  }
  const auto fits = fit_with_shared_lapse(conditions, {});
  ASSERT_TRUE(fits) << in_words(fits.error());
  ASSERT_EQ(fits->size(), 3u);
  EXPECT_NEAR((*fits)[0].function.lapse, 0.04, 0.015);
  double threshold = 1;
  for (const PsychometricFit& fit : *fits) {
    EXPECT_EQ(fit.function.lapse, (*fits)[0].function.lapse);
    EXPECT_TRUE(fit.threshold.holds(threshold)) << threshold;
    threshold *= 2;
  }
}

TEST(Psychometric, IntervalsCover) {  // 200 fixed seeds; a method at 95 % has 181 or more with a chance of 0.998
  const PsychometricFunction planted{.shape = Sigmoid::weibull, .threshold = 0.8, .width = 1.2, .lapse = 0.02};
  int profile = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    std::vector<Level> levels;
    for (const double size : {0.2, 0.4, 0.6, 0.8, 1.0, 1.3, 1.7, 2.2})
      levels.push_back({size, static_cast<std::size_t>(random.binomial(40, planted.at(size))), 40});
    const auto fit = fit_psychometric(levels, {.shape = Sigmoid::weibull});
    ASSERT_TRUE(fit) << seed << ": " << in_words(fit.error());
    profile += fit->threshold.holds(0.8) ? 1 : 0;
  }
  EXPECT_GE(profile, 181);
}

// A staircase's answers, whose interval once began at the estimate: against a grid over width and lapse rate.
TEST(Psychometric, IntervalOfOneTrackIsThatOfTheGridsProfile) {
  const std::vector<Level> levels = {{0.06, 1, 2}, {0.094, 4, 7}, {0.13, 9, 12}, {0.168, 11, 12}, {0.25, 6, 6}, {0.6, 3, 3}, {1.5, 3, 3}};
  const auto fit = fit_psychometric(levels, {.shape = Sigmoid::weibull});
  ASSERT_TRUE(fit) << in_words(fit.error());
  std::vector<std::pair<double, double>> profile;
  double best = -HUGE_VAL;
  for (double log = std::log(0.03); log < std::log(0.5); log += 0.01) {
    double most = -HUGE_VAL;
    for (double slope = 0.2; slope < 60; slope *= 1.05)
      for (double lapse = 0; lapse <= 0.1001; lapse += 0.01) {
        double sum = 0;
        for (const Level& each : levels) {
          const double felt = 1 - std::exp(-std::log(2) * std::pow(each.size / std::exp(log), slope));
          const double p = std::min(0.5 + (0.5 - lapse) * felt, 1 - 1e-12);
          sum += static_cast<double>(each.right) * std::log(p) + static_cast<double>(each.trials - each.right) * std::log(1 - p);
        }
        most = std::max(most, sum);
      }
    profile.emplace_back(std::exp(log), most), best = std::max(best, most);
  }
  double low = HUGE_VAL, high = 0;
  for (const auto& [size, likelihood] : profile)
    if (likelihood > best - 3.841459 / 2) low = std::min(low, size), high = std::max(high, size);
  EXPECT_NEAR(fit->threshold.low, low, 0.03 * low);
  EXPECT_NEAR(fit->threshold.high, high, 0.03 * high);
}

TEST(Psychometric, BootstrapsAlikeForOneSeed) {
  const PsychometricOptions options;
  const auto fit = fit_psychometric(psignifits_example(), options);
  ASSERT_TRUE(fit);
  const Bootstrap one = bootstrap(psignifits_example(), *fit, options, 0.75, 400, 7);
  const Bootstrap two = bootstrap(psignifits_example(), *fit, options, 0.75, 400, 7);
  EXPECT_EQ(one.size.low, two.size.low);
  EXPECT_TRUE(one.size.holds(0.00464));
  EXPECT_NEAR(one.size.low, fit->threshold.low, 0.0001);
  EXPECT_NEAR(one.size.high, fit->threshold.high, 0.0001);
  EXPECT_GT(one.p_of_deviance, 0.05) << "the published fit is no bad one";
  // Answers that hang together, as of several people thrown together: the deviance says so.
  std::vector<Level> loose = psignifits_example();
  for (std::size_t i = 0; i < loose.size(); ++i)
    loose[i].right = static_cast<std::size_t>(std::clamp<long>(static_cast<long>(loose[i].right) + (i % 2 == 0 ? 9 : -9), 0, 90));
  const auto over = fit_psychometric(loose, options);
  ASSERT_TRUE(over);
  EXPECT_LT(bootstrap(loose, *over, options, 0.75, 200, 7).p_of_deviance, 0.01);
}

TEST(Psychometric, RefusesAnswersThatGiveNoFunction) {
  const auto refused = [](const std::vector<Level>& levels, const PsychometricOptions& options = {}) {
    const auto fit = fit_psychometric(levels, options);
    EXPECT_FALSE(fit);
    return fit ? std::string() : fit.error().sentence;
  };
  EXPECT_NE(refused({{1, 10, 20}}).find("one size"), std::string::npos);
  EXPECT_NE(refused({}).find("no answers"), std::string::npos);
  EXPECT_NE(refused({{1, 0, 0}, {2, 0, 0}}).find("no answers"), std::string::npos);
  EXPECT_NE(refused({{1, 20, 20}, {2, 20, 20}}).find("are right"), std::string::npos);
  EXPECT_NE(refused({{1, 0, 20}, {2, 0, 20}}).find("exchanged"), std::string::npos);
  EXPECT_NE(refused({{1, 10, 20}, {2, 10, 20}, {3, 10, 20}}).find("do not depend"), std::string::npos);
  EXPECT_NE(refused({{1, 21, 20}, {2, 20, 20}}).find("21 of 20"), std::string::npos);
  EXPECT_NE(refused({{0, 10, 20}, {2, 20, 20}}, {.shape = Sigmoid::weibull}).find("logarithm"), std::string::npos);
  EXPECT_NE(refused({{1, 10, 20}, {2, 20, 20}}, {.guess = 1.5}).find("shares"), std::string::npos);
}

// 70.7 % is 0.77, 75 % 0.95, 79.4 % 1.16, 84 % 1.41 in two intervals; 4 intervals as Hacker and Ratcliff 1979 tabulate.
TEST(Detection, KnowsForcedChoice) {
  EXPECT_NEAR(d_prime_of_choice(0.707, 2), 0.77, 5e-3);
  EXPECT_NEAR(d_prime_of_choice(0.75, 2), 0.95, 5e-3);
  EXPECT_NEAR(d_prime_of_choice(0.794, 2), 1.16, 5e-3);
  EXPECT_NEAR(d_prime_of_choice(0.84, 2), 1.41, 5e-3);
  EXPECT_NEAR(choice_of_d_prime(0, 4), 0.25, 1e-9);
  EXPECT_NEAR(d_prime_of_choice(0.50, 4), 0.84, 5e-3);
  EXPECT_NEAR(d_prime_of_choice(0.90, 3), 2.23, 5e-3);
  EXPECT_NEAR(choice_of_d_prime(1, 2), choice_of_d_prime(1.0000001, 2), 1e-6);
}

TEST(Detection, KnowsYesNoAndSameDifferent) {
  const auto yes_no = sensitivity_of(Decision::yes_no, {84, 100, 16, 100});
  ASSERT_TRUE(yes_no);
  EXPECT_NEAR(yes_no->d_prime, 2 * 0.99446, 1e-4);
  EXPECT_NEAR(yes_no->criterion, 0, 1e-9);
  EXPECT_NEAR(yes_no->error, std::sqrt(2 * 0.84 * 0.16 / 100) / 0.24333, 1e-3);
  // The counts that a model itself gives for d' = 2 lead back to it.
  for (const double criterion : {1.0, 2.0}) {
    const auto count = [&](double d) { return static_cast<std::size_t>(std::llround(1e6 * different_by_difference(d, criterion))); };
    const auto found = sensitivity_of(Decision::same_different_difference, {count(2), 1000000, count(0), 1000000});
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->d_prime, 2, 1e-3);
  }
  // Unbiased: 2 z((1 + sqrt(2 p - 1)) / 2) with p = 0.69 is 1.71 (Macmillan and Creelman 2005, equation 9.5).
  const auto independent = sensitivity_of(Decision::same_different_independent, {690, 1000, 310, 1000});
  ASSERT_TRUE(independent);
  EXPECT_NEAR(independent->d_prime, 1.743, 2e-3);
  EXPECT_GT(sensitivity_of(Decision::same_different_difference, {690, 1000, 310, 1000})->d_prime, independent->d_prime)
      << "the difference model needs a larger d' for the same answers";
}

TEST(Detection, MovesPerfectRatesAndSaysSo) {
  const auto perfect = sensitivity_of(Decision::yes_no, {20, 20, 0, 20});
  ASSERT_TRUE(perfect);
  EXPECT_FALSE(perfect->corrected.empty());
  EXPECT_NEAR(perfect->d_prime, 2 * 1.981, 0.01);  // z(20.5 / 21)
  // Answers that are all "no" tell nothing apart, however many there are of each kind.
  EXPECT_NEAR(sensitivity_of(Decision::yes_no, {0, 20, 0, 100})->d_prime, 0, 1e-9);
  EXPECT_NEAR(sensitivity_of(Decision::yes_no, {100, 100, 20, 20})->d_prime, 0, 1e-9);
  EXPECT_FALSE(sensitivity_of(Decision::yes_no, {5, 4, 0, 4}));
  EXPECT_FALSE(sensitivity_of(Decision::yes_no, {1, 4, 0, 0}));
  EXPECT_FALSE(sensitivity_of(Decision::interval_choice, {1, 4, 0, 0}, 1));
}

TEST(Detection, PoolsWeberFractionsWithTheirRange) {
  const auto fraction = [](double standard, double value) { return WeberFraction{standard, value, {value / 1.2, value * 1.2}}; };
  const auto alike = pool_fractions({fraction(2, 0.11), fraction(0.8, 0.10), fraction(0.2, 0.105)});
  ASSERT_TRUE(alike);
  EXPECT_NEAR(alike->fraction, 0.105, 0.001);
  EXPECT_EQ(alike->low, 0.2);
  EXPECT_EQ(alike->high, 2);
  EXPECT_TRUE(alike->note.empty());
  const auto near_threshold = pool_fractions({fraction(2, 0.11), fraction(0.8, 0.10), fraction(0.2, 0.4)});
  ASSERT_TRUE(near_threshold);
  EXPECT_NEAR(near_threshold->fraction, 0.105, 0.001);
  EXPECT_EQ(near_threshold->low, 0.8);
  EXPECT_FALSE(near_threshold->note.empty());
  EXPECT_FALSE(pool_fractions({}));
}

}  // namespace
}  // namespace wale::analysis
