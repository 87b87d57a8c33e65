// The mixed model against published fits. Expected figures are those that lme4 prints for its data set sleepstudy: the
// package's documentation and tests (REML, profile intervals), the documentation of BoxCox.jl (ML), and that of
// lmerTest (Satterthwaite).
#include "calibration/analysis/mixed_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calibration/analysis/distributions.hpp"
#include "calibration/analysis/random.hpp"
#include "calibration/analysis/trials.hpp"
#include "tests/analysis/published.hpp"

namespace wale::analysis {
namespace {

MixedData sleepstudy() {
  const auto table = published("tests/analysis/sleepstudy.csv");
  EXPECT_TRUE(table) << explained(table.error());
  TrialColumns columns;
  columns.sizes = {{"days"}};
  const auto trials = read_trials(*table, columns);
  EXPECT_TRUE(trials) << explained(trials.error());
  MixedData data;
  const auto n = static_cast<Eigen::Index>(trials->size());
  data.fixed.names = {"constant", "days"};
  data.fixed.columns = Eigen::MatrixXd::Ones(n, 2);
  data.y.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    data.fixed.columns(i, 1) = trials->sizes[0].values[static_cast<std::size_t>(i)];
    data.y(i) = trials->answer[static_cast<std::size_t>(i)];
  }
  data.varying = {0, 1};
  data.observer = trials->observer;
  data.observers = trials->observers.size();
  return data;
}

TEST(MixedModel, FitsSleepstudyByRestrictedLikelihood) {
  const auto fit = fit_mixed(sleepstudy(), Criterion::restricted);
  ASSERT_TRUE(fit) << explained(fit.error());
  EXPECT_EQ(fit->observations, 180u);
  EXPECT_EQ(fit->observers, 18u);
  EXPECT_NEAR(fit->at("constant").value, 251.405104848485, 1e-8);
  EXPECT_NEAR(fit->at("days").value, 10.467285959595, 1e-8);
  EXPECT_NEAR(fit->at("constant").error, 6.825, 5e-4);
  EXPECT_NEAR(fit->at("days").error, 1.546, 5e-4);
  EXPECT_NEAR(fit->deviation(0), 24.741, 1e-3);
  EXPECT_NEAR(fit->deviation(1), 5.922, 5e-4);
  EXPECT_NEAR(fit->correlation(0, 1), 0.07, 5e-3);
  EXPECT_NEAR(fit->residual, 25.592, 5e-4);
  EXPECT_NEAR(fit->deviance, 1743.628, 5e-4);
  const double together = fit->covariance_of_coefficients(0, 1);
  EXPECT_NEAR(together / (fit->coefficients[0].error * fit->coefficients[1].error), -0.138, 5e-4);
  EXPECT_FALSE(fit->singular);
}

// In a balanced design each subject's own line has a value at five days, and their mean has the t of 18 such values.
TEST(MixedModel, CombinationOfCoefficientsHasItsOwnDegreesOfFreedom) {
  MixedData data = sleepstudy();
  data.combination = Eigen::Vector2d(1, 5);
  const auto fit = fit_mixed(data, Criterion::restricted);
  ASSERT_TRUE(fit) << explained(fit.error());
  double mean = 0, squares = 0;
  std::vector<double> own;
  for (std::uint32_t subject = 0; subject < 18; ++subject) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (Eigen::Index i = 0; i < data.y.size(); ++i) {
      if (data.observer[static_cast<std::size_t>(i)] != subject) continue;
      const double at = data.fixed.columns(i, 1) - 5;
      n += 1, x += at, y += data.y(i), xx += at * at, xy += at * data.y(i);
    }
    const double slope = (n * xy - x * y) / (n * xx - x * x);
    own.push_back((y - slope * x) / n);
    mean += own.back() / 18;
  }
  for (const double each : own) squares += (each - mean) * (each - mean);
  EXPECT_NEAR(fit->combination.value, mean, 1e-6);
  EXPECT_NEAR(fit->combination.error, std::sqrt(squares / 17 / 18), 1e-3);
  EXPECT_NEAR(fit->combination.freedom, 17, 1e-2);
}

