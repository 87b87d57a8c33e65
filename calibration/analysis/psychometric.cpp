#include "calibration/analysis/psychometric.hpp"

#include <algorithm>
#include <cmath>

#include "calibration/analysis/distributions.hpp"
#include "calibration/analysis/optimise.hpp"
#include "calibration/analysis/random.hpp"
#include "calibration/analysis/refusal.hpp"

namespace wale::analysis {
namespace {

using Eigen::VectorXd;

/// The distance from 0.05 to 0.95 of each shape at scale 1, and the place of 0.5.
const double normal_width = 2 * normal_quantile(0.95);
const double logistic_width = 2 * std::log(19.0);
const double weibull_width = std::log(std::log(0.05) / std::log(0.95)), weibull_middle = std::log(std::log(2.0));

double place_of(Sigmoid shape, double size) { return shape == Sigmoid::weibull ? std::log(size) : size; }
double size_of(Sigmoid shape, double place) { return shape == Sigmoid::weibull ? std::exp(place) : place; }

/// F at a distance from the threshold, in widths.
double core(Sigmoid shape, double distance) {
  switch (shape) {
    case Sigmoid::normal: return normal_below(distance * normal_width);
    case Sigmoid::logistic: return 1 / (1 + std::exp(-distance * logistic_width));
    case Sigmoid::weibull: return -std::expm1(-std::exp(distance * weibull_width + weibull_middle));
  }
  return 0;
}
double core_inverse(Sigmoid shape, double share) {
  switch (shape) {
    case Sigmoid::normal: return normal_quantile(share) / normal_width;
    case Sigmoid::logistic: return std::log(share / (1 - share)) / logistic_width;
    case Sigmoid::weibull: return (std::log(-std::log1p(-share)) - weibull_middle) / weibull_width;
  }
  return 0;
}

double log_likelihood_of(const std::vector<Level>& levels, const PsychometricFunction& function) {
  double sum = 0;
  for (const Level& each : levels) {
    // A share of 0 or 1 is impossible to contradict exactly; a trillionth is as good.
    const double p = std::clamp(function.at(each.size), 1e-12, 1 - 1e-12);
    if (each.right > 0) sum += static_cast<double>(each.right) * std::log(p);
    if (each.right < each.trials) sum += static_cast<double>(each.trials - each.right) * std::log1p(-p);
  }
  return sum;
}

double saturated(const std::vector<Level>& levels) {
  double sum = 0;
  for (const Level& each : levels) {
    const double n = static_cast<double>(each.trials), right = static_cast<double>(each.right);
    if (right > 0) sum += right * std::log(right / n);
    if (right < n) sum += (n - right) * std::log1p(-right / n);
  }
  return sum;
}

/// A rate within (0, most) by a number without bounds, and back.
double rate_of(double free, double most) { return most / (1 + std::exp(-free)); }

/// Finds the function with the greatest likelihood.
class PsychometricFitter {
 public:
  PsychometricFitter(const std::vector<Level>& levels, const PsychometricOptions& options)
      : levels_(levels), options_(options) {
    low_ = HUGE_VAL, high_ = -HUGE_VAL;
    for (const Level& each : levels) {
      const double place = place_of(options.shape, each.size);
      low_ = std::min(low_, place), high_ = std::max(high_, place);
    }
  }

  std::size_t parameters() const {
    return 2 + (options_.lapse ? 0u : 1u) + (options_.guess_is_free ? 1u : 0u);
  }

