#include "calibration/analysis/sensitivity_law.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>

#include "calibration/analysis/distributions.hpp"
#include "calibration/analysis/optimise.hpp"
#include "calibration/analysis/population.hpp"
#include "calibration/analysis/refusal.hpp"

namespace wale::analysis {
namespace {

using Eigen::VectorXd;

/// Of chi-squared with one degree of freedom, over 2: how much less likely the ends of an interval are.
const double allowed_loss = chi_squared_quantile(0.95, 1) / 2;

class SensitivityFitter {
 public:
  SensitivityFitter(const std::vector<ObserverAnswers>& observers, const SensitivityOptions& options)
      : options_(options) {
    for (const ObserverAnswers& each : observers) observers_.emplace_back(each, options.decision);
    const auto few = [](const OneObserver& each) { return each.answers().levels.size() < 2; };
    if (!options.exponent && std::ranges::all_of(observers_, few)) options_.exponent = 1, held_ = true;
  }

  const SensitivityOptions& options() const { return options_; }
  bool exponent_is_held() const { return held_; }
  const std::vector<OneObserver>& observers() const { return observers_; }

  /// The best exponent and lapse rate for the observers whose entry in `chosen` is set.
  Shared shared(const std::vector<bool>& chosen, std::optional<Population>* keep = nullptr) const;

  Shared shared_by_one(std::size_t first) const {
    if (options_.exponent && options_.lapse) return {*options_.exponent, *options_.lapse, 0};
    Own own;
    return over_shared([&](double exponent, double lapse) {
      own = observers_[first].best(exponent, lapse, &own);
      return own.log_likelihood;
    });
  }

  /// The greatest of a likelihood over exponent and lapse rate.
  template <class Sum>
  Shared over_shared(const Sum& sum, const Shared* near = nullptr) const {
    Shared best;
    const auto from = [&](double exponent, double lapse, double step) {
      std::vector<double> start;
      if (!options_.exponent) start.push_back(std::log(exponent));
      if (!options_.lapse) start.push_back(lapse_coordinate(lapse, options_.most_lapse));
      const auto read = [&](const VectorXd& at) {
        Eigen::Index i = 0;
        Shared found;
        found.exponent = options_.exponent
                             ? *options_.exponent
                             : std::clamp(std::exp(at(i++)), least_exponent, most_exponent);
        found.lapse = options_.lapse ? *options_.lapse : lapse_at(at(i++), options_.most_lapse);
        return found;
      };
      const VectorXd first = Eigen::Map<VectorXd>(start.data(), static_cast<Eigen::Index>(start.size()));
      const Minimum found = minimise(
          [&](const VectorXd& at) {
            const Shared each = read(at);
            return -sum(each.exponent, each.lapse);
          },
          first, VectorXd::Constant(first.size(), step), 1e-6, 400);
      Shared each = read(found.at);
      each.log_likelihood = -found.value;
      if (each.log_likelihood > best.log_likelihood) best = each;
    };
    if (near != nullptr) {
      from(near->exponent, std::clamp(near->lapse, 0.02 * options_.most_lapse, options_.most_lapse), 0.15);
    } else {
      for (const double exponent : options_.exponent ? std::vector<double>{1} : std::vector<double>{1, 2.5})
        from(exponent, 0.2 * options_.most_lapse, 0.3);
    }
    return best;
  }

  ObserverSensitivity own(std::size_t i, const Shared& shared) const {
    const OneObserver& observer = observers_[i];
    ObserverSensitivity result;
    const Own found = observer.best(shared.exponent, shared.lapse);
    result.law = {.decision = options_.decision,
                  .threshold = std::exp(found.log),
                  .exponent = shared.exponent,
                  .lapse = shared.lapse,
                  .criterion = found.criterion};
    result.log_likelihood = found.log_likelihood;
    result.refused = why_not(observer, result, shared);
    return result;
  }

