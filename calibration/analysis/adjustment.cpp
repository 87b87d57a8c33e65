#include "calibration/analysis/adjustment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "calibration/analysis/distributions.hpp"
#include "calibration/analysis/refusal.hpp"

namespace wale::analysis {
namespace {

Interval interval_of_deviation(double deviation, double freedom) {
  return {deviation * std::sqrt(freedom / chi_squared_quantile(0.975, freedom)),
          deviation * std::sqrt(freedom / chi_squared_quantile(0.025, freedom))};
}

/// The standard deviation of what is anywhere within a step.
double error_of_step(double step) { return step / 2 / std::numbers::sqrt3; }

/// The mean of logarithms and Student's interval of it, in their unit; unbounded for one.
std::pair<double, Interval> geometric_mean(const std::vector<double>& logs, std::optional<double> step) {
  const auto n = static_cast<double>(logs.size());
  double mean = 0, squares = 0;
  for (const double each : logs) mean += each / n;
  for (const double each : logs) squares += (each - mean) * (each - mean);
  if (logs.size() < 2) return {std::exp(mean), {0, HUGE_VAL}};
  const double error = std::hypot(std::sqrt(squares / (n - 1) / n), step ? error_of_step(*step) : 0);
  const double reach = t_quantile(0.975, n - 1) * error;
  return {std::exp(mean), {std::exp(mean - reach), std::exp(mean + reach)}};
}

/// Whether all of some rising numbers are whole multiples of their smallest distance apart, and that distance.
std::optional<double> common_distance(const std::vector<double>& rising) {
  double least = HUGE_VAL;
  for (std::size_t i = 1; i < rising.size(); ++i) least = std::min(least, rising[i] - rising[i - 1]);
  for (const double each : rising) {
    const double steps = (each - rising.front()) / least;
    if (std::abs(steps - std::round(steps)) > 0.02) return std::nullopt;
  }
  return least;
}

/// The step that settings lie on, by ratio or by difference: where each is there twice or more on average, since numbers
/// that may be anything do not come again.
std::optional<double> step_of(const std::vector<double>& logs) {
  std::vector<double> places = logs;
  std::ranges::sort(places);
  const auto same = [](double a, double b) { return b - a < 1e-5; };  // as far as tables write them
  places.erase(std::unique(places.begin(), places.end(), same), places.end());
  if (places.size() < 2 || logs.size() < 2 * places.size()) return std::nullopt;
  if (const auto step = common_distance(places)) return step;
  std::vector<double> sizes;
  for (const double each : places) sizes.push_back(std::exp(each));
  const auto step = common_distance(sizes);
  if (!step) return std::nullopt;
  double mean = 0;
  for (const double each : logs) mean += std::exp(each) / static_cast<double>(logs.size());
  return *step / mean;
}

Interval widened(const Interval& scatter, std::optional<double> step) {
  if (!step) return scatter;
  const double error = error_of_step(*step);
  return {std::sqrt(std::max(scatter.low * scatter.low - error * error, 0.0)), std::hypot(scatter.high, error)};
}

}  // namespace

Result<Settings> analyse_settings(std::vector<ObserverSettings> observers) {
  Settings result;
  std::vector<double> means, all;
  double squares = 0;
  for (ObserverSettings& each : observers) {
    if (each.settings.empty()) continue;
    double mean = 0;
    for (const double setting : each.settings) {
      if (!(setting > 0) || !std::isfinite(setting))
        return refusal(Code::malformed_value, "a setting of zero or below has no logarithm", "leave it out by rule");
      mean += std::log(setting) / static_cast<double>(each.settings.size());
      all.push_back(std::log(setting));
    }
    for (const double setting : each.settings) squares += std::pow(std::log(setting) - mean, 2);
    result.freedom += static_cast<double>(each.settings.size()) - 1;
    each.equal = std::exp(mean);
    means.push_back(mean);
    result.observers.push_back(std::move(each));
  }
  if (means.empty()) return refusal("there are no settings", "");
  result.step = step_of(all);
  std::tie(result.equal, result.equal_interval) = geometric_mean(means.size() > 1 ? means : all, result.step);
  const auto [least, most] = std::ranges::minmax(all);
  if (most - least < 1e-5) result.equal_interval = {0, HUGE_VAL};
  if (result.freedom > 0) {
    result.scatter = std::sqrt(squares / result.freedom);
    result.scatter_interval = widened(interval_of_deviation(*result.scatter, result.freedom), result.step);
  }
  return result;
}

std::optional<std::pair<double, Interval>> pool_scatters(const std::vector<Settings>& all) {
  double squares = 0, freedom = 0;
  for (const Settings& each : all)
    if (each.scatter) squares += *each.scatter * *each.scatter * each.freedom, freedom += each.freedom;
  if (!(freedom > 0)) return std::nullopt;
  const double pooled = std::sqrt(squares / freedom);
  std::optional<double> step;
  for (const Settings& each : all)
    if (each.scatter && each.step) step = std::max(step.value_or(0), *each.step);
  return std::pair(pooled, widened(interval_of_deviation(pooled, freedom), step));
}

}  // namespace wale::analysis
