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
    most_.clear();
    for (auto& along : along_) {
      most_.push_back(*std::ranges::max_element(along));
      for (double& each : along) each = std::exp(each - most_.back());
    }
  }
  const double spread = std::exp(at[3]);
  std::vector<double> weights;
  double all = 0;
  for (const double each : grid_) weights.push_back(std::exp(-std::pow((each - at[2]) / spread, 2) / 2)), all += weights.back();
  std::vector<double> result;
  for (std::size_t i = 0; i < along_.size(); ++i) {
    double sum = 0;
    for (std::size_t g = 0; g < grid_.size(); ++g) sum += weights[g] * along_[i][g];
    result.push_back(most_[i] + std::log(sum / all));
  }
  return result;
}

double Population::sum(const Place& at) {
  double sum = 0;
  for (const double each : log_likelihoods(at)) sum += each;
  return sum;
}

std::pair<Population::Place, double> Population::climbed(const Place& from, std::optional<double> fixed, double tolerance) {
  std::vector<double> start = {from[3]}, steps = {0.3};
  if (!fixed) start.push_back(from[2]), steps.push_back(0.1);
  if (!options_.exponent) start.push_back(from[0]), steps.push_back(fixed ? 0.1 : 0.3);
  // At a rate of 0 the slope along the coordinate is zero.
  if (!options_.lapse)
    start.push_back(lapse_coordinate(std::max(from[1], 0.01 * options_.most_lapse), options_.most_lapse)), steps.push_back(0.3);
  const auto read = [&](const VectorXd& at) {
    Eigen::Index i = 0;
    Place place{};
    place[3] = std::clamp(at(i++), std::log(least_spread), std::log(most_spread));
    place[2] = fixed ? *fixed : std::clamp(at(i++), grid_.front(), grid_.back());
    place[0] = options_.exponent ? std::log(*options_.exponent)
                                : std::clamp(at(i++), std::log(least_exponent), std::log(most_exponent));
    place[1] = options_.lapse ? *options_.lapse : lapse_at(at(i++), options_.most_lapse);
    return place;
  };
  const auto count = static_cast<Eigen::Index>(start.size());
  const Minimum found =
      minimise([&](const VectorXd& at) { return -sum(read(at)); }, Eigen::Map<VectorXd>(start.data(), count),
               Eigen::Map<VectorXd>(steps.data(), count), tolerance, 800);
  return {read(found.at), -found.value};
}

std::vector<double> Population::log_likelihoods_with(const Shared& shared) {
  const auto read = [&](const VectorXd& at) {
    return Place{std::log(shared.exponent), shared.lapse, std::clamp(at(0), grid_.front(), grid_.back()),
                 std::clamp(at(1), std::log(least_spread), std::log(most_spread))};
  };
  VectorXd start(2), steps(2);
  start << place_[2], place_[3];
  steps << 0.1, 0.3;
  return log_likelihoods(read(minimise([&](const VectorXd& at) { return -sum(read(at)); }, start, steps, 1e-3, 200).at));
}

Shared Population::best() {
  for (const double exponent : options_.exponent ? std::vector<double>{*options_.exponent} : std::vector<double>{1, 2.5}) {
    const double lapse = options_.lapse.value_or(0.2 * options_.most_lapse);
    double mean = 0, squares = 0;
    const auto n = static_cast<double>(observers_.size());
    for (const OneObserver* each : observers_) {
      const double log = std::clamp(each->best(exponent, lapse).log, grid_.front() + 1, grid_.back() - 1);
      mean += log / n, squares += log * log / n;
    }
    const double spread = std::clamp(std::sqrt(std::max(squares - mean * mean, 0.0)), 0.1, 1.0);
    const auto [place, likelihood] = climbed({std::log(exponent), lapse, mean, std::log(spread)}, std::nullopt, 1e-6);
    if (likelihood > best_) place_ = place, best_ = likelihood;
  }
  return {std::exp(place_[0]), place_[1], best_};
}

double Population::end_of_mean(double loss, double direction) {
  // The root of what is lost is nearly in proportion to the distance, so that straight lines find the end in few steps.
  const double wanted = std::sqrt(loss), last = direction > 0 ? grid_.back() : grid_.front();
  double near = place_[2], near_root = 0, far = 0, far_root = -1;
  double step = 2 * std::max(std::exp(place_[3]), 0.1) / std::sqrt(static_cast<double>(observers_.size()));
  Place warm = place_;
  const auto root_at = [&](double mean) {
    const auto [place, likelihood] = climbed(warm, mean, 1e-3);
    warm = place;
    return std::sqrt(std::max(best_ - likelihood, 0.0));
  };
  for (int round = 0; round < 40 && far_root < 0; ++round) {
    const double at = direction > 0 ? std::min(near + step, last) : std::max(near - step, last);
    const double root = root_at(at);
    if (root >= wanted) {
      far = at, far_root = root;
    } else {
      if (at == last) return direction * HUGE_VAL;
      const double rise = root - near_root;
      step = std::clamp(rise > 0 ? 1.1 * (wanted - root) * std::abs(at - near) / rise : step, step / 2, 3 * step);
      near = at, near_root = root;
    }
  }
  for (int round = 0; round < 20 && far_root >= 0; ++round) {
    if (far_root - wanted < 3e-3 * wanted || std::abs(far - near) < 1e-4) return far;
    const double at = near + (far - near) * std::clamp((wanted - near_root) / (far_root - near_root), 0.1, 0.98);
    const double root = root_at(at);
    if (std::abs(root - wanted) < 3e-3 * wanted) return at;
    (root < wanted ? near : far) = at;
    (root < wanted ? near_root : far_root) = root;
  }
  return far_root < 0 ? direction * HUGE_VAL : far;
}

Interval Population::ends_of_mean(double loss) { return {end_of_mean(loss, -1), end_of_mean(loss, 1)}; }

}  // namespace wale::analysis