  /// The ends at which the profile of an observer's threshold is as much lower as allowed; infinite beyond the range.
  template <class Profile>
  static Interval ends(const OneObserver& observer, double log, double greatest, const Profile& profile) {
    const auto excess = [&](double at) { return greatest - allowed_loss - profile(at); };
    const auto end = [&](double direction, double last) {
      double near = log, step = 0.05;
      while (std::abs(last - near) > 1e-9) {
        const double far = direction > 0 ? std::min(near + step, last) : std::max(near - step, last);
        if (excess(far) > 0) return crossing(excess, near, far, 1e-6);
        near = far, step *= 1.4;
      }
      return direction * HUGE_VAL;
    };
    return {std::exp(end(-1, observer.low() - beyond_sizes)), std::exp(end(1, observer.high() + beyond_sizes))};
  }

  /// Exponents and lapse rates, with how likely each observer's answers are there if their thresholds come from one
  /// population.
  struct Common {
    Shared shared;
    std::vector<double> each;
  };

  /// Those that are not much less likely than the best.
  std::vector<Common> commons(Population& population, const Shared& best) const {
    constexpr double unlikely = 6;
    constexpr int lapses = 5;
    std::vector<Common> all;
    const auto add = [&](double log_exponent, double lapse) {
      Common common{{std::exp(log_exponent), lapse}, {}};
      common.each = population.log_likelihoods_with(common.shared);
      common.shared.log_likelihood = 0;
      for (const double each : common.each) common.shared.log_likelihood += each;
      all.push_back(std::move(common));
      return best.log_likelihood - all.back().shared.log_likelihood;
    };
    const double low = std::log(least_exponent), high = std::log(most_exponent);
    double from = std::clamp(std::log(best.exponent), low, high), step = 0.05;
    add(from, best.lapse);
    // A quarter of the way to where exponents are unlikely.
    if (!options_.exponent)
      while (step < 0.3 && add(std::min(from + 4 * step, high), best.lapse) < 2 && add(std::max(from - 4 * step, low), best.lapse) < 2)
        step *= 1.5;
    for (int k = 0; k <= (options_.lapse ? 0 : lapses); ++k) {
      const double lapse = options_.lapse ? *options_.lapse : options_.most_lapse * k / lapses;
      double least = add(from, lapse), place = from;
      if (options_.exponent) continue;
      for (const double direction : {-1.0, 1.0}) {
        double last = least;
        for (double at = from + direction * step; at >= low && at <= high; at += direction * step) {
          const double lost = add(at, lapse);
          if (lost < least) least = lost, place = at;
          if (lost > unlikely && lost > last) break;
          last = lost;
        }
      }
      from = place;
    }
    return all;
  }

  /// The interval of one observer's threshold, with the exponent and the lapse rate that suit each threshold best: for
  /// this observer's answers, and for those of the others, whose thresholds are those of their population.
  Interval interval_of(std::size_t i, std::size_t in_population, const std::vector<Common>& commons,
                       const ObserverSensitivity& own) const {
    struct Slice {
      double others, most;
      const Shared* shared;
    };
    const OneObserver& observer = observers_[i];
    std::vector<Slice> slices;
    double greatest = -HUGE_VAL, log = 0;
    for (const Common& each : commons) {
      const double others = each.shared.log_likelihood - each.each[in_population];
      const Own found = observer.best(each.shared.exponent, each.shared.lapse);
      slices.push_back({others, others + found.log_likelihood, &each.shared});
      if (slices.back().most > greatest) greatest = slices.back().most, log = found.log;
    }
    std::erase_if(slices, [&](const Slice& each) { return each.most < greatest - allowed_loss; });  // they end nothing
    const Interval found = ends(observer, log, greatest, [&](double at) {
      double most = -HUGE_VAL;
      for (const Slice& each : slices)
        most = std::max(most, each.others + observer.at(at, each.shared->exponent, each.shared->lapse));
      return most;
    });
    return {std::min(found.low, own.law.threshold), std::max(found.high, own.law.threshold)};
  }

  /// The interval of one observer's threshold, whatever the exponent and the lapse rate.
  Interval interval_of_all(std::size_t i, const ObserverSensitivity& own) const {
    Shared up{own.law.exponent, own.law.lapse}, *warm = &up;
    return ends(observers_[i], std::log(own.law.threshold), own.log_likelihood, [&](double log) {
      const auto sum = [&](double exponent, double lapse) { return observers_[i].at(log, exponent, lapse); };
      const Shared far = over_shared(sum), near = over_shared(sum, warm);
      *warm = far.log_likelihood > near.log_likelihood ? far : near;
      return warm->log_likelihood;
    });
  }

