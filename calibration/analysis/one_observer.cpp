#include "calibration/analysis/one_observer.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "calibration/analysis/optimise.hpp"

namespace wale::analysis {
namespace {

constexpr double most_criterion = 6;

double below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double density_at(double z) { return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi); }

/// The slopes of `chance_of` along d' and the criterion.
std::array<double, 2> slopes_of(Decision decision, double d_prime, double criterion) {
  switch (decision) {
    case Decision::interval_choice: return {density_at(d_prime / std::numbers::sqrt2) / std::numbers::sqrt2, 0};
    case Decision::yes_no: return {density_at(d_prime - criterion), -density_at(d_prime - criterion)};
    default: {
      const double above = density_at((d_prime - criterion) / std::numbers::sqrt2) / std::numbers::sqrt2,
                   under = density_at((-d_prime - criterion) / std::numbers::sqrt2) / std::numbers::sqrt2;
      return {above - under, -above - under};
    }
  }
}

double term(std::size_t yes, std::size_t trials, double share) {
  const double p = std::clamp(share, 1e-12, 1 - 1e-12);
  return static_cast<double>(yes) * std::log(p) + static_cast<double>(trials - yes) * std::log1p(-p);
}

/// The lowest place of a function: the best of a few, then its valley.
template <class Loss>
double valley(const Loss& loss, double from, double to) {
  constexpr int places = 16;
  int lowest = 0;
  double least = HUGE_VAL;
  for (int i = 0; i <= places; ++i)
    if (const double value = loss(from + (to - from) * i / places); value < least) least = value, lowest = i;
  const auto place = [&](int i) { return from + (to - from) * std::clamp(i, 0, places) / places; };
  return lowest_within(loss, place(lowest - 1), place(lowest + 1), 1e-6);
}

}  // namespace

double chance_of(Decision decision, double d_prime, double criterion) {
  switch (decision) {
    case Decision::interval_choice: return below(d_prime / std::numbers::sqrt2);
    case Decision::yes_no: return below(d_prime - criterion);
    default:
      return below((d_prime - criterion) / std::numbers::sqrt2) + below((-d_prime - criterion) / std::numbers::sqrt2);
  }
}

OneObserver::OneObserver(const ObserverAnswers& answers, Decision decision) : answers_(answers), decision_(decision) {
  std::ranges::sort(answers_.levels, {}, &Level::size);
  std::vector<Level> together;
  for (const Level& each : answers_.levels) {
    if (each.trials == 0) continue;
    if (!together.empty() && together.back().size == each.size)
      together.back().right += each.right, together.back().trials += each.trials;
    else
      together.push_back(each);
  }
  answers_.levels = std::move(together);
  for (const Level& each : answers_.levels) logs_.push_back(std::log(each.size));
  low_ = logs_.empty() ? 0 : logs_.front(), high_ = logs_.empty() ? 0 : logs_.back();
}

double OneObserver::log_likelihood(double log_threshold, double exponent, double lapse, double criterion) const {
  double sum = 0;
  for (std::size_t i = 0; i < logs_.size(); ++i) {
    const double d = std::exp(std::clamp(exponent * (logs_[i] - log_threshold), -50.0, 5.0));
    sum += term(answers_.levels[i].right, answers_.levels[i].trials,
                lapse + (1 - 2 * lapse) * chance_of(decision_, d, criterion));
  }
  return sum + noise_term(lapse, criterion);
}

double OneObserver::at(double log_threshold, double exponent, double lapse, double* best_criterion) const {
  if (!has_criterion(decision_)) return log_likelihood(log_threshold, exponent, lapse, 0);
  const auto loss = [&](double criterion) { return -log_likelihood(log_threshold, exponent, lapse, criterion); };
  const double from = decision_ == Decision::yes_no ? -most_criterion : 0;
  const double found = valley(loss, from, most_criterion);
  if (best_criterion != nullptr) *best_criterion = found;
  return -loss(found);
}

Own OneObserver::best(double exponent, double lapse, const Own* near) const {
  if (near != nullptr && std::isfinite(near->log_likelihood))
    if (const auto found = scored(*near, exponent, lapse)) return *found;
  const auto loss = [&](double log) { return -at(log, exponent, lapse); };
  Own found{.log = valley(loss, low_ - beyond_sizes, high_ + beyond_sizes)};
  found.log_likelihood = at(found.log, exponent, lapse, &found.criterion);
  if (const auto better = scored(found, exponent, lapse); better && better->log_likelihood > found.log_likelihood)
    return *better;
  return found;
}

