// Magnitude estimation: the identities of the thesis's figures with its table, and planted observers.
#include "calibration/analysis/magnitude.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "calibration/analysis/random.hpp"
#include "tests/analysis/published.hpp"

namespace wale::analysis {
namespace {

/// The amplitudes of Minsky 1995, table 6, in program units.
std::vector<double> amplitudes_of_table6() {
  const auto table = published("calibration/maps/minsky1995_table6.csv");
  EXPECT_TRUE(table) << in_words(table.error());
  std::vector<double> result;
  for (std::size_t row = 0; row < table->rows(); ++row) result.push_back(*number_in(table->cell(row, *table->column("program_units"))));
  return result;
}

/// What makes planted observers differ.
struct Planted {
  double exponent = 0.759593, spread = 0, noise = 0, numbers = 0;
  double of_period = 0, of_square = 0, of_waveform = 0, of_before = 0;
};

/// A study of planted observers, synthetic: 15 of them, 3 runs. Table 6's amplitudes, or 3 x 3 sizes and periods.
std::string study(const Planted& planted, std::uint64_t seed, bool crossed = false, std::size_t observers = 15) {
  Random random(seed);
  std::vector<std::array<double, 2>> stimuli;
  if (crossed)
    for (const double amplitude : {10.0, 40.0, 100.0})
      for (const double period : {1.2, 2.5, 5.0}) stimuli.push_back({amplitude, period});
  else
    for (const double amplitude : amplitudes_of_table6()) stimuli.push_back({amplitude, 2.5});
  std::ostringstream text;
  text.precision(17);
  text << "participant\trun\ttrial\tamplitude (pu)\tperiod (mm)\twaveform\tresponse\n";
  for (std::size_t observer = 0; observer < observers; ++observer) {
    const double exponent = planted.exponent + planted.spread * random.normal();
    const double numbers = -0.513365 + planted.numbers * random.normal();
    for (int run = 1; run <= 3; ++run) {
      double before = 0;
      for (std::size_t i = stimuli.size(); i > 1; --i) std::swap(stimuli[i - 1], stimuli[random.below(i)]);
      for (std::size_t trial = 0; trial < stimuli.size(); ++trial) {
        const auto& [amplitude, period] = stimuli[trial];
        const bool sine = (trial + observer) % 2 == 0;
        const double x = std::log10(amplitude), away = x - 1.6;
        const double y = numbers + exponent * x + planted.of_square * away * away + planted.of_period * std::log10(period) +
                         (sine ? planted.of_waveform : 0) + planted.of_before * before + planted.noise * random.normal();
        before = away;
        text << "S" << observer + 1 << '\t' << run << '\t' << trial + 1 << '\t' << amplitude << '\t' << period << '\t'
             << (sine ? "sine" : "square") << '\t' << std::pow(10, y) << '\n';
      }
    }
  }
  return text.str();
}

Trials study_of(const std::string& text, std::vector<SizeColumn> sizes = {{"amplitude", "amplitude (pu)"}},
                 std::vector<std::string> factors = {}) {
  const auto table = read_table("planted.tsv", text);
  EXPECT_TRUE(table) << in_words(table.error());
  TrialColumns columns;
  columns.sizes = std::move(sizes), columns.factors = std::move(factors);
  auto trials = read_trials(*table, columns);
  EXPECT_TRUE(trials) << in_words(trials.error());
  return *trials;
}

// Figure 19: with residuals of the printed sum of squares, least squares on the 30 amplitudes gives all that is printed.
// The residuals are synthetic: the thesis prints no ratings.
TEST(ThesisWay, GivesFigure19FromTable6) {
  const std::vector<double> amplitudes = amplitudes_of_table6();
  ASSERT_EQ(amplitudes.size(), 30u);
  Design design{{"constant", "log10 amplitude"}, Eigen::MatrixXd::Ones(30, 2)};
  Eigen::VectorXd noise(30);
  Random random(1995);
  for (Eigen::Index i = 0; i < 30; ++i) {
    design.columns(i, 1) = std::log10(amplitudes[static_cast<std::size_t>(i)]);
    noise(i) = random.normal();
  }
  const auto loose = fit_least_squares(design, noise);
  ASSERT_TRUE(loose);
  // The part of the noise that no line explains, scaled to the printed sum.
  Eigen::VectorXd y = -0.513365 + 0.759593 * design.columns.col(1).array();
  for (Eigen::Index i = 0; i < 30; ++i)
    y(i) += loose->residuals[static_cast<std::size_t>(i)] * std::sqrt(0.075531 / loose->residual_squares);
  const auto fit = fit_least_squares(design, y);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->at("constant").value, -0.513365, 1e-9);
  EXPECT_NEAR(fit->at("log10 amplitude").value, 0.759593, 1e-9);
  EXPECT_NEAR(fit->at("constant").error, 0.0465, 5e-5);
  EXPECT_NEAR(fit->at("log10 amplitude").error, 0.0270, 5e-5);
  EXPECT_NEAR(fit->at("constant").t(), -11.0, 0.05);
  EXPECT_NEAR(fit->at("log10 amplitude").t(), 28.1, 0.05);
  EXPECT_EQ(fit->freedom, 28);
  EXPECT_NEAR(fit->deviation(), 0.0519, 5e-5);
  EXPECT_NEAR(fit->explained_squares, 2.12719, 5e-5);
  EXPECT_NEAR(fit->f(), 789, 0.5);
  EXPECT_NEAR(100 * fit->explained_share(), 96.6, 0.05);
  EXPECT_NEAR(100 * fit->adjusted_share(), 96.4, 0.05);
  // Figure 20: its sums, uncentred, are those of the same 30 values, so it was fitted without a constant.
  EXPECT_NEAR(y.squaredNorm(), 19.4153 + 0.390085, 2e-4);
}

TEST(ThesisWay, RefusesFigure20) {  // without a constant a fit of logarithms depends on the units
  const std::vector<double> amplitudes = amplitudes_of_table6();
  Design design{{"log10 amplitude", "log10 period"}, Eigen::MatrixXd(30, 2)};
  for (Eigen::Index i = 0; i < 30; ++i)
    design.columns.row(i) << std::log10(amplitudes[static_cast<std::size_t>(i)]), std::log10(1.0 + static_cast<double>(i % 9));
  const auto fit = fit_least_squares(design, Eigen::VectorXd::LinSpaced(30, 0.2, 1.2));
  ASSERT_FALSE(fit);
  EXPECT_EQ(fit.error().code, Code::not_measured);
  const Trials trials = study_of(study({.noise = 0.05}, 3, true), {{"amplitude", "amplitude (pu)"}, {"period", "period (mm)"}});
  using Kind = Term::Kind;
  EXPECT_FALSE(design_of(trials, {{.kind = Kind::size, .size = "amplitude"}}));
  EXPECT_FALSE(design_of(trials, {{}, {.kind = Kind::squared, .size = "amplitude"}}));
  EXPECT_FALSE(design_of(trials, {{}, {.kind = Kind::size, .size = "amplitude"}, {.kind = Kind::product, .size = "amplitude", .other = "period"}}));
  EXPECT_TRUE(design_of(trials, {{}, {.kind = Kind::size, .size = "amplitude"}, {.kind = Kind::size, .size = "period"},
                                 {.kind = Kind::product, .size = "amplitude", .other = "period"}}));
}

TEST(Magnitude, IsTheSameInAllUnits) {
  const std::string text = study({.spread = 0.2, .noise = 0.1, .numbers = 0.3}, 11, true);
  Trials trials = study_of(text, {{"amplitude", "amplitude (pu)"}, {"period", "period (mm)"}});
  const auto one = analyse_magnitudes(trials);
  for (double& each : trials.sizes[0].values) each *= 19.53125;  // mN
  for (double& each : trials.sizes[1].values) each *= 10;
  const auto other = analyse_magnitudes(trials);
  ASSERT_TRUE(one && other);
  EXPECT_NEAR(one->exponent.value, other->exponent.value, 1e-9);
  EXPECT_NEAR(one->exponent.error, other->exponent.error, 1e-8);
  EXPECT_NEAR(one->constant.value, other->constant.value + one->exponent.value * std::log10(19.53125), 1e-9);
  ASSERT_EQ(one->alternatives.size(), other->alternatives.size());
  for (std::size_t i = 0; i < one->alternatives.size(); ++i)
    EXPECT_NEAR(one->alternatives[i].comparison.chi_squared, other->alternatives[i].comparison.chi_squared, 1e-5)
        << one->alternatives[i].name;
}

TEST(Magnitude, FindsWhatWasPlanted) {
  const Trials trials = study_of(study({.spread = 0.25, .noise = 0.12, .numbers = 0.4}, 21));
  const auto found = analyse_magnitudes(trials);
  ASSERT_TRUE(found) << in_words(found.error());
  EXPECT_LE(found->exponent.low(), 0.759593);
  EXPECT_GE(found->exponent.high(), 0.759593);
  EXPECT_TRUE(found->spread_interval->holds(0.25));
  EXPECT_TRUE(found->noise_interval->holds(0.12));
  EXPECT_GT(found->use_of_numbers, 0.2);
  EXPECT_EQ(found->low, 9);
  EXPECT_EQ(found->high, 194);
  EXPECT_EQ(found->observers.size(), 15u);
  EXPECT_EQ(found->unit, "pu");
  // All ways nearly agree: stimuli of one amplitude, of which table 6 has two pairs, count once among the means.
  EXPECT_NEAR(found->thesis.regression.at("log10 amplitude").value, found->exponent.value, 0.01);
  EXPECT_NEAR(found->equalised->regression.at("log10 amplitude").value, found->exponent.value, 0.01);
  ASSERT_TRUE(found->lack_of_fit);
  EXPECT_EQ(found->lack_of_fit->freedom, 26u) << "28 amplitudes and a line";
}

/// The names of the alternatives that are better than the law.
std::string better(const Planted& planted, bool crossed = true) {
  const Trials trials = study_of(study(planted, 5, crossed, 12),
                                  crossed ? std::vector<SizeColumn>{{"amplitude", "amplitude (pu)"}, {"period", "period (mm)"}}
                                          : std::vector<SizeColumn>{{"amplitude", "amplitude (pu)"}},
                                  {"waveform"});
  const auto found = analyse_magnitudes(trials, {.size = "amplitude", .intervals_of_spread = false});
  EXPECT_TRUE(found) << in_words(found.error());
  std::string names;
  for (const Alternative& each : found->alternatives) {
    EXPECT_EQ(each.refused, "") << each.name;
    if (each.comparison.p < 0.01) names += each.name + "; ";
  }
  return names;
}

TEST(Magnitude, FindsOutObserversWhoContradictTheLaw) {
  EXPECT_EQ(better({.spread = 0.2, .noise = 0.1, .numbers = 0.3}), "");
  EXPECT_EQ(better({.spread = 0.2, .noise = 0.1, .numbers = 0.3, .of_period = 0.2}), "with period; with period and its product; ");
  EXPECT_EQ(better({.spread = 0.2, .noise = 0.1, .numbers = 0.3, .of_waveform = 0.1}), "with waveform; with waveform and its product; ");
  EXPECT_EQ(better({.spread = 0.2, .noise = 0.1, .numbers = 0.3, .of_before = 0.15}), "with carry-over from the trial before; ");
  const std::string bent = better({.spread = 0.2, .noise = 0.1, .numbers = 0.3, .of_square = -0.3}, false);
  EXPECT_NE(bent.find("quadratic; piecewise"), std::string::npos) << bent;
}

TEST(Magnitude, NamesTheRegionThatWasPresented) {
  std::string text = "participant\tamplitude\tperiod\tresponse\n";
  for (const char* observer : {"A", "B"})
    for (const char* stimulus : {"1\t1\t3", "4\t1\t9", "4\t8\t10", "2\t2\t5", "2\t1.5\t4"})
      text += std::string(observer) + "\t" + stimulus + (observer[0] == 'A' ? "" : ".5") + "\n";
  const auto found = analyse_magnitudes(study_of(text, {{"amplitude"}, {"period"}}), {.intervals_of_spread = false});
  ASSERT_TRUE(found) << in_words(found.error());
  ASSERT_EQ(found->region.size(), 3u) << "2, 2 and 2, 1.5 lie inside, in logarithms";
}

TEST(Magnitude, SaysThatOneObserverIsOne) {
  const auto found = analyse_magnitudes(study_of(study({.noise = 0.1}, 2, false, 1)));
  ASSERT_TRUE(found) << in_words(found.error());
  EXPECT_EQ(found->spread, 0);
  ASSERT_FALSE(found->notes.empty());
  EXPECT_NE(found->notes.front().find("one observer"), std::string::npos);
}

}  // namespace
}  // namespace wale::analysis
