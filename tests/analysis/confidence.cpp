// Ratings of confidence, as in section 4.5 of the thesis. It prints no single ratings, so these are synthetic.
#include "calibration/analysis/confidence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "calibration/analysis/distributions.hpp"
#include "calibration/analysis/random.hpp"

namespace wale::analysis {
namespace {

Result<ConfidenceAnalysis> analysed(const std::string& text, std::vector<SizeColumn> sizes, std::vector<std::string> factors = {}) {
  const auto table = read_table("ratings.tsv", text);
  EXPECT_TRUE(table);
  TrialColumns columns;
  columns.answers = Answers::ratings;
  columns.sizes = std::move(sizes), columns.factors = std::move(factors);
  const auto trials = read_trials(*table, columns);
  if (!trials) return trials.error();
  return analyse_confidence(*trials);
}

TEST(Confidence, SummarisesByHand) {
  const auto found = analysed(
      "participant\trun\tstimulus\tresponse\n"
      "S1\t1\tslick\t0\nS1\t1\tgrating\t100\nS1\t2\tslick\t10\nS1\t2\tgrating\t100\n"
      "S2\t1\tslick\t20\nS2\t1\tgrating\t80\nS2\t2\tslick\t30\nS2\t2\tgrating\t60\n",
      {}, {"stimulus"});
  ASSERT_TRUE(found) << in_words(found.error());
  EXPECT_EQ(found->mean, 50);
  ASSERT_EQ(found->stimuli.size(), 2u);
  EXPECT_EQ(found->stimuli[0].name, "slick");
  EXPECT_EQ(found->stimuli[0].mean, 15);
  EXPECT_NEAR(found->stimuli[0].deviation, std::sqrt((225 + 25 + 25 + 225) / 3.0), 1e-12);
  EXPECT_EQ(found->stimuli[1].mean, 85);
  EXPECT_EQ(found->histogram, (Histogram{1, 1, 1, 1, 0, 0, 1, 0, 1, 2}));
  EXPECT_EQ(found->at_least_80, 3.0 / 8);
  EXPECT_EQ(found->full, 2.0 / 8);
  EXPECT_EQ(found->above_80, 0.5);
  EXPECT_EQ(found->observers[0].use, UseOfScale::clipped);
  EXPECT_EQ(found->observers[1].use, UseOfScale::intermediate);
  ASSERT_TRUE(found->between_runs);
  EXPECT_EQ(found->between_runs->pairs, 4u);
  // (0, 10), (100, 100), (20, 30), (80, 60)
  EXPECT_NEAR(found->between_runs->r, 5400 / std::sqrt(6800.0 * 4600), 1e-12);
  EXPECT_LT(found->between_runs->low, found->between_runs->r);
}

// Ratings planted with the correlation between runs that the thesis prints, 0.63, over its 15 people and 102 stimuli.
TEST(Confidence, FindsThePrintedCorrelationBetweenRuns) {
  Random random(1995);
  std::ostringstream text;
  text << "participant\trun\thill\tvalley\tsize\tgradient\tresponse\n";
  struct Size {
    double hill, valley, size, gradient;
  };
  std::vector<Size> sizes;
  for (int i = 0; i < 102; ++i) {
    const double hill = 2 + 30 * random.uniform(), valley = 2 + 30 * random.uniform();
    sizes.push_back({hill, valley, 2 + 48 * random.uniform(), 10 + 180 * random.uniform()});
  }
  std::vector<std::vector<double>> own(15, std::vector<double>(102));
  for (auto& person : own)
    for (double& each : person) each = random.normal();
  for (int run = 1; run <= 2; ++run)
    for (std::size_t person = 0; person < own.size(); ++person)
      for (std::size_t i = 0; i < sizes.size(); ++i) {
        const double z = std::sqrt(0.63) * own[person][i] + std::sqrt(0.37) * random.normal();
        const double rating = 50 + 10 * z + 0.1 * (sizes[i].gradient - 100);
        text << "S" << person << '\t' << run << '\t' << sizes[i].hill << '\t' << sizes[i].valley << '\t' << sizes[i].size << '\t'
             << sizes[i].gradient << '\t' << std::clamp(rating, 0.0, 100.0) << '\n';
      }
  const auto found = analysed(text.str(), {{"hill"}, {"valley"}, {"size"}, {"gradient"}});
  ASSERT_TRUE(found) << in_words(found.error());
  // The gradient adds variance 0.01 var(gradient) = 27 to the 100 of the ratings, and to what both runs share.
  EXPECT_NEAR(found->between_runs->r, (63 + 27) / 127.0, 0.03);
  EXPECT_LT(found->between_runs->high - found->between_runs->low, 0.06);
  ASSERT_TRUE(found->regression);
  EXPECT_NEAR(found->regression->at("gradient").value, 0.1, 0.02);
  EXPECT_LT(found->regression->at("gradient").p(), 1e-6);
  EXPECT_GT(found->regression->at("hill").p(), 0.01);
  EXPECT_GT(found->regression->at("valley").p(), 0.01);
}

TEST(Confidence, NeedsRatingsAndSaysWhatItCannot) {
  EXPECT_FALSE(analysed("participant\tstimulus\tresponse\nS1\ta\t120\nS1\tb\t10\n", {}, {"stimulus"}));
  const auto once = analysed("participant\thill\tvalley\tresponse\nS1\t1\t2\t20\nS1\t2\t4\t10\nS2\t1\t2\t20\nS2\t2\t4\t15\n", {{"hill"}, {"valley"}});
  ASSERT_TRUE(once);
  EXPECT_FALSE(once->between_runs);
  EXPECT_FALSE(once->regression);
  EXPECT_FALSE(once->regression_refused.empty());
}

TEST(Confidence, FindsTheLargestGradient) {
  EXPECT_EQ(largest_gradient({0, 1, 4, 2}, 0.5), 6);
  EXPECT_EQ(largest_gradient({0, 1, 2, 9}, 1), 9) << "around the end of the period";
  EXPECT_EQ(correlation({1, 2, 3}, {2, 4, 6}), 1);
  EXPECT_FALSE(correlation({1, 1}, {2, 4}));
}

}  // namespace
}  // namespace wale::analysis
