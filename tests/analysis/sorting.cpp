// Sorting and scaling: small cases by hand, and stress values that smacof's vignette prints.
#include "calibration/analysis/sorting.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calibration/analysis/random.hpp"
#include "calibration/analysis/scaling.hpp"

namespace wale::analysis {
namespace {

using Eigen::MatrixXd;

/// The stimuli of Minsky 1995, chapter 6: amplitude (10 program units) and period (0.1 mm).
struct Stimulus {
  int amplitude, period;
};
const std::vector<Stimulus> chapter6 = {{1, 7},   {3, 7},   {3, 12},  {3, 25},  {3, 50},   {3, 100},
                                        {10, 7},  {10, 12}, {10, 25}, {10, 50}, {10, 100}, {19, 100}};

Grouping by_amplitude() {
  Grouping groups;
  for (const Stimulus& each : chapter6) groups.push_back(each.amplitude > 3 ? 1 : 0);
  return groups;
}
Grouping by_period() {
  Grouping groups;
  for (const Stimulus& each : chapter6) groups.push_back(each.period > 25 ? 1 : 0);
  return groups;
}

TEST(Sorting, CountsPairsTogether) {
  const MatrixXd counts = co_occurrence({{0, 0, 1}, {0, 1, 1}, {5, 5, 5}});
  EXPECT_EQ(counts, (MatrixXd(3, 3) << 3, 2, 1, 2, 3, 2, 1, 2, 3).finished());
  EXPECT_EQ(times_apart({{0, 0, 1}, {0, 1, 1}, {5, 5, 5}})(0, 2), 2);
}

// Distances on a line: 0, 1, 3, 7, 7.5.
TEST(Sorting, LinksByHand) {
  const std::vector<double> at = {0, 1, 3, 7, 7.5};
  MatrixXd apart(5, 5);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) apart(i, j) = std::abs(at[static_cast<std::size_t>(i)] - at[static_cast<std::size_t>(j)]);
  const auto distances = [&](Linkage linkage) {
    std::vector<double> found;
    for (const Merge& each : cluster(apart, linkage)) found.push_back(each.distance);
    return found;
  };
  EXPECT_EQ(distances(Linkage::single), (std::vector<double>{0.5, 1, 2, 4}));
  EXPECT_EQ(distances(Linkage::complete), (std::vector<double>{0.5, 1, 3, 7.5}));
  const auto average = distances(Linkage::average);
  EXPECT_NEAR(average[2], 2.5, 1e-12);
  EXPECT_NEAR(average[3], (7 + 6 + 4 + 7.5 + 6.5 + 4.5) / 6, 1e-12);
  const auto merges = cluster(apart, Linkage::single);
  EXPECT_EQ(merges[0].first, 3u);
  EXPECT_EQ(merges[0].second, 4u);
  EXPECT_EQ(merges[3].first, 5u) << "the cluster of the first merge";
  EXPECT_EQ(merges[3].stimuli, 5u);
  EXPECT_EQ(cut(merges, 2), (Grouping{0, 0, 0, 1, 1}));
  EXPECT_EQ(cut(merges, 3), (Grouping{0, 0, 1, 2, 2}));
  EXPECT_EQ(cut(merges, 5), (Grouping{0, 1, 2, 3, 4}));
  auto leaves = leaves_in_order(merges);
  std::ranges::sort(leaves);
  EXPECT_EQ(leaves, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

TEST(Sorting, MeasuresDistanceFromPrototypes) {
  EXPECT_EQ(distance_from_prototype(by_amplitude(), by_amplitude()), 0u);
  Grouping renamed = by_amplitude();
  for (std::size_t& each : renamed) each = 7 - each;
  EXPECT_EQ(distance_from_prototype(renamed, by_amplitude()), 0u) << "the groups have no names";
  Grouping moved = by_amplitude();
  moved[6] = 0;
  EXPECT_EQ(distance_from_prototype(moved, by_amplitude()), 1u);
  EXPECT_EQ(distance_from_prototype({0, 0, 0, 0}, {0, 0, 1, 1}), 2u);
  EXPECT_EQ(distance_from_prototype({0, 1, 2, 3}, {0, 0, 1, 1}), 2u);
  // Greedy matching of the largest overlap would keep 3 + 0; the best keeps 2 + 2.
  EXPECT_EQ(distance_from_prototype({0, 0, 0, 0, 0, 1, 1}, {0, 0, 0, 1, 1, 0, 0}), 3u);
  EXPECT_EQ(distance_from_prototype({}, {}), 0u);
  // Against all matchings.
  Random random(3);
  for (int round = 0; round < 50; ++round) {
    Grouping a, b;
    for (int i = 0; i < 12; ++i) a.push_back(random.below(4)), b.push_back(random.below(4));
    std::vector<std::size_t> order = {0, 1, 2, 3};
    std::size_t most = 0;
    do {
      std::size_t stay = 0;
      for (std::size_t i = 0; i < a.size(); ++i) stay += order[a[i]] == b[i] ? 1 : 0;
      most = std::max(most, stay);
    } while (std::ranges::next_permutation(order).found);
    EXPECT_EQ(distance_from_prototype(a, b), 12 - most);
  }
}

TEST(Sorting, MeasuresAgreementBeyondChance) {
  EXPECT_EQ(adjusted_rand_index(by_amplitude(), by_amplitude()), 1);
  EXPECT_EQ(adjusted_rand_index({0, 0, 0}, {1, 1, 1}), 1);
  // scikit-learn's documentation: 0.57 and -0.5.
  EXPECT_NEAR(adjusted_rand_index({0, 0, 1, 2}, {0, 0, 1, 1}), 0.57, 0.005);
  EXPECT_NEAR(adjusted_rand_index({0, 0, 1, 1}, {0, 1, 0, 1}), -0.5, 1e-12);
}

// Sorters who go by amplitude first give the thesis's clusters: at the top all of a1 and a3 against all of a10 and a19.
TEST(Sorting, FindsTheThesissClustersInPlantedSorters) {
  Random random(6);
  std::vector<Grouping> sorted;
  for (int person = 0; person < 15; ++person) {
    Grouping groups = person < 9 ? by_amplitude() : person == 9 ? by_period() : by_amplitude();
    if (person > 9) groups[random.below(12)] ^= 1;
    sorted.push_back(groups);
  }
  for (const Linkage linkage : {Linkage::single, Linkage::average, Linkage::complete})
    EXPECT_EQ(adjusted_rand_index(cut(cluster(times_apart(sorted), linkage), 2), by_amplitude()), 1);
  EXPECT_GT(distance_from_prototype(by_period(), by_amplitude()), 3u);
}

/// Correlations of eight tests of intelligence (Guttman 1965), as in R's smacof, made dissimilarities sqrt(1 - r).
MatrixXd intelligence() {
  const double r[] = {.67, .40, .19, .12, .25, .26, .39, .50, .26, .20, .28, .26, .38, .52, .39, .31, .18, .24,
                      .55, .49, .25, .22, .46, .29, .14, .42, .38, .40};
  MatrixXd result = MatrixXd::Zero(8, 8);
  int at = 0;
  for (int i = 0; i < 8; ++i)
    for (int j = i + 1; j < 8; ++j) result(i, j) = result(j, i) = std::sqrt(1 - r[at++]);
  return result;
}

/// Similarities of twelve nations, 1 to 9, by 18 students (Kruskal and Wish 1978), as in R's smacof, taken from 7 as its
/// vignette does.
MatrixXd nations() {
  const double s[] = {4.83, 5.28, 3.44, 4.72, 4.5,  3.83, 3.5,  2.39, 3.06, 5.39, 3.17, 4.56, 5.0,  4.0,  4.83, 3.33, 3.39,
                      4.0,  3.39, 2.39, 3.5,  5.17, 4.11, 4.0,  3.61, 2.94, 5.5,  5.44, 3.17, 5.11, 4.78, 5.83, 4.67, 3.83,
                      4.39, 4.39, 3.33, 4.28, 3.44, 4.0,  4.22, 3.67, 5.06, 5.94, 4.72, 4.11, 4.5,  4.11, 4.5,  4.28, 4.0,
                      4.83, 3.0,  4.17, 5.94, 4.44, 4.17, 4.61, 6.06, 4.28, 5.72, 2.56, 5.06, 5.0,  6.67, 3.56};
  MatrixXd result = MatrixXd::Zero(12, 12);
  int at = 0;
  for (int i = 0; i < 12; ++i)
    for (int j = i + 1; j < 12; ++j) result(i, j) = result(j, i) = 7 - s[at++];
  return result;
}

TEST(Scaling, HasTheStressThatSmacofPrints) {  // 0.227 ratio, 0.015 ordinal: the vignette of smacof, on `intelligence`
  const auto ratio = scale(intelligence(), {.kind = ScalingKind::ratio});
  ASSERT_TRUE(ratio);
  EXPECT_NEAR(ratio->classical_stress, 0.227, 0.0005);
  EXPECT_LE(ratio->stress, ratio->classical_stress);
  const auto ordinal = scale(intelligence(), {.kind = ScalingKind::ordinal});
  ASSERT_TRUE(ordinal);
  EXPECT_NEAR(ordinal->classical_stress, 0.015, 0.0005);
  EXPECT_LE(ordinal->stress, ordinal->classical_stress);
}

TEST(Scaling, FindsBetterStartsThanTheClassicalOne) {  // smacof's vignette: 0.2185, and 0.2178 from random starts
  const auto found = scale(nations(), {.kind = ScalingKind::ratio});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->classical_stress, 0.2185, 1e-4);
  EXPECT_NEAR(found->stress, 0.2178, 1e-4);
  EXPECT_EQ(found->starts, 101u);
  EXPECT_LT(found->near_best, found->starts) << "some starts end in side valleys";
}

TEST(Scaling, RecoversAPlane) {
  Random random(2);
  MatrixXd points(9, 2), apart = MatrixXd::Zero(9, 9);
  for (int i = 0; i < 9; ++i) points.row(i) << random.normal(), random.normal();
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) apart(i, j) = (points.row(i) - points.row(j)).norm();
  const MatrixXd classical = classical_scaling(apart, 2);
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) EXPECT_NEAR((classical.row(i) - classical.row(j)).norm(), apart(i, j), 1e-9);
  const auto ratio = scale(apart, {.kind = ScalingKind::ratio, .random_starts = 10});
  ASSERT_TRUE(ratio);
  EXPECT_LT(ratio->stress, 1e-4);
  // An order survives any rising change of the dissimilarities.
  const auto ordinal = scale(apart.array().cube().matrix(), {.kind = ScalingKind::ordinal, .random_starts = 10});
  ASSERT_TRUE(ordinal);
  EXPECT_LT(ordinal->stress, 0.01);
  const auto again = scale(apart.array().cube().matrix(), {.kind = ScalingKind::ordinal, .random_starts = 10});
  EXPECT_EQ(again->points, ordinal->points) << "the same for the same seed";
}

TEST(Scaling, RefusesWhatIsNoDissimilarity) {
  EXPECT_FALSE(scale(MatrixXd::Zero(3, 4)));
  EXPECT_FALSE(scale(MatrixXd::Zero(8, 8)));
  EXPECT_FALSE(scale(MatrixXd::Ones(3, 3) - MatrixXd::Identity(3, 3)));
  MatrixXd skew = intelligence();
  skew(0, 1) = 0.1;
  EXPECT_FALSE(scale(skew));
  skew = intelligence();
  skew(0, 1) = skew(1, 0) = -1;
  EXPECT_FALSE(scale(skew));
}

TEST(Scaling, PoolsNeighboursThatFall) {
  EXPECT_EQ(rising({1, 3, 2, 4}), (std::vector<double>{1, 2.5, 2.5, 4}));
  EXPECT_EQ(rising({3, 2, 1}), (std::vector<double>{2, 2, 2}));
  EXPECT_TRUE(rising({}).empty());
}

}  // namespace
}  // namespace wale::analysis
