#include "calibration/analysis/population.hpp"

#include <algorithm>
#include <utility>

#include "calibration/analysis/optimise.hpp"

namespace wale::analysis {
namespace {

using Eigen::VectorXd;

constexpr double least_spread = 0.03, most_spread = 3;

}  // namespace

Population::Population(std::vector<const OneObserver*> observers, const SensitivityOptions& options)
    : options_(options), observers_(std::move(observers)) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const OneObserver* each : observers_) low = std::min(low, each->low()), high = std::max(high, each->high());
  // Finer than an observer's likelihood is wide, which is some 3 over the root of the trials.
  std::size_t most = 1;
  for (const OneObserver* each : observers_) {
    std::size_t trials = 0;
    for (const Level& level : each->answers().levels) trials += level.trials;
    most = std::max(most, trials);
  }
  constexpr double reach = 2;
  const double step = std::clamp(1.2 / std::sqrt(static_cast<double>(most)), 0.01, 0.1);
  const auto count = static_cast<int>(std::min(800.0, std::ceil((high - low + 2 * reach) / step)));
  for (int i = 0; i <= count; ++i) grid_.push_back(low - reach + (high - low + 2 * reach) * i / count);
  along_.resize(observers_.size());
  if (has_criterion(options.decision)) return;
  for (const OneObserver* each : observers_)
    for (const Level& level : each->answers().levels) sizes_.push_back(std::log(level.size));
  std::ranges::sort(sizes_);
  sizes_.erase(std::unique(sizes_.begin(), sizes_.end()), sizes_.end());
  for (const OneObserver* each : observers_) {
    std::vector<Counts>& counts = counts_.emplace_back();
    for (const Level& level : each->answers().levels)
      counts.push_back({static_cast<std::size_t>(std::ranges::lower_bound(sizes_, std::log(level.size)) - sizes_.begin()),
                        static_cast<double>(level.right), static_cast<double>(level.trials - level.right)});
  }
}

/// Without a criterion, the chances are the same for all observers and computed once.
void Population::along_choices(double exponent, double lapse) {
  for (auto& along : along_) along.assign(grid_.size(), 0);
  std::vector<double> right(sizes_.size()), wrong(sizes_.size());
  for (std::size_t g = 0; g < grid_.size(); ++g) {
    for (std::size_t i = 0; i < sizes_.size(); ++i) {
      const double d = std::exp(std::clamp(exponent * (sizes_[i] - grid_[g]), -50.0, 5.0));
      const double p = std::clamp(lapse + (1 - 2 * lapse) * chance_of(Decision::interval_choice, d, 0), 1e-12, 1 - 1e-12);
      right[i] = std::log(p), wrong[i] = std::log1p(-p);
    }
    for (std::size_t k = 0; k < counts_.size(); ++k)
      for (const Counts& each : counts_[k]) along_[k][g] += each.right * right[each.size] + each.wrong * wrong[each.size];
  }
}

std::vector<double> Population::log_likelihoods(const Place& at) {
  if (known_[0] != at[0] || known_[1] != at[1]) {
    known_ = {at[0], at[1]};
    if (!counts_.empty()) along_choices(std::exp(at[0]), at[1]);
    else
      for (std::size_t i = 0; i < observers_.size(); ++i) observers_[i]->along(grid_, std::exp(at[0]), at[1], along_[i]);
  }
  const double spread = std::exp(at[3]);
  std::vector<double> weights;
  double all = 0;
  for (const double each : grid_) weights.push_back(std::exp(-std::pow((each - at[2]) / spread, 2) / 2)), all += weights.back();
  std::vector<double> result;
  for (const auto& along : along_) {
    const double most = *std::ranges::max_element(along);
    double sum = 0;
    for (std::size_t g = 0; g < grid_.size(); ++g) sum += weights[g] * std::exp(along[g] - most);
    result.push_back(most + std::log(sum / all));
  }
  return result;
}

double Population::sum(const Place& at) {
  double sum = 0;
  for (const double each : log_likelihoods(at)) sum += each;
  return sum;
}

Shared Population::best() {
  Shared best;
  const auto from = [&](double exponent, double lapse) {
    double mean = 0, squares = 0;
    const auto n = static_cast<double>(observers_.size());
    for (const OneObserver* each : observers_) {
      const double log = std::clamp(each->best(exponent, lapse).log, grid_.front() + 1, grid_.back() - 1);
      mean += log / n, squares += log * log / n;
    }
    const double spread = std::clamp(std::sqrt(std::max(squares - mean * mean, 0.0)), 0.1, 1.0);
    std::vector<double> start = {mean, std::log(spread)}, steps = {0.1, 0.3};
    if (!options_.exponent) start.push_back(std::log(exponent)), steps.push_back(0.3);
    if (!options_.lapse) start.push_back(lapse_coordinate(lapse, options_.most_lapse)), steps.push_back(0.3);
    const auto read = [&](const VectorXd& at) {
      Eigen::Index i = 2;
      Place place{0, 0, std::clamp(at(0), grid_.front(), grid_.back()),
                  std::clamp(at(1), std::log(least_spread), std::log(most_spread))};
      place[0] = options_.exponent ? std::log(*options_.exponent)
                                  : std::clamp(at(i++), std::log(least_exponent), std::log(most_exponent));
      place[1] = options_.lapse ? *options_.lapse : lapse_at(at(i++), options_.most_lapse);
      return place;
    };
    const auto count = static_cast<Eigen::Index>(start.size());
    const Minimum found =
        minimise([&](const VectorXd& at) { return -sum(read(at)); }, Eigen::Map<VectorXd>(start.data(), count),
                 Eigen::Map<VectorXd>(steps.data(), count), 1e-6, 800);
    if (-found.value <= best.log_likelihood) return;
    place_ = read(found.at);
    best = {std::exp(place_[0]), place_[1], -found.value};
  };
  for (const double exponent : options_.exponent ? std::vector<double>{*options_.exponent} : std::vector<double>{1, 2.5})
    from(exponent, options_.lapse.value_or(0.2 * options_.most_lapse));
  return best;
}

std::vector<std::size_t> Population::inner() const {
  const auto is_inside = [](double value, double low, double high, double step) {
    return value > low + 1.5 * step && value < high - 1.5 * step;
  };
  std::vector<std::size_t> result;
  if (!options_.exponent && is_inside(place_[0], std::log(least_exponent), std::log(most_exponent), steps[0])) result.push_back(0);
  if (!options_.lapse && is_inside(place_[1], 0, options_.most_lapse, steps[1])) result.push_back(1);
  result.push_back(2);
  if (is_inside(place_[3], std::log(least_spread), std::log(most_spread), steps[3])) result.push_back(3);
  return result;
}

}  // namespace wale::analysis