 private:
  std::optional<Error> why_not(const OneObserver& observer, const ObserverSensitivity& found, const Shared& shared) const {
    const ObserverAnswers& answers = observer.answers();
    std::size_t right = 0, trials = 0;
    for (const Level& each : answers.levels) right += each.right, trials += each.trials;
    const bool choice = !has_criterion(options_.decision);
    if (trials == 0) return refusal("there are no answers", "");
    if (!choice && answers.noises == 0)
      return refusal("no trial without anything to find tells how often this observer says that there is something",
                     "present such trials too");
    if (choice && right == trials)
      return refusal("all " + std::to_string(trials) + " answers are right: the threshold lies below the sizes",
                     "present smaller ones");
    if (choice && right == 0)
      return refusal("none of " + std::to_string(trials) + " answers is right: look whether right and wrong are exchanged", "");
    if (choice && answers.levels.size() < 2)
      return refusal("all answers are about one size, which gives no function", "present several sizes");
    if (2 * (found.log_likelihood - observer.nothing_felt(shared.lapse)) < 2 * allowed_loss) {
      const auto count = static_cast<double>(trials), chance = count / 2;
      if (choice && static_cast<double>(right) < chance - std::sqrt(count))
        return refusal("the answers are wrong more often than by chance: look whether right and wrong are exchanged", "");
      return refusal("the answers do not depend on the size beyond chance",
                     choice ? "present larger ones, or look whether right and wrong are exchanged"
                            : "present larger ones, or look whether the answers are those of this task");
    }
    const double log = std::log(found.law.threshold);
    const auto lost = [&](double at) {
      return found.log_likelihood - observer.at(at, shared.exponent, shared.lapse) > allowed_loss;
    };
    if (log <= observer.low() - beyond_sizes + 1e-3 || !lost(observer.low() - beyond_sizes))
      return refusal("the answers are as good to the smallest size as to the largest: the threshold lies below the sizes",
                     "present smaller ones");
    return std::nullopt;
  }

