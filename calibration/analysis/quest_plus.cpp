#include "calibration/analysis/quest_plus.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace wale::analysis {

std::vector<std::vector<double>> points_of(const Grid& grid) {
  std::vector<std::vector<double>> points = {{}};
  for (const std::vector<double>& values : grid) {
    std::vector<std::vector<double>> longer;
    longer.reserve(points.size() * values.size());
    for (const std::vector<double>& point : points)
      for (const double value : values) {
        longer.push_back(point);
        longer.back().push_back(value);
      }
    points = std::move(longer);
  }
  return points;
}

QuestPlus::QuestPlus(const Grid& stimuli, const Grid& parameters, std::size_t outcomes, const Model& model,
                     std::vector<double> prior)
    : stimuli_(points_of(stimuli)), points_(points_of(parameters)), outcomes_(outcomes), posterior_(std::move(prior)) {
  chances_.reserve(outcomes * stimuli_.size() * points_.size());
  for (std::size_t outcome = 0; outcome < outcomes; ++outcome)
    for (const std::vector<double>& stimulus : stimuli_)
      for (const std::vector<double>& point : points_) chances_.push_back(std::clamp(model(outcome, stimulus, point), 0.0, 1.0));
  self_.reserve(chances_.size());
  for (const double p : chances_) self_.push_back(p > 0 ? p * std::log(p) : 0);
  if (posterior_.size() != points_.size()) posterior_.assign(points_.size(), 1);
  const double sum = std::accumulate(posterior_.begin(), posterior_.end(), 0.0);
  for (double& each : posterior_) each /= sum;
}

double QuestPlus::expected_entropy(std::size_t stimulus) const {
  // Sum over outcomes of p(outcome) times the entropy of the posterior after it:
  // sum of p(o) log p(o) - sum over points of w p log p, and the same with log w, which is the same for all outcomes.
  double total = 0;
  for (std::size_t outcome = 0; outcome < outcomes_; ++outcome) {
    const std::size_t at = (outcome * stimuli_.size() + stimulus) * points_.size();
    double whole = 0, inner = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      whole += posterior_[i] * chances_[at + i];
      inner += posterior_[i] * self_[at + i];
    }
    total += (whole > 0 ? whole * std::log(whole) : 0) - inner;
  }
  return entropy() + total;
}

std::size_t QuestPlus::next_number(double indifference) const {
  std::size_t best = 0;
  double least = 0;
  for (std::size_t i = 0; i < stimuli_.size(); ++i) {
    const double expected = expected_entropy(i);
    if (i == 0 || expected < least - indifference) best = i, least = expected;
  }
  return best;
}

void QuestPlus::update(std::size_t stimulus, std::size_t outcome) {
  double sum = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) sum += posterior_[i] * chance(outcome, stimulus, i);
  ++answers_;
  if (!(sum > 0)) return;  // an answer that all parameters exclude teaches nothing
  for (std::size_t i = 0; i < points_.size(); ++i) posterior_[i] *= chance(outcome, stimulus, i) / sum;
}

double QuestPlus::entropy() const {
  double sum = 0;
  for (const double p : posterior_) sum -= p > 0 ? p * std::log(p) : 0;
  return sum;
}

const std::vector<double>& QuestPlus::mode() const {
  return points_[static_cast<std::size_t>(std::ranges::max_element(posterior_) - posterior_.begin())];
}

std::vector<double> QuestPlus::mean() const {
  std::vector<double> result(points_.front().size());
  for (std::size_t i = 0; i < points_.size(); ++i)
    for (std::size_t k = 0; k < result.size(); ++k) result[k] += posterior_[i] * points_[i][k];
  return result;
}

std::vector<double> QuestPlus::deviation() const {
  const std::vector<double> middle = mean();
  std::vector<double> result(middle.size());
  for (std::size_t i = 0; i < points_.size(); ++i)
    for (std::size_t k = 0; k < result.size(); ++k)
      result[k] += posterior_[i] * (points_[i][k] - middle[k]) * (points_[i][k] - middle[k]);
  for (double& each : result) each = std::sqrt(each);
  return result;
}

double weibull_in_decibels(double stimulus, double threshold, double slope, double guess, double lapse) {
  return 1 - lapse - (1 - guess - lapse) * std::exp(-std::pow(10, slope * (stimulus - threshold) / 20));
}

}  // namespace wale::analysis