  /// The best function; a threshold's place or the width may be held.
  PsychometricFunction best(std::optional<double> held_place = {}, std::optional<double> held_width = {},
                            const PsychometricFunction* near = nullptr) const {
    const double range = high_ - low_;
    double most = -HUGE_VAL;
    PsychometricFunction result;
    const auto from = [&](double place, double width, double lapse) {
      std::vector<double> start;
      if (!held_place) start.push_back((place - low_) / range);
      if (!held_width) start.push_back(std::log(width / range));
      if (!options_.lapse) start.push_back(std::log(lapse / (options_.most_lapse - lapse)));
      if (options_.guess_is_free) start.push_back(-2);
      const VectorXd first = Eigen::Map<VectorXd>(start.data(), static_cast<Eigen::Index>(start.size()));
      const auto function = [&](const VectorXd& at) {
        Eigen::Index i = 0;
        PsychometricFunction found{.shape = options_.shape, .guess = options_.guess};
        found.threshold = size_of(options_.shape, held_place ? *held_place : low_ + range * at(i++));
        found.width = held_width ? *held_width : range * std::exp(std::clamp(at(i++), -9.0, 5.0));
        found.lapse = options_.lapse ? *options_.lapse : rate_of(at(i++), options_.most_lapse);
        if (options_.guess_is_free) found.guess = rate_of(at(i++), 0.5);
        return found;
      };
      const Minimum found = minimise([&](const VectorXd& at) { return -objective(function(at)); }, first,
                                     VectorXd::Constant(first.size(), 0.3), 1e-10, 3000);
      if (-found.value > most) most = -found.value, result = function(found.at);
    };
    if (near) {
      from(place_of(options_.shape, near->threshold), near->width, std::clamp(near->lapse, 1e-4 * options_.most_lapse, 0.999 * options_.most_lapse));
    } else {
      for (const double place : {0.3, 0.6})
        for (const double width : {0.2, 0.8}) from(low_ + place * range, width * range, 0.2 * options_.most_lapse);
    }
    return result;
  }

  double objective(const PsychometricFunction& function) const {
    const double prior = options_.prior ? 9 * std::log1p(-function.lapse) : 0;
    return log_likelihood_of(levels_, function) + prior;
  }

  PsychometricFit fit() const {
    PsychometricFit fit;
    fit.function = best();
    fit.log_likelihood = log_likelihood_of(levels_, fit.function);
    fit.deviance = 2 * (saturated(levels_) - fit.log_likelihood);
    fit.levels = levels_.size(), fit.parameters = parameters();
    for (const Level& each : levels_) fit.trials += each.trials;
    return fit;
  }

  void add_intervals(PsychometricFit& fit) const {
    const double allowed = objective(fit.function) - chi_squared_quantile(0.95, 1) / 2;
    const double place = place_of(options_.shape, fit.function.threshold), range = high_ - low_;
    const auto interval = [&](double middle, double step, double least, double most, const auto& excess) {
      const auto end = [&](double direction) {
        double near = middle, width = step;
        for (int i = 0; i < 40; ++i) {
          const double far = std::clamp(near + direction * width, least, most);
          if (excess(far) > 0) return crossing(excess, near, far, 1e-7);
          if (far == least) return -HUGE_VAL;
          if (far == most) return HUGE_VAL;
          near = far, width *= 1.5;
        }
        return direction * HUGE_VAL;
      };
      return Interval{end(-1), end(1)};
    };
    PsychometricFunction warm = fit.function;
    // From the neighbour's best function a search may end in a side valley, where an interval would end too early.
    const auto loss = [&](std::optional<double> held_place, std::optional<double> held_width) {
      warm = best(held_place, held_width, &warm);
      if (allowed - objective(warm) > 0)
        if (const PsychometricFunction anew = best(held_place, held_width); objective(anew) > objective(warm)) warm = anew;
      return allowed - objective(warm);
    };
    fit.threshold = interval(place, 0.05 * range, low_ - 3 * range, high_ + 3 * range, [&](double at) { return loss(at, {}); });
    fit.threshold = {size_of(options_.shape, fit.threshold.low), size_of(options_.shape, fit.threshold.high)};
    warm = fit.function;
    const Interval logs = interval(std::log(fit.function.width), 0.2, std::log(range) - 8, std::log(range) + 4, [&](double at) { return loss({}, std::exp(at)); });
    fit.width = {std::exp(logs.low), std::exp(logs.high)};
  }