  SensitivityOptions options_;
  bool held_ = false;
  std::vector<OneObserver> observers_;
};

Shared SensitivityFitter::shared(const std::vector<bool>& chosen, std::optional<Population>* keep) const {
  if (std::ranges::count(chosen, true) == 1)
    return shared_by_one(static_cast<std::size_t>(std::ranges::find(chosen, true) - chosen.begin()));
  std::vector<const OneObserver*> observers;
  for (std::size_t i = 0; i < chosen.size(); ++i)
    if (chosen[i]) observers.push_back(&observers_[i]);
  Population population(std::move(observers), options_);
  const Shared shared = population.best();
  if (keep != nullptr) *keep = std::move(population);
  return shared;
}

Result<> require_sound(const std::vector<ObserverAnswers>& observers) {
  for (const ObserverAnswers& each : observers) {
    if (each.false_alarms > each.noises) return refusal(Code::malformed_value, "more answers are counted than were given", "");
    for (const Level& level : each.levels) {
      if (level.right > level.trials)
        return refusal(Code::malformed_value, std::to_string(level.right) + " of " + std::to_string(level.trials) + " answers are right", "");
      if (!(level.size > 0) || !std::isfinite(level.size))
        return refusal(Code::malformed_value, "a size of zero or below has no threshold", "leave it out by rule");
    }
  }
  return {};
}

/// How much less likely the ends of the interval of a mean of n logarithms are. Of a normal sample it is what the profile
/// loses at the ends of Student's interval: with few observers their spread is not known, which the chi-squared
/// distribution would forget.
double allowed_loss_of_mean(double n) {
  const double t = t_quantile(0.975, n - 1);
  return n / 2 * std::log1p(t * t / (n - 1));
}

/// The interval of an estimate by its pseudo-values (Miller 1974): all n of them, t on n - 1 degrees of freedom.
Interval jackknifed(double estimate, const std::vector<double>& without_one) {
  const auto n = static_cast<double>(without_one.size());
  double mean = 0, squares = 0;
  for (const double each : without_one) mean += each / n;
  for (const double each : without_one) squares += (each - mean) * (each - mean);
  const double reach = t_quantile(0.975, n - 1) * std::sqrt((n - 1) / n * squares);
  return {estimate - reach, estimate + reach};
}

}  // namespace

double SensitivityLaw::d_prime(double size) const { return size > 0 ? std::pow(size / threshold, exponent) : 0; }
double SensitivityLaw::at(double size) const {
  return lapse + (1 - 2 * lapse) * chance_of(decision, d_prime(size), criterion);
}

Result<SensitivityFit> fit_sensitivity(const std::vector<ObserverAnswers>& observers, const SensitivityOptions& options) {
  if (const auto sound = require_sound(observers); !sound) return sound.error();
  if (observers.empty()) return refusal("there are no answers", "");
  const SensitivityFitter fitter(observers, options);
  std::vector<bool> chosen(observers.size(), true);
  std::optional<Population> population;
  Shared shared = fitter.shared(chosen, &population);
  SensitivityFit fit;
  // Those without a threshold have no part in the exponent and the lapse rate either; without them, others may lack one.
  for (;;) {
    fit.observers.clear();
    bool dropped = false;
    for (std::size_t i = 0; i < observers.size(); ++i) {
      fit.observers.push_back(fitter.own(i, shared));
      if (chosen[i] && fit.observers.back().refused) chosen[i] = false, dropped = true;
    }
    const auto count = std::ranges::count(chosen, true);
    if (count == 0) return *fit.observers.front().refused;
    if (!dropped) break;
    shared = fitter.shared(chosen, &population);
  }
  const auto count = static_cast<std::size_t>(std::ranges::count(chosen, true));
  std::vector<SensitivityFitter::Common> commons;
  if (options.intervals && count > 1) commons = fitter.commons(*population, shared);
  fit.exponent = shared.exponent, fit.lapse = shared.lapse, fit.log_likelihood = shared.log_likelihood;
  fit.exponent_is_held = fitter.exponent_is_held();
  for (std::size_t i = 0, in_population = 0; i < observers.size(); ++i) {
    // With the final exponent, one who was dropped may have a threshold; the rule was applied once.
    if (!chosen[i] && !fit.observers[i].refused)
      fit.observers[i].refused = refusal("the answers do not depend on the size beyond chance", "");
    if (options.intervals && chosen[i])
      fit.observers[i].interval = count == 1 ? fitter.interval_of_all(i, fit.observers[i])
                                             : fitter.interval_of(i, in_population++, commons, fit.observers[i]);
  }
  if (count < 2) return fit;
  const Interval logs = population->ends_of_mean(allowed_loss_of_mean(static_cast<double>(count)));
  fit.mean = SensitivityFit::Mean{std::exp(population->place()[2]), {std::exp(logs.low), std::exp(logs.high)}, count};
  return fit;
}

Result<ObserverSensitivity> fit_sensitivity_together(const std::vector<ObserverAnswers>& observers,
                                                     const SensitivityOptions& options) {
  const auto together = [&](std::size_t but) {
    ObserverAnswers all;
    for (std::size_t i = 0; i < observers.size(); ++i) {
      if (i == but) continue;
      all.levels.insert(all.levels.end(), observers[i].levels.begin(), observers[i].levels.end());
      all.false_alarms += observers[i].false_alarms, all.noises += observers[i].noises;
    }
    return all;
  };
  SensitivityOptions plain = options;
  plain.intervals = false;
  auto fit = fit_sensitivity({together(observers.size())}, plain);
  if (!fit) return fit.error();
  ObserverSensitivity all = fit->observers.front();
  if (observers.size() < 2) {
    const SensitivityFitter fitter(observers, options);
    all.interval = fitter.interval_of_all(0, all);
    return all;
  }
  std::vector<double> without;
  for (std::size_t i = 0; i < observers.size(); ++i) {
    const auto fewer = fit_sensitivity({together(i)}, plain);
    if (!fewer) {
      all.interval = {0, HUGE_VAL};
      return all;
    }
    without.push_back(std::log(fewer->observers.front().law.threshold));
  }
  const Interval logs = jackknifed(std::log(all.law.threshold), without);
  all.interval = {std::exp(logs.low), std::exp(logs.high)};
  return all;
}

}  // namespace wale::analysis
