#include "calibration/analysis/magnitude.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "schema/visible_text.hpp"

namespace wale::analysis {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Kind = Term::Kind;

/// The least share of a difference by chance at which an alternative is called better than the law.
constexpr double significance = 0.05;
/// With more stimuli than this the comparison with any law takes long and says little.
constexpr std::size_t most_stimuli = 60;

VectorXd log_answers(const Trials& trials) {
  VectorXd y(static_cast<Index>(trials.size()));
  for (std::size_t i = 0; i < trials.size(); ++i) y(static_cast<Index>(i)) = std::log10(trials.answer[i]);
  return y;
}

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Sums for a straight line.
struct Line {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  void add(double at, double value) { n += 1, x += at, y += value, xx += at * at, xy += at * value, yy += value * value; }
  double across() const { return xx - x * x / n; }
  double slope() const { return (xy - x * y / n) / across(); }
  /// Whether the sizes differ beyond rounding; otherwise there is no slope.
  bool has_slope() const { return n > 1 && across() > 1e-12 * std::max(1.0, xx); }
  double slope_error() const {
    if (!has_slope()) return std::nan("");
    const double residual = (yy - y * y / n) - slope() * slope() * across();
    return n > 2 ? std::sqrt(std::max(residual, 0.0) / (n - 2) / across()) : std::nan("");
  }
};

std::vector<ObserverLaw> laws_of_observers(const Trials& trials, const SizeValues& size) {
  std::vector<Line> lines(trials.observers.size());
  const double middle = mean_log(size);
  for (std::size_t i = 0; i < trials.size(); ++i)
    lines[trials.observer[i]].add(std::log10(size.values[i]) - middle, std::log10(trials.answer[i]));
  std::vector<ObserverLaw> result;
  for (std::size_t i = 0; i < lines.size(); ++i)
    result.push_back({trials.observers[i], lines[i].has_slope() ? lines[i].slope() : std::nan(""), lines[i].slope_error(), lines[i].y / lines[i].n,
                      static_cast<std::size_t>(lines[i].n)});
  return result;
}

std::vector<StimulusMean> means_of_stimuli(const Trials& trials, const VectorXd& y, bool equalise) {
  VectorXd moved = y;
  if (equalise) {
    std::vector<double> sums(trials.observers.size()), counts(trials.observers.size());
    for (std::size_t i = 0; i < trials.size(); ++i)
      sums[trials.observer[i]] += y(static_cast<Index>(i)), counts[trials.observer[i]] += 1;
    double all = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) all += sums[i] / counts[i] / static_cast<double>(sums.size());
    for (std::size_t i = 0; i < trials.size(); ++i)
      moved(static_cast<Index>(i)) += all - sums[trials.observer[i]] / counts[trials.observer[i]];
  }
  // Means over runs first, so that each observer counts once.
  struct Cell {
    double sum = 0, count = 0;
  };
  std::vector<std::map<std::uint32_t, Cell>> cells(trials.stimuli);
  std::vector<StimulusMean> result(trials.stimuli);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    StimulusMean& mean = result[trials.stimulus[i]];
    if (mean.answers++ == 0) {
      mean.trial = i;
      for (const SizeValues& each : trials.sizes) mean.sizes.push_back(each.values[i]);
    }
    Cell& cell = cells[trials.stimulus[i]][trials.observer[i]];
    cell.sum += moved(static_cast<Index>(i)), cell.count += 1;
  }
  for (std::size_t s = 0; s < result.size(); ++s) {
    const auto n = static_cast<double>(cells[s].size());
    for (const auto& [observer, cell] : cells[s]) result[s].mean += cell.sum / cell.count / n;
    double squares = 0;
    for (const auto& [observer, cell] : cells[s])
      squares += (cell.sum / cell.count - result[s].mean) * (cell.sum / cell.count - result[s].mean);
    result[s].observers = cells[s].size();
    result[s].deviation = n > 1 ? std::sqrt(squares / (n - 1)) : std::nan("");
  }
  return result;
}

