// How often the 95 % intervals of levels hold, if both the panel that a law is fitted to and the people who then judge
// a level are drawn from people whose laws are known. The fit is ordinary least squares, written here.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <numbers>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "compiler/describe/level_intervals.hpp"

namespace wale::coverage_test {
namespace {

constexpr int panel = 15, runs = 10'000;
constexpr std::array levels{0.1, 0.36, 0.6, 1.0};
constexpr double scatter = 0.0519;  // of the means of fifteen people

/// Numbers that are the same on every machine: xorshift64*, and the polar angle and radius of a normal pair.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : state_(seed) {}
  double uniform() {
    state_ ^= state_ >> 12, state_ ^= state_ << 25, state_ ^= state_ >> 27;
    return (static_cast<double>((state_ * 0x2545F4914F6CDD1Dull) >> 11) + 0.5) / 9007199254740992.0;
  }
  double normal() {
    if (has_spare_) return has_spare_ = false, spare_;
    const double radius = std::sqrt(-2 * std::log(uniform())), angle = 2 * std::numbers::pi * uniform();
    has_spare_ = true, spare_ = radius * std::sin(angle);
    return radius * std::cos(angle);
  }

 private:
  std::uint64_t state_;
  bool has_spare_ = false;
  double spare_ = 0;
};

/// log10 of the forces of the thirty stimuli, from table 6 of the thesis.
std::vector<double> stimuli() {
  std::ifstream file(std::string(WALE_SOURCE_DIR) + "/calibration/maps/minsky1995_table6.csv");
  EXPECT_TRUE(file);
  std::vector<double> found;
  int column = -1;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream row(line);
    std::string cell;
    for (int i = 0; std::getline(row, cell, ','); ++i) {
      if (column < 0 && cell == "program_units")
        column = i;
      else if (i == column)
        found.push_back(std::log10(std::stod(cell)));
    }
  }
  return found;
}

/// The people of a world: how their exponents are distributed, and how the scatter of means divides into deviations of
/// the stimuli that all share, and noise of each judgement.
struct World {
  std::function<double(Chance&)> exponent;
  double mean = 0.76;
  double shared = 0;  ///< share of the scatter's square

  double deviation() const { return scatter * std::sqrt(shared); }
  double noise() const { return scatter * std::sqrt((1 - shared) * panel); }
};

/// A straight line through points, by least squares.
struct Line {
  double slope = 0, squares = 0, across = 0;  ///< squares of the residuals; of x about its mean

  Line(const std::vector<double>& x, const std::vector<double>& y) {
    const double n = static_cast<double>(x.size());
    const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n,
                 mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
    double product = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      across += (x[i] - mean_x) * (x[i] - mean_x), product += (x[i] - mean_x) * (y[i] - mean_y);
    slope = product / across;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double residual = y[i] - mean_y - slope * (x[i] - mean_x);
      squares += residual * residual;
    }
  }
};

struct Map {
  double slope = 0;
  LawUncertainty law;
};

/// A panel judges all stimuli; the law and all of its uncertainty are found from nothing but its judgements.
Map calibrated(const World& world, const std::vector<double>& x, Chance& chance) {
  const std::size_t count = x.size();
  std::vector<double> shared(count), means(count), slopes;
  for (double& each : shared) each = world.deviation() * chance.normal();
  double squares = 0, across = 0;
  for (int person = 0; person < panel; ++person) {
    const double exponent = world.exponent(chance);
    std::vector<double> judged(count);
    for (std::size_t i = 0; i < count; ++i) {
      judged[i] = exponent * x[i] + shared[i] + world.noise() * chance.normal();
      means[i] += judged[i] / panel;
    }
    const Line own(x, judged);
    slopes.push_back(own.slope), squares += own.squares, across = own.across;
  }
  const Line fitted(x, means);
  const double freedom = static_cast<double>(count) - 2;
  const double variance = fitted.squares / freedom, noise = squares / freedom / panel;
  double differences = 0;
  for (const double each : slopes) differences += (each - fitted.slope) * (each - fitted.slope);
  // The exponents that were found differ by the people's own and by the errors of finding them.
  const double spread = std::max(differences / (panel - 1) - noise / across, 1e-6);
  return {fitted.slope,
          {.scatter = static_cast<float>(std::sqrt(variance)),
           .slope_error = static_cast<float>(std::sqrt(variance / across)),
           .spread = static_cast<float>(std::sqrt(spread)),
           .noise = static_cast<float>(std::sqrt(noise)),
           .observers = panel,
           .stimuli = static_cast<std::uint16_t>(count)}};
}

struct Coverage {
  double means = 0, people = 0;
};

/// How often new people's mean, and a new person, fall within the intervals of each level.
std::array<Coverage, levels.size()> covered(const World& world, std::uint64_t seed) {
  const std::vector<double> x = stimuli();
  EXPECT_EQ(x.size(), 30u);
  Chance chance(seed);
  std::array<Coverage, levels.size()> found;
  for (int run = 0; run < runs; ++run) {
    const Map map = calibrated(world, x, chance);
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const double size = std::log10(levels[i]) / map.slope;  // log10 of the size that the map gives to this level
      const double shared = world.deviation() * chance.normal();
      double mean = 0, one = 0;
      for (int person = 0; person < panel; ++person) {
        one = world.exponent(chance) * size + shared + world.noise() * chance.normal();
        mean += one / panel;
      }
      const LevelIntervals intervals = level_intervals(map.law, levels[i], std::pow(10, size));
      const auto holds = [](const LevelBounds& bounds, double log_level) {
        return log_level >= std::log10(bounds.low) && log_level <= std::log10(bounds.high);
      };
      found[i].means += holds(intervals.means, mean) / static_cast<double>(runs);
      found[i].people += (intervals.people && holds(*intervals.people, one)) / static_cast<double>(runs);
    }
  }
  return found;
}