  Result<> require_answers() const {
    std::size_t right = 0, trials = 0;
    for (const Level& each : levels_) {
      if (each.right > each.trials)
        return refusal(Code::malformed_value, std::to_string(each.right) + " of " + std::to_string(each.trials) + " answers are right", "");
      if (options_.shape == Sigmoid::weibull && !(each.size > 0))
        return refusal(Code::malformed_value, "a size of zero or below has no logarithm", "use another shape, or leave it out");
      if (!std::isfinite(each.size)) return refusal(Code::malformed_value, "a size is no number", "");
      right += each.right, trials += each.trials;
    }
    const auto rate = [](double value) { return value >= 0 && value < 1; };
    if (!rate(options_.guess) || !rate(options_.lapse.value_or(0)) || !(options_.most_lapse > 0) ||
        options_.most_lapse > 0.5 || options_.guess + options_.lapse.value_or(0) >= 1)
      return refusal(Code::malformed_value, "guesses and lapses are shares that leave something to the threshold", "use a guess rate of 1 / alternatives");
    if (trials == 0) return refusal(Code::not_measured, "there are no answers", "");
    if (levels_.size() < 2 || !(high_ > low_))
      return refusal(Code::not_measured, "all answers are about one size, which gives no function", "present several sizes");
    if (right == trials)
      return refusal(Code::not_measured, "all " + std::to_string(trials) + " answers are right: the threshold lies below the sizes", "present smaller ones");
    if (right == 0 && options_.guess > 0)
      return refusal(Code::not_measured, "none of " + std::to_string(trials) + " answers is right: look whether right and wrong are exchanged", "");
    if (right == 0) return refusal(Code::not_measured, "no answer is positive: the threshold lies above the sizes", "present larger ones");
    return {};
  }

 private:
  const std::vector<Level>& levels_;
  const PsychometricOptions& options_;
  double low_ = 0, high_ = 0;
};

/// Whether a function explains the answers better than one rate for all sizes.
bool depends_on_size(const std::vector<Level>& levels, const PsychometricFit& fit) {
  Level all;
  for (const Level& each : levels) all.right += each.right, all.trials += each.trials;
  const double p = static_cast<double>(all.right) / static_cast<double>(all.trials);
  double flat = 0;
  for (const Level& each : levels) {
    if (each.right > 0) flat += static_cast<double>(each.right) * std::log(p);
    if (each.right < each.trials) flat += static_cast<double>(each.trials - each.right) * std::log1p(-p);
  }
  return 2 * (fit.log_likelihood - flat) > chi_squared_quantile(0.95, 1);
}

void add_notes(const std::vector<Level>& levels, const PsychometricOptions& options, PsychometricFit& fit) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const Level& each : levels) low = std::min(low, each.size), high = std::max(high, each.size);
  if (fit.function.threshold < low || fit.function.threshold > high)
    fit.notes.push_back("the threshold lies outside of the sizes that were presented");
  if (!std::isfinite(fit.threshold.low) || !std::isfinite(fit.threshold.high))
    fit.notes.push_back("the answers do not bound the threshold on both sides");
  if (!options.lapse && fit.function.lapse > 0.98 * options.most_lapse)
    fit.notes.push_back("the lapse rate is at its upper limit: people may not have done the task");
}

/// The answers of each size together, the sizes rising; sizes without answers are left out.
std::vector<Level> collapsed(const std::vector<Level>& levels) {
  std::vector<Level> together;
  for (const Level& each : levels) {
    if (each.trials == 0) continue;
    const auto same = std::ranges::find(together, each.size, &Level::size);
    if (same == together.end()) together.push_back(each);
    else same->right += each.right, same->trials += each.trials;
  }
  std::ranges::sort(together, {}, &Level::size);
  return together;
}

}  // namespace

double PsychometricFunction::at(double size) const {
  const double distance = (place_of(shape, size) - place_of(shape, threshold)) / width;
  return guess + (1 - guess - lapse) * core(shape, distance);
}