/// The corners of the convex hull of points, anticlockwise (Andrew 1979).
std::vector<std::array<double, 2>> hull_of(std::vector<std::array<double, 2>> points) {
  std::ranges::sort(points);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  const auto turn = [](const auto& a, const auto& b, const auto& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  };
  std::vector<std::array<double, 2>> hull;
  for (int half = 0; half < 2; ++half) {
    const std::size_t base = hull.size();
    for (const auto& point : points) {
      while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 1e-12) hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

/// Analyses one study.
class MagnitudeAnalyst {
 public:
  MagnitudeAnalyst(const Trials& trials, const MagnitudeOptions& options)
      : trials_(trials), options_(options), y_(log_answers(trials)) {}

  Result<MagnitudeAnalysis> analyse() {
    const SizeValues* size = options_.size.empty() && !trials_.sizes.empty() ? &trials_.sizes.front()
                                                                            : trials_.size_named(options_.size);
    if (!size)
      return Error{.code = Code::malformed_value,
                   .sentence = "there is no size `" + options_.size + "` in the trials",
                   .mend = "name the column of the commanded size",
                   .place = {.name = trials_.files.front()}};
    size_ = size;
    analysis_.size = size->name, analysis_.unit = size->unit;
    const auto [low, high] = std::ranges::minmax(size->values);
    analysis_.low = low, analysis_.high = high;
    auto thesis = regress_means(trials_, size->name, false);
    if (!thesis) return thesis.error();
    analysis_.thesis = std::move(*thesis);
    if (auto equalised = regress_means(trials_, size->name, true)) analysis_.equalised = std::move(*equalised);
    analysis_.observers = laws_of_observers(trials_, *size);
    const auto own = std::ranges::count_if(analysis_.observers, [](const auto& each) { return std::isfinite(each.exponent); });
    if (own == 0 || (own < 2 && analysis_.observers.size() > 1))
      return Error{.code = Code::not_measured,
                   .sentence = std::to_string(own) + " of " + std::to_string(analysis_.observers.size()) +
                               " observers answered about two sizes or more, so nothing tells how people differ",
                   .mend = "collect whole sessions of two observers at least",
                   .place = {.name = trials_.files.front()}};
    if (const auto fitted = fit_law(); !fitted) return fitted.error();
    if (options_.alternatives)
      if (const auto compared = compare(); !compared) return compared.error();
    tell_region();
    tell_doubts();
    return std::move(analysis_);
  }

 private:
  Result<MixedData> data_of(const std::vector<Term>& terms) const {
    auto design = design_of(trials_, terms);
    if (!design) return design.error();
    return MixedData{std::move(*design), {0, 1}, trials_.observer, trials_.observers.size(), y_};
  }

  std::vector<Term> law() const { return {{}, {.kind = Kind::size, .size = size_->name}}; }

  Result<> fit_law() {
    auto data = data_of(law());
    if (!data) return data.error();
    // The law's constant is at size 1; the model's, at a typical size.
    analysis_.typical_log = mean_log(*size_);
    data->combination = Eigen::Vector2d(1, -analysis_.typical_log);
    auto model = fit_mixed_simplified(*data, Criterion::restricted);
    if (!model) return model.error();
    analysis_.model = std::move(*model);
    const MixedFit& fit = analysis_.model;
    analysis_.exponent = fit.coefficients[1];
    analysis_.constant = fit.combination;
    analysis_.constant.name = "constant";
    analysis_.spread = fit.deviation(1), analysis_.use_of_numbers = fit.deviation(0);
    analysis_.noise = fit.residual;
    analysis_.scatter = analysis_.thesis.regression.deviation();
    if (options_.intervals_of_spread) {
      if (analysis_.spread > 0) analysis_.spread_interval = profile_deviation(*data, fit.variation, 1);
      analysis_.noise_interval = profile_residual(*data, fit.variation);
    }
    std::string without;
    std::size_t lacking = 0;
    for (const ObserverLaw& each : analysis_.observers)
      if (!std::isfinite(each.exponent) && lacking++ < 5) without += (without.empty() ? "" : ", ") + visible_text(each.observer);
    if (lacking > 0)
      analysis_.notes.push_back(without + (lacking > 5 ? " and " + std::to_string(lacking - 5) + " more" : "") +
                                (lacking == 1 ? " has" : " have") +
                                " answers about one size alone, which give no exponent: they add to the constant and the "
                                "noise, and say nothing of how exponents differ");
    for (const std::string& reason : fit.simplified) analysis_.notes.push_back(reason);
    return {};
  }

  /// Compares a larger model with the law; both by maximum likelihood and with the same variation between observers.
  void compare_with(const std::string& name, std::vector<Term> more, std::size_t estimated_elsewhere = 0) {
    Alternative alternative{.name = name};
    std::vector<Term> terms = law();
    terms.insert(terms.end(), more.begin(), more.end());
    const auto data = data_of(terms);
    const auto fit = data ? fit_mixed(*data, Criterion::likelihood, analysis_.model.variation) : data.error();
    if (!fit) {
      alternative.refused = in_words(fit.error());
    } else {
      alternative.comparison = compare_by_likelihood(*plain_, *fit);
      if (estimated_elsewhere > 0) {
        alternative.comparison.freedom += estimated_elsewhere;
        MixedFit counted = *fit;
        counted.parameters += estimated_elsewhere;
        alternative.comparison = compare_by_likelihood(*plain_, counted);
      }
      alternative.akaike_gain =
          plain_->akaike() - fit->akaike() - 2 * static_cast<double>(estimated_elsewhere);
      alternative.added.assign(fit->coefficients.begin() + 2, fit->coefficients.end());
    }
    analysis_.alternatives.push_back(std::move(alternative));
  }

  Result<> compare() {
    const auto data = data_of(law());
    if (!data) return data.error();
    auto plain = fit_mixed(*data, Criterion::likelihood, analysis_.model.variation);
    if (!plain) return plain.error();
    plain_ = std::move(*plain);
    const std::string& size = size_->name;
    compare_with("quadratic", {{.kind = Kind::squared, .size = size}});
    compare_bend();
    for (const SizeValues& other : trials_.sizes) {
      if (other.name == size) continue;
      compare_with("with " + other.name, {{.kind = Kind::size, .size = other.name}});
      compare_with("with " + other.name + " and its product",
                   {{.kind = Kind::size, .size = other.name}, {.kind = Kind::product, .size = size, .other = other.name}});
    }
    for (const FactorValues& factor : trials_.factors) {
      compare_with("with " + factor.name, {{.kind = Kind::factor, .factor = factor.name}});
      compare_with("with " + factor.name + " and its product",
                   {{.kind = Kind::factor, .factor = factor.name},
                    {.kind = Kind::size_by_factor, .size = size, .factor = factor.name}});
    }
    if (trials_.size() > trials_.observers.size())
      compare_with("with carry-over from the trial before", {{.kind = Kind::size_before, .size = size}});
    if (trials_.stimuli > 3 && trials_.stimuli <= most_stimuli && trials_.stimuli * 2 < trials_.size() &&
        trials_.stimuli * trials_.size() < 10000000) {
      // The law lies within the space of all means, so the stimuli's columns replace it; the slope still varies.
      auto any = design_of(trials_, {{}, {.kind = Kind::size, .size = size}, {.kind = Kind::stimulus}});
      if (any) {
        MixedData larger{std::move(*any), {0, 1}, trials_.observer, trials_.observers.size(), y_};
        // One column of the stimuli depends on the others and the size.
        while (true) {
          const std::string name = dependent_column(larger.fixed);
          if (name.empty()) break;
          const auto at = static_cast<Index>(std::ranges::find(larger.fixed.names, name) - larger.fixed.names.begin());
          const Index last = larger.fixed.columns.cols() - 1;
          for (Index i = at; i < last; ++i) larger.fixed.columns.col(i) = larger.fixed.columns.col(i + 1).eval();
          larger.fixed.columns.conservativeResize(Eigen::NoChange, last);
          larger.fixed.names.erase(larger.fixed.names.begin() + at);
        }
        if (const auto fit = fit_mixed(larger, Criterion::likelihood, analysis_.model.variation))
          analysis_.lack_of_fit = compare_by_likelihood(*plain_, *fit);
      }
    }
    return {};
  }

  /// Two lines that meet at one of the inner sizes: the best of them, whose place counts as estimated.
  void compare_bend() {
    std::vector<double> sizes = size_->values;
    std::ranges::sort(sizes);
    sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
    if (sizes.size() < 5) return;
    // With very many sizes, quantiles are enough.
    std::vector<double> knots;
    const std::size_t inner = sizes.size() - 4, count = std::min<std::size_t>(inner, 12);
    for (std::size_t i = 0; i < count; ++i) knots.push_back(sizes[2 + i * inner / count]);
    std::optional<std::pair<double, double>> best;  // deviance, knot
    for (const double knot : knots) {
      std::vector<Term> terms = law();
      terms.push_back({.kind = Kind::bent, .size = size_->name, .knot = knot});
      const auto data = data_of(terms);
      if (!data) continue;
      const auto fit = fit_mixed(*data, Criterion::likelihood, analysis_.model.variation);
      if (fit && (!best || fit->deviance < best->first)) best = {fit->deviance, knot};
    }
    if (!best) return;
    compare_with("piecewise, bent at " + rounded(best->second) + (size_->unit.empty() ? "" : " " + size_->unit),
                 {{.kind = Kind::bent, .size = size_->name, .knot = best->second}}, 1);
  }

  void tell_region() {
    if (trials_.sizes.size() != 2) return;
    std::vector<std::array<double, 2>> points;
    for (const StimulusMean& each : analysis_.thesis.means) points.push_back({std::log(each.sizes[0]), std::log(each.sizes[1])});
    for (const auto& corner : hull_of(points)) analysis_.region.push_back({std::exp(corner[0]), std::exp(corner[1])});
  }

  void tell_doubts() {
    for (const Alternative& each : analysis_.alternatives)
      if (each.refused.empty() && each.comparison.p < significance)
        analysis_.notes.push_back("the model `" + each.name + "` fits better than the law (chi-squared " +
                                  rounded(each.comparison.chi_squared) + " on " + std::to_string(each.comparison.freedom) +
                                  ", p = " + rounded(each.comparison.p) + ")");
    if (analysis_.lack_of_fit && analysis_.lack_of_fit->p < significance)
      analysis_.notes.push_back("the means of the stimuli leave the law further than their scatter explains (chi-squared " +
                                rounded(analysis_.lack_of_fit->chi_squared) + " on " +
                                std::to_string(analysis_.lack_of_fit->freedom) + ", p = " + rounded(analysis_.lack_of_fit->p) + ")");
    if (!(analysis_.exponent.p() < significance))
      analysis_.notes.push_back("the exponent does not differ from zero beyond chance (p = " + rounded(analysis_.exponent.p()) + ")");
  }

  const Trials& trials_;
  const MagnitudeOptions& options_;
  VectorXd y_;
  const SizeValues* size_ = nullptr;
  std::optional<MixedFit> plain_;
  MagnitudeAnalysis analysis_;
};

}  // namespace

Result<MeansRegression> regress_means(const Trials& trials, const std::string& size, bool equalise) {
  const SizeValues* values = trials.size_named(size);
  if (!values)
    return Error{.code = Code::malformed_value, .sentence = "there is no size `" + size + "` in the trials", .mend = "read it as a size"};
  for (std::size_t i = 0; i < values->values.size(); ++i)
    if (!(values->values[i] > 0))
      return Error{.code = Code::malformed_value,
                   .sentence = "the " + size + " is zero or below, which has no logarithm",
                   .mend = "leave such trials out by rule",
                   .place = trials.place(i)};
  MeansRegression result;
  result.equalised = equalise;
  result.means = means_of_stimuli(trials, log_answers(trials), equalise);
  Design design{{"constant", "log10 " + size}, Eigen::MatrixXd::Ones(static_cast<Index>(result.means.size()), 2)};
  VectorXd y(static_cast<Index>(result.means.size()));
  for (std::size_t i = 0; i < result.means.size(); ++i) {
    design.columns(static_cast<Index>(i), 1) = std::log10(values->values[result.means[i].trial]);
    y(static_cast<Index>(i)) = result.means[i].mean;
  }
  auto regression = fit_least_squares(design, y);
  if (!regression) return regression.error();
  result.regression = std::move(*regression);
  return result;
}

Result<MagnitudeAnalysis> analyse_magnitudes(const Trials& trials, const MagnitudeOptions& options) {
  return MagnitudeAnalyst(trials, options).analyse();
}

}  // namespace wale::analysis