void OneObserver::along(const std::vector<double>& grid, double exponent, double lapse, std::vector<double>& result) const {
  result.resize(grid.size());
  Own near;
  for (std::size_t g = grid.size(); g-- > 0;) {  // from where least is felt, so that the criterion is that of catches
    if (!has_criterion(decision_)) {
      result[g] = log_likelihood(grid[g], exponent, lapse, 0);
      continue;
    }
    near.log = grid[g];
    if (!std::isfinite(near.log_likelihood)) near.log_likelihood = at(grid[g], exponent, lapse, &near.criterion);
    if (const auto found = scored(near, exponent, lapse, true)) near = *found;
    else near.log_likelihood = at(grid[g], exponent, lapse, &near.criterion);
    result[g] = near.log_likelihood;
  }
}

double OneObserver::nothing_felt(double lapse) const {
  std::size_t yes = answers_.false_alarms, trials = answers_.noises;
  for (const Level& each : answers_.levels) yes += each.right, trials += each.trials;
  if (!has_criterion(decision_)) return -static_cast<double>(trials) * std::numbers::ln2;
  const double share = static_cast<double>(yes) / static_cast<double>(trials);
  return term(yes, trials, std::clamp(share, lapse, 1 - lapse));
}

std::optional<Own> OneObserver::scored(const Own& from, double exponent, double lapse, bool criterion_only) const {
  Own now = from;
  now.log_likelihood = log_likelihood(now.log, exponent, lapse, now.criterion);
  const bool two = has_criterion(decision_);
  for (int round = 0; round < 40; ++round) {
    double g[2] = {}, c[3] = {};
    const auto add = [&](double d, double along_log, std::size_t yes, std::size_t trials) {
      const double p = std::clamp(lapse + (1 - 2 * lapse) * chance_of(decision_, d, now.criterion), 1e-12, 1 - 1e-12);
      const auto [of_d, of_criterion] = slopes_of(decision_, d, now.criterion);
      const double x = (1 - 2 * lapse) * of_d * along_log, y = (1 - 2 * lapse) * of_criterion;
      const auto n = static_cast<double>(trials);
      const double pull = (static_cast<double>(yes) - n * p) / (p * (1 - p)), weight = n / (p * (1 - p));
      g[0] += pull * x, g[1] += pull * y;
      c[0] += weight * x * x, c[1] += weight * x * y, c[2] += weight * y * y;
    };
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      const double d = std::exp(std::clamp(exponent * (logs_[i] - now.log), -50.0, 5.0));
      add(d, -exponent * d, answers_.levels[i].right, answers_.levels[i].trials);
    }
    if (two && answers_.noises > 0) add(0, 0, answers_.false_alarms, answers_.noises);
    double step[2] = {};
    if (criterion_only) {
      if (!(c[2] > 0)) return std::nullopt;
      step[1] = g[1] / c[2];
    } else if (two) {
      const double determinant = c[0] * c[2] - c[1] * c[1];
      if (!(determinant > 1e-12 * c[0] * c[2])) return std::nullopt;
      step[0] = (c[2] * g[0] - c[1] * g[1]) / determinant, step[1] = (c[0] * g[1] - c[1] * g[0]) / determinant;
    } else {
      if (!(c[0] > 0)) return std::nullopt;
      step[0] = g[0] / c[0];
    }
    const double most = std::max(std::abs(step[0]), std::abs(step[1])), share = most > 0.7 ? 0.7 / most : 1;
    Own next = now;
    bool gains = false;
    for (double by = share; by > share / 100; by /= 2) {
      next.log = now.log + by * step[0], next.criterion = now.criterion + by * step[1];
      next.log_likelihood = log_likelihood(next.log, exponent, lapse, next.criterion);
      if (next.log_likelihood >= now.log_likelihood) {
        gains = true;
        break;
      }
    }
    if (!gains) return most < 1e-4 ? std::optional(now) : std::nullopt;
    now = next;
    if (now.log < low_ - beyond_sizes || now.log > high_ + beyond_sizes || std::abs(now.criterion) > most_criterion)
      return std::nullopt;
    if (most < 1e-6) return now;
  }
  return std::nullopt;
}

double OneObserver::noise_term(double lapse, double criterion) const {
  if (answers_.noises == 0) return 0;
  return term(answers_.false_alarms, answers_.noises,
              lapse + (1 - 2 * lapse) * chance_of(decision_, 0, criterion));
}

}  // namespace wale::analysis
