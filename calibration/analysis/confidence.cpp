#include "calibration/analysis/confidence.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace wale::analysis {
namespace {

/// Mean and standard deviation of numbers that come one by one (Welford 1962).
struct Moments {
  double n = 0, mean = 0, squares = 0;
  void add(double value) {
    n += 1;
    const double away = value - mean;
    mean += away / n;
    squares += away * (value - mean);
  }
  double deviation() const { return n > 1 ? std::sqrt(squares / (n - 1)) : std::nan(""); }
};

std::size_t tenth_of(double rating) { return std::min<std::size_t>(9, static_cast<std::size_t>(rating / 10)); }

std::string written(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string name_of(const Trials& trials, std::size_t trial) {
  std::string name;
  for (const FactorValues& each : trials.factors)
    name += (name.empty() ? "" : ", ") + each.levels[each.values[trial]];
  if (!name.empty()) return name;
  for (const SizeValues& each : trials.sizes)
    name += (name.empty() ? "" : ", ") + each.name + " " + written(each.values[trial]) + (each.unit.empty() ? "" : " " + each.unit);
  return name;
}

std::optional<RunCorrelation> correlation_of_runs(const Trials& trials) {
  if (trials.runs.size() < 2) return std::nullopt;
  // The mean ratings of one stimulus by one observer in the first two runs.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::array<Moments, 2>> cells;
  for (std::size_t i = 0; i < trials.size(); ++i)
    if (trials.run[i] < 2) cells[{trials.observer[i], trials.stimulus[i]}][trials.run[i]].add(trials.answer[i]);
  std::vector<double> first, second;
  for (const auto& [key, cell] : cells)
    if (cell[0].n > 0 && cell[1].n > 0) first.push_back(cell[0].mean), second.push_back(cell[1].mean);
  const auto r = correlation(first, second);
  if (!r) return std::nullopt;
  RunCorrelation result{*r, -1, 1, first.size()};
  if (first.size() > 3 && std::abs(*r) < 1) {
    const double z = std::atanh(*r), error = 1.959963984540054 / std::sqrt(static_cast<double>(first.size()) - 3);
    result.low = std::tanh(z - error), result.high = std::tanh(z + error);
  }
  return result;
}

/// Puts the mean of the observers' own regressions, with t of their scatter, in place of coefficients whose errors rest
/// on the stimuli: many stimuli tell nothing of other people.
void rest_on_observers(const Trials& trials, const Design& design, Regression& regression, std::vector<std::string>& notes) {
  const std::size_t people = trials.observers.size();
  std::vector<Moments> own(regression.coefficients.size());
  for (std::size_t observer = 0; observer < people; ++observer) {
    std::vector<Moments> of_stimuli(trials.stimuli);
    for (std::size_t i = 0; i < trials.size(); ++i)
      if (trials.observer[i] == observer) of_stimuli[trials.stimulus[i]].add(trials.answer[i]);
    std::vector<Eigen::Index> rated;
    for (std::size_t s = 0; s < trials.stimuli; ++s)
      if (of_stimuli[s].n > 0) rated.push_back(static_cast<Eigen::Index>(s));
    Design rows{design.names, design.columns(rated, Eigen::all)};
    Eigen::VectorXd y(static_cast<Eigen::Index>(rated.size()));
    for (std::size_t k = 0; k < rated.size(); ++k)
      y(static_cast<Eigen::Index>(k)) = of_stimuli[static_cast<std::size_t>(rated[k])].mean;
    const auto fitted = fit_least_squares(rows, y);
    if (!fitted || people < 2) {
      notes.push_back("the errors of the regression rest on the stimuli's means, and say nothing of other people, since "
                      "not each of two observers or more has a regression of their own");
      return;
    }
    for (std::size_t k = 0; k < own.size(); ++k) own[k].add(fitted->coefficients[k].value);
  }
  for (std::size_t k = 0; k < own.size(); ++k) {
    regression.coefficients[k].value = own[k].mean;
    regression.coefficients[k].error = own[k].deviation() / std::sqrt(own[k].n);
    regression.coefficients[k].freedom = own[k].n - 1;
  }
}

}  // namespace

std::optional<double> correlation(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size() || a.size() < 2) return std::nullopt;
  Moments of_a, of_b;
  for (const double each : a) of_a.add(each);
  for (const double each : b) of_b.add(each);
  if (!(of_a.squares > 0) || !(of_b.squares > 0)) return std::nullopt;
  double product = 0;
  for (std::size_t i = 0; i < a.size(); ++i) product += (a[i] - of_a.mean) * (b[i] - of_b.mean);
  return std::clamp(product / std::sqrt(of_a.squares * of_b.squares), -1.0, 1.0);
}

