#include "calibration/analysis/detection.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "calibration/analysis/distributions.hpp"
#include "calibration/analysis/optimise.hpp"
#include "calibration/analysis/refusal.hpp"

namespace wale::analysis {
namespace {

double density(double z) { return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi); }

/// A share of answers; with `move`, by that part of an answer, and twice the part of a trial.
struct Share {
  double value = 0, variance = 0;
};
Share share_of(std::size_t count, std::size_t of, double move) {
  const double n = static_cast<double>(of) + 2 * move;
  const double value = (static_cast<double>(count) + move) / n;
  return {value, value * (1 - value) / n};
}

}  // namespace

double choice_of_d_prime(double d_prime, int intervals) {
  if (intervals == 2) return normal_below(d_prime / std::numbers::sqrt2);
  // Simpson's rule over the size of the signal; smooth, so that 400 steps give ten digits.
  constexpr int steps = 400;
  constexpr double from = -8, to = 8;
  double sum = 0;
  for (int i = 0; i <= steps; ++i) {
    const double z = from + (to - from) * i / steps;
    const double weight = i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * density(z) * std::pow(normal_below(z + d_prime), intervals - 1);
  }
  return sum * (to - from) / steps / 3;
}

double d_prime_of_choice(double p, int intervals) {
  if (intervals == 2) return std::numbers::sqrt2 * normal_quantile(p);
  return crossing([&](double d) { return choice_of_d_prime(d, intervals) - p; }, -8, 12, 1e-12);
}

double different_by_difference(double d_prime, double criterion) {
  return normal_below((-criterion + d_prime) / std::numbers::sqrt2) +
         normal_below((-criterion - d_prime) / std::numbers::sqrt2);
}

Result<Sensitivity> sensitivity_of(Decision decision, const Answered& answered, int intervals) {
  const bool choice = decision == Decision::interval_choice;
  if (answered.hits > answered.signals || (!choice && answered.false_alarms > answered.noises))
    return refusal(Code::malformed_value, "more answers are counted than were given", "");
  if (answered.signals == 0 || (!choice && answered.noises == 0))
    return refusal(Code::not_measured, "a kind of trial that the task needs was never presented", choice ? "" : "present both kinds");
  if (choice && intervals < 2) return refusal(Code::malformed_value, "a choice needs two intervals or more", "");
  const bool move = answered.hits == 0 || answered.hits == answered.signals ||
                    (!choice && (answered.false_alarms == 0 || answered.false_alarms == answered.noises));
  // The log-linear rule (Hautus 1995) adds half an answer where both kinds are equally many, and to each kind its share of
  // one where they are not (Goodman 1970): otherwise answers that are all "no" would be fewer to the rarer kind.
  const double share_of_signals = choice ? 0.5
                                         : static_cast<double>(answered.signals) /
                                               static_cast<double>(answered.signals + answered.noises);
  const Share hit = share_of(answered.hits, answered.signals, move ? share_of_signals : 0);
  const Share alarm =
      choice ? Share{} : share_of(answered.false_alarms, answered.noises, move ? 1 - share_of_signals : 0);
  Sensitivity result;
  if (move) result.corrected = "a rate of 0 or 1 was moved by half an answer";
  // The slopes of d' along both shares, by differences where there is no formula.
  const auto by_differences = [&](const auto& d_of) {
    const double step = 1e-5;
    const auto slope = [&](bool of_hit) {
      const double h = of_hit ? step : 0, f = of_hit ? 0 : step;
      return (d_of(hit.value + h, alarm.value + f) - d_of(hit.value - h, alarm.value - f)) / (2 * step);
    };
    result.d_prime = d_of(hit.value, alarm.value);
    result.error = std::sqrt(std::pow(slope(true), 2) * hit.variance + (choice ? 0 : std::pow(slope(false), 2) * alarm.variance));
  };
  switch (decision) {
    case Decision::interval_choice:
      by_differences([&](double h, double) { return d_prime_of_choice(std::clamp(h, 1e-9, 1 - 1e-9), intervals); });
      break;
    case Decision::yes_no: {
      const double zh = normal_quantile(hit.value), zf = normal_quantile(alarm.value);
      result.d_prime = zh - zf;
      result.criterion = -(zh + zf) / 2;
      result.error = std::sqrt(hit.variance / std::pow(density(zh), 2) + alarm.variance / std::pow(density(zf), 2));
      break;
    }
    case Decision::same_different_difference:
      by_differences([](double h, double f) {
        if (h <= f) return 0.0;
        const double criterion = -std::numbers::sqrt2 * normal_quantile(std::clamp(f, 1e-9, 1 - 1e-9) / 2);
        return crossing([&](double d) { return different_by_difference(d, criterion) - h; }, 0, 20, 1e-12);
      });
      break;
    case Decision::same_different_independent:
      by_differences([](double h, double f) {
        // The best share of right answers for these rates, whatever the bias (Macmillan and Creelman 2005, chapter 9).
        const double best = normal_below((normal_quantile(h) - normal_quantile(f)) / 2);
        return best <= 0.5 ? 0.0 : 2 * normal_quantile((1 + std::sqrt(2 * best - 1)) / 2);
      });
      break;
  }
  return result;
}

Result<WeberRange> pool_fractions(std::vector<WeberFraction> fractions) {
  if (fractions.empty()) return refusal(Code::not_measured, "there is no Weber fraction", "measure at one size at least");
  std::ranges::sort(fractions, {}, &WeberFraction::standard);
  std::vector<double> logs, weights;
  for (const WeberFraction& each : fractions) {
    if (!(each.fraction > 0) || !(each.interval.low > 0) || !std::isfinite(each.interval.high))
      return refusal(Code::not_measured, "the answers do not bound a Weber fraction", "collect more answers at that size");
    const double error = std::log(each.interval.high / each.interval.low) / (2 * 1.959963984540054);
    logs.push_back(std::log(each.fraction)), weights.push_back(1 / (error * error));
  }
  WeberRange result;
  std::size_t first = 0;
  for (;; ++first) {
    double sum = 0, weight = 0;
    for (std::size_t i = first; i < logs.size(); ++i) sum += weights[i] * logs[i], weight += weights[i];
    const double mean = sum / weight;
    result.chi_squared = 0;
    for (std::size_t i = first; i < logs.size(); ++i) result.chi_squared += weights[i] * (logs[i] - mean) * (logs[i] - mean);
    const double freedom = static_cast<double>(logs.size() - first) - 1;
    result.p = freedom > 0 ? chi_squared_above(result.chi_squared, freedom) : 1;
    result.fraction = std::exp(mean), result.error = 1 / std::sqrt(weight);
    if (result.p >= 0.05) break;
  }
  result.low = fractions[first].standard, result.high = fractions.back().standard;
  if (first > 0)
    result.note = "the fraction is not the same at the smallest " + std::to_string(first) +
                  (first == 1 ? " size, which is" : " sizes, which are") + " left out";
  return result;
}

}  // namespace wale::analysis