double PsychometricFunction::size_at(double p) const {
  const double share = (p - guess) / (1 - guess - lapse);
  if (share <= 0) return shape == Sigmoid::weibull ? 0 : -HUGE_VAL;
  if (share >= 1) return HUGE_VAL;
  return size_of(shape, place_of(shape, threshold) + width * core_inverse(shape, share));
}

Result<PsychometricFit> fit_psychometric(const std::vector<Level>& levels, const PsychometricOptions& options) {
  const std::vector<Level> together = collapsed(levels);
  const PsychometricFitter fitter(together, options);
  if (const auto sound = fitter.require_answers(); !sound) return sound.error();
  PsychometricFit fit = fitter.fit();
  if (!depends_on_size(together, fit))
    return refusal(Code::not_measured, "the answers do not depend on the size beyond chance", "present a wider range, or look whether right and wrong are exchanged");
  if (options.intervals) fitter.add_intervals(fit);
  add_notes(together, options, fit);
  return fit;
}

Result<std::vector<PsychometricFit>> fit_with_shared_lapse(const std::vector<std::vector<Level>>& conditions,
                                                           PsychometricOptions options) {
  std::vector<std::vector<Level>> together(conditions.size());
  for (std::size_t i = 0; i < conditions.size(); ++i) together[i] = collapsed(conditions[i]);
  const auto sum_at = [&](double lapse) {
    PsychometricOptions held = options;
    held.lapse = lapse;
    double sum = 0;
    for (const auto& each : together) sum -= PsychometricFitter(each, held).fit().log_likelihood;
    return sum;
  };
  for (const auto& each : together)
    if (const auto sound = PsychometricFitter(each, options).require_answers(); !sound) return sound.error();
  if (!options.lapse) {
    double lapse = lowest_within(sum_at, 0, options.most_lapse, 1e-4);
    if (sum_at(0) <= sum_at(lapse)) lapse = 0;
    options.lapse = lapse;
  }
  std::vector<PsychometricFit> fits;
  for (const auto& each : together) {
    auto fit = fit_psychometric(each, options);
    if (!fit) return fit.error();
    fits.push_back(std::move(*fit));
  }
  return fits;
}

Bootstrap bootstrap(const std::vector<Level>& levels, const PsychometricFit& fit, const PsychometricOptions& options,
                    double p, std::size_t samples, std::uint64_t seed) {
  Random random(seed);
  const std::vector<Level> together = collapsed(levels);
  std::vector<double> sizes;
  std::size_t above = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    std::vector<Level> drawn = together;
    for (Level& each : drawn)
      each.right = static_cast<std::size_t>(random.binomial(each.trials, std::clamp(fit.function.at(each.size), 0.0, 1.0)));
    const PsychometricFitter fitter(drawn, options);
    if (!fitter.require_answers()) continue;
    PsychometricFit again;
    again.function = fitter.best({}, {}, &fit.function);
    const double deviance = 2 * (saturated(drawn) - log_likelihood_of(drawn, again.function));
    above += deviance >= fit.deviance ? 1 : 0;
    sizes.push_back(again.function.size_at(p));
  }
  Bootstrap result;
  result.samples = sizes.size();
  if (sizes.empty()) return {{-HUGE_VAL, HUGE_VAL}, 1, 0};
  std::ranges::sort(sizes);
  const auto quantile = [&](double share) {
    const double at = share * static_cast<double>(sizes.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t next = std::min(below + 1, sizes.size() - 1);
    if (!std::isfinite(sizes[below]) || !std::isfinite(sizes[next])) return sizes[below];
    return sizes[below] + (at - static_cast<double>(below)) * (sizes[next] - sizes[below]);
  };
  result.size = {quantile(0.025), quantile(0.975)};
  result.p_of_deviance = static_cast<double>(above) / static_cast<double>(sizes.size());
  return result;
}

}  // namespace wale::analysis