double largest_gradient(const std::vector<double>& heights, double step) {
  double most = 0;
  for (std::size_t i = 0; i < heights.size(); ++i)
    most = std::max(most, std::abs(heights[(i + 1) % heights.size()] - heights[i]));
  return most / step;
}

Result<ConfidenceAnalysis> analyse_confidence(const Trials& trials) {
  ConfidenceAnalysis result;
  Moments all;
  std::vector<Moments> of_stimuli(trials.stimuli), of_observers(trials.observers.size());
  std::vector<std::size_t> first(trials.stimuli, trials.size());
  result.observers.resize(trials.observers.size());
  std::size_t high = 0, full = 0;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const double rating = trials.answer[i];
    if (!(rating >= 0 && rating <= 100))
      return Error{.code = Code::malformed_value,
                   .sentence = "expected a rating from 0 to 100",
                   .mend = "name the column of the ratings",
                   .place = trials.place(i)};
    all.add(rating);
    of_stimuli[trials.stimulus[i]].add(rating);
    of_observers[trials.observer[i]].add(rating);
    first[trials.stimulus[i]] = std::min(first[trials.stimulus[i]], i);
    ++result.histogram[tenth_of(rating)], ++result.observers[trials.observer[i]].histogram[tenth_of(rating)];
    high += rating >= 80 ? 1 : 0, full += rating == 100 ? 1 : 0;
  }
  const auto n = static_cast<double>(trials.size());
  result.mean = all.mean, result.deviation = all.deviation();
  result.at_least_80 = static_cast<double>(high) / n, result.full = static_cast<double>(full) / n;
  for (std::size_t i = 0; i < trials.observers.size(); ++i) {
    RatedObserver& observer = result.observers[i];
    observer.observer = trials.observers[i];
    observer.mean = of_observers[i].mean, observer.deviation = of_observers[i].deviation();
    const double ends = static_cast<double>(observer.histogram.front() + observer.histogram.back());
    observer.use = ends > 0.6 * of_observers[i].n && observer.histogram.front() > 0 && observer.histogram.back() > 0 ? UseOfScale::clipped
                   : observer.mean < 40 ? UseOfScale::sceptical
                                        : UseOfScale::intermediate;
  }
  std::size_t above = 0;
  for (std::size_t s = 0; s < trials.stimuli; ++s) {
    result.stimuli.push_back({name_of(trials, first[s]), first[s], of_stimuli[s].mean, of_stimuli[s].deviation(),
                              static_cast<std::size_t>(of_stimuli[s].n)});
    above += of_stimuli[s].mean > 80 ? 1 : 0;
  }
  result.above_80 = static_cast<double>(above) / static_cast<double>(trials.stimuli);
  result.between_runs = correlation_of_runs(trials);
  if (!trials.sizes.empty()) {
    Design design;
    design.names = {"constant"};
    design.columns = Eigen::MatrixXd::Ones(static_cast<Eigen::Index>(trials.stimuli), static_cast<Eigen::Index>(trials.sizes.size()) + 1);
    Eigen::VectorXd y(static_cast<Eigen::Index>(trials.stimuli));
    for (std::size_t s = 0; s < trials.stimuli; ++s) {
      y(static_cast<Eigen::Index>(s)) = of_stimuli[s].mean;
      for (std::size_t k = 0; k < trials.sizes.size(); ++k)
        design.columns(static_cast<Eigen::Index>(s), static_cast<Eigen::Index>(k) + 1) = trials.sizes[k].values[first[s]];
    }
    for (const SizeValues& each : trials.sizes) design.names.push_back(each.name);
    if (auto regression = fit_least_squares(design, y)) {
      result.regression = std::move(*regression);
      rest_on_observers(trials, design, *result.regression, result.notes);
    }
    else result.regression_refused = regression.error().sentence;
  }
  if (trials.runs.size() > 2) result.notes.push_back("the correlation is between the first two of " + std::to_string(trials.runs.size()) + " runs");
  std::ranges::stable_sort(result.stimuli, {}, &RatedStimulus::mean);
  return result;
}

}  // namespace wale::analysis