void report(const char* world, const std::array<Coverage, levels.size()>& found) {
  for (std::size_t i = 0; i < levels.size(); ++i)
    std::printf("%s, level %.2f: means %.1f %%, people %.1f %%\n", world, levels[i], 100 * found[i].means,
                100 * found[i].people);
}

double normal_exponent(Chance& chance) { return 0.76 + 0.39 * chance.normal(); }

/// All of the scatter is noise of judgements, or half of it is deviations of the stimuli from the law. At level 1, the
/// reference stimulus, only these vary: everyone's exponent gives level 1 there.
TEST(Coverage, OfIntervalsIsNinetyFivePercentForNewPanelsAndPeople) {
  for (const double shared : {0.0, 0.5}) {
    const auto found = covered({.exponent = normal_exponent, .shared = shared}, 1995);
    report(shared > 0 ? "normal exponents, stimuli that deviate" : "normal exponents", found);
    for (std::size_t i = 0; i < levels.size(); ++i) {
      EXPECT_GE(found[i].means, 0.93) << levels[i];
      EXPECT_LE(found[i].means, 0.97) << levels[i];
      EXPECT_GE(found[i].people, 0.93) << levels[i];
      EXPECT_LE(found[i].people, 0.97) << levels[i];
    }
  }
}

/// A normal distribution is no model of eleven exponents of 0.6, three of 0.9 and one of 2.1: a panel without a person
/// like S54 does not know of such people. schema/LANGUAGE.md tells these shares.
TEST(Coverage, IsLessForTheSkewedExponentsOfTheThesis) {
  const auto skewed = [](Chance& chance) {
    const double which = 15 * chance.uniform();
    return which < 11 ? 0.6 : which < 14 ? 0.9 : 2.1;
  };
  const auto found = covered({.exponent = skewed}, 54);
  report("exponents of the thesis", found);
  EXPECT_NEAR(found[0].means, 0.862, 0.015);
  EXPECT_NEAR(found[1].means, 0.905, 0.015);
  EXPECT_NEAR(found[2].means, 0.934, 0.015);
  EXPECT_NEAR(found[0].people, 0.92, 0.015);
  EXPECT_NEAR(found[3].means, 0.95, 0.015);
}

/// Where exponents are not known, nothing is said of single people, and the means are told as differing more.
TEST(Coverage, OfPeopleIsNotClaimedWithoutTheirExponents) {
  LawUncertainty law{.scatter = 0.1f, .noise = 0.2f, .observers = 15, .stimuli = 30};
  EXPECT_FALSE(level_intervals(law, 0.5, 0.4).people);
  EXPECT_TRUE(level_intervals(law, 0.5, 0.4).means_differ_more);
  law.spread = 0.3f;
  EXPECT_TRUE(level_intervals(law, 0.5, 0.4).people);
  EXPECT_FALSE(level_intervals(law, 0.5, 0.4).means_differ_more);
  law.observers = 0;  // nor are the means of a group of unknown size
  EXPECT_FALSE(level_intervals(law, 0.5, 0.4).people);
  EXPECT_TRUE(level_intervals(law, 0.5, 0.4).means_differ_more);
}

/// By hand for level 0.36 of figure 19: x = log10(0.36) / 0.759593 = -0.58412; the spread gives 0.39 x = 0.22781. With
/// 14 and 28 degrees of freedom (tables of t: 2.0639 at 24.0, 2.0739 at 22.0).
TEST(Coverage, TheIntervalsOfFigure19) {
  const LawUncertainty law{
      .scatter = 0.0519f, .slope_error = 0.0270f, .spread = 0.39f, .noise = 0.201f, .observers = 15, .stimuli = 30};
  const LevelIntervals found = level_intervals(law, 0.36, std::pow(10, -0.58412));
  // variances 2 * 0.051897 / 15 = 0.0069196 with 14, and 0.0002487 + 0.0026936 = 0.0029423 with 28: 0.0098619 with 26.1
  EXPECT_NEAR(std::log10(found.means.high / 0.36), 2.055 * std::sqrt(0.0098619), 1e-3);
  EXPECT_NEAR(std::log10(0.36 / found.means.low), 2.055 * std::sqrt(0.0098619), 1e-3);
  ASSERT_TRUE(found.people);
  // 0.051897 * 16 / 15 = 0.055357 with 14, and 0.0002487 + 0.040401 = 0.040650 with 28: 0.096007 with 33.1
  EXPECT_NEAR(std::log10(found.people->high / 0.36), 2.034 * std::sqrt(0.096007), 1e-3);
  // The thesis's S54, with the exponent 2.1, is within the interval of single people at level 0.6.
  const LevelIntervals at_60 = level_intervals(law, 0.6, std::pow(0.6, 1 / 0.759593));
  EXPECT_LT(at_60.people->low, std::pow(0.6, 2.1 / 0.759593));
}

}  // namespace
}  // namespace wale::coverage_test