TEST(MixedModel, GivesSatterthwaitesDegreesOfFreedom) {  // Days: 1 and 17, as for 18 slopes in a balanced design
  const auto fit = fit_mixed(sleepstudy(), Criterion::restricted);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->at("days").freedom, 17, 1e-3);
  EXPECT_NEAR(fit->at("constant").freedom, 17, 1e-3);
  EXPECT_NEAR(fit->at("days").t(), 6.771, 5e-4);
}

TEST(MixedModel, FitsSleepstudyByMaximumLikelihood) {
  const auto fit = fit_mixed(sleepstudy(), Criterion::likelihood);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->at("constant").error, 6.6323, 5e-5);
  EXPECT_NEAR(fit->at("days").error, 1.50222, 2e-5);
  EXPECT_NEAR(fit->deviation(0), 23.7805, 1e-4);
  EXPECT_NEAR(fit->deviation(1), 5.7168, 5e-5);
  EXPECT_NEAR(fit->residual, 25.5918, 5e-5);
  EXPECT_NEAR(fit->akaike(), 1763.9, 0.05);
}

TEST(MixedModel, ComparesWithAndWithoutTheCorrelation) {
  const auto with = fit_mixed(sleepstudy(), Criterion::likelihood);
  const auto without = fit_mixed(sleepstudy(), Criterion::likelihood, Variation::independent);
  ASSERT_TRUE(with && without);
  EXPECT_NEAR(without->akaike(), 1762.0, 0.05);
  const Comparison found = compare_by_likelihood(*without, *with);
  EXPECT_EQ(found.freedom, 1u);
  EXPECT_NEAR(found.chi_squared, 0.0639, 5e-5);
  EXPECT_NEAR(found.p, 0.8004, 5e-5);
}

TEST(MixedModel, ProfilesItsDeviations) {  // lme4: confint(fm1)
  const auto data = sleepstudy();
  const Interval found[] = {profile_deviation(data, Variation::correlated, 0, Criterion::likelihood),
                            profile_deviation(data, Variation::correlated, 1, Criterion::likelihood),
                            profile_residual(data, Variation::correlated, Criterion::likelihood)};
  EXPECT_NEAR(found[0].low, 14.3814, 5e-3);
  EXPECT_NEAR(found[0].high, 37.7160, 5e-3);
  EXPECT_NEAR(found[1].low, 3.8012, 5e-3);
  EXPECT_NEAR(found[1].high, 8.7534, 5e-3);
  EXPECT_NEAR(found[2].low, 22.8983, 5e-3);
  EXPECT_NEAR(found[2].high, 28.8580, 5e-3);
  const Interval days = profile_coefficient(sleepstudy(), Variation::correlated, 1);
  EXPECT_NEAR(days.low, 7.3587, 5e-4);
  EXPECT_NEAR(days.high, 13.5759, 5e-4);
  const Interval constant = profile_coefficient(sleepstudy(), Variation::correlated, 0);
  EXPECT_NEAR(constant.low, 237.6807, 5e-3);
  EXPECT_NEAR(constant.high, 265.1295, 5e-3);
}

/// Answers of planted observers: `constant` + `slope` x with their own terms.
MixedData planted(std::uint64_t seed, std::size_t observers, std::size_t trials, double constant_deviation,
                  double slope_deviation, double noise) {
  Random random(seed);
  MixedData data;
  const auto n = static_cast<Eigen::Index>(observers * trials);
  data.fixed.names = {"constant", "x"};
  data.fixed.columns = Eigen::MatrixXd::Ones(n, 2);
  data.y.resize(n);
  data.varying = {0, 1};
  data.observers = observers;
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < observers; ++i) {
    const double constant = 0.3 + constant_deviation * random.normal(), slope = 0.76 + slope_deviation * random.normal();
    for (std::size_t j = 0; j < trials; ++j, ++at) {
      const double x = -1 + 2 * static_cast<double>(j % 30) / 29;
      data.fixed.columns(at, 1) = x;
      data.y(at) = constant + slope * x + noise * random.normal();
      data.observer.push_back(static_cast<std::uint32_t>(i));
    }
  }
  return data;
}

