#include "calibration/analysis/adjustment.hpp"

#include <cmath>
#include <tuple>

#include "calibration/analysis/distributions.hpp"
#include "calibration/analysis/refusal.hpp"

namespace wale::analysis {
namespace {

Interval interval_of_deviation(double deviation, double freedom) {
  return {deviation * std::sqrt(freedom / chi_squared_quantile(0.975, freedom)),
          deviation * std::sqrt(freedom / chi_squared_quantile(0.025, freedom))};
}

/// The mean of logarithms and Student's interval of it, in their unit; unbounded for one.
std::pair<double, Interval> geometric_mean(const std::vector<double>& logs) {
  const auto n = static_cast<double>(logs.size());
  double mean = 0, squares = 0;
  for (const double each : logs) mean += each / n;
  for (const double each : logs) squares += (each - mean) * (each - mean);
  if (logs.size() < 2) return {std::exp(mean), {0, HUGE_VAL}};
  const double reach = t_quantile(0.975, n - 1) * std::sqrt(squares / (n - 1) / n);
  return {std::exp(mean), {std::exp(mean - reach), std::exp(mean + reach)}};
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
  std::tie(result.equal, result.equal_interval) = geometric_mean(means.size() > 1 ? means : all);
  if (result.freedom > 0) {
    result.scatter = std::sqrt(squares / result.freedom);
    result.scatter_interval = interval_of_deviation(*result.scatter, result.freedom);
  }
  return result;
}

std::optional<std::pair<double, Interval>> pool_scatters(const std::vector<Settings>& all) {
  double squares = 0, freedom = 0;
  for (const Settings& each : all)
    if (each.scatter) squares += *each.scatter * *each.scatter * each.freedom, freedom += each.freedom;
  if (!(freedom > 0)) return std::nullopt;
  const double pooled = std::sqrt(squares / freedom);
  return std::pair(pooled, interval_of_deviation(pooled, freedom));
}

}  // namespace wale::analysis