TEST(MixedModel, AgreesWithLeastSquaresWithoutVariation) {
  const MixedData data = planted(4, 6, 30, 0, 0, 0.1);
  const auto fit = fit_mixed(data, Criterion::restricted, Variation::none);
  const auto plain = fit_least_squares(data.fixed, data.y);
  ASSERT_TRUE(fit && plain);
  EXPECT_NEAR(fit->at("x").value, plain->at("x").value, 1e-12);
  EXPECT_NEAR(fit->at("x").error, plain->at("x").error, 1e-12);
  EXPECT_NEAR(fit->at("x").freedom, 178, 0.01);
  EXPECT_NEAR(fit->residual, plain->deviation(), 1e-12);
}

TEST(MixedModel, SaysThatAFitIsSingularAndSimplifiesIt) {
  MixedData data = planted(7, 8, 30, 0.4, 0.3, 0.1);
  // Equalised: each observer's mean is taken away, as the thesis's way may do. No variance of constants is left.
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(8);
  for (Eigen::Index i = 0; i < data.y.size(); ++i) sums(data.observer[static_cast<std::size_t>(i)]) += data.y(i) / 30;
  for (Eigen::Index i = 0; i < data.y.size(); ++i) data.y(i) -= sums(data.observer[static_cast<std::size_t>(i)]);
  const auto fit = fit_mixed(data, Criterion::restricted);
  ASSERT_TRUE(fit);
  EXPECT_TRUE(fit->singular);
  const auto simpler = fit_mixed_simplified(data, Criterion::restricted);
  ASSERT_TRUE(simpler);
  EXPECT_FALSE(simpler->singular);
  EXPECT_EQ(simpler->variation, Variation::slopes_only);
  EXPECT_EQ(simpler->simplified.size(), 2u);
  EXPECT_NEAR(simpler->residual, 0.1, 0.02);

  const auto alike = fit_mixed_simplified(planted(9, 8, 30, 0, 0, 0.1), Criterion::restricted);
  ASSERT_TRUE(alike);
  EXPECT_FALSE(alike->simplified.empty());
}

TEST(MixedModel, FitsOneObserverByLeastSquares) {
  const MixedData one = planted(3, 1, 60, 0, 0, 0.1);
  EXPECT_FALSE(fit_mixed(one, Criterion::restricted));
  const auto fit = fit_mixed_simplified(one, Criterion::restricted);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->variation, Variation::none);
  ASSERT_EQ(fit->simplified.size(), 1u);
}

TEST(MixedModel, RefusesFitsThatMeanNothing) {
  MixedData data = planted(5, 4, 30, 0.2, 0.2, 0.1);
  MixedData without = data;
  without.fixed.columns.col(0) *= 2;
  EXPECT_FALSE(fit_mixed(without, Criterion::restricted)) << "the first column is no constant";
  MixedData twice = data;
  twice.fixed.names.push_back("x in mm");
  twice.fixed.columns.conservativeResize(Eigen::NoChange, 3);
  twice.fixed.columns.col(2) = 3 * data.fixed.columns.col(1).array() + 1;
  const auto dependent = fit_mixed(twice, Criterion::restricted);
  ASSERT_FALSE(dependent);
  EXPECT_EQ(dependent.error().code, Code::not_measured);
  MixedData computed = data;
  computed.y = 0.5 + 0.76 * data.fixed.columns.col(1).array();
  EXPECT_FALSE(fit_mixed(computed, Criterion::restricted)) << "without scatter there are no errors";
  MixedData few = data;
  few.fixed.columns.conservativeResize(4, Eigen::NoChange), few.y.conservativeResize(4), few.observer.resize(4);
  EXPECT_FALSE(fit_mixed(few, Criterion::restricted));
}

// Of 200 intervals at 95 %, at least 181 hold the truth with a probability of 0.998 if each does with 0.95. The seeds are
// fixed, so the counts are.
TEST(MixedModel, CoversWhatWasPlanted) {
  int slopes = 0, deviations = 0;  // by the restricted criterion: by maximum likelihood the latter are too few
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const MixedData data = planted(seed, 15, 90, 0.4, 0.25, 0.15);
    const auto fit = fit_mixed(data, Criterion::restricted);
    ASSERT_TRUE(fit);
    const Coefficient& slope = fit->at("x");
    slopes += slope.low() <= 0.76 && 0.76 <= slope.high() ? 1 : 0;
    deviations += profile_deviation(data, Variation::correlated, 1).holds(0.25) ? 1 : 0;
  }
  EXPECT_GE(slopes, 181);
  EXPECT_GE(deviations, 181);
}

}  // namespace
}  // namespace wale::analysis
