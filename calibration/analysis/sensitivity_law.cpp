#include "calibration/analysis/sensitivity_law.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "calibration/analysis/distributions.hpp"
#include "calibration/analysis/optimise.hpp"
#include "calibration/analysis/refusal.hpp"

namespace wale::analysis {
namespace {

using Eigen::VectorXd;

/// Of chi-squared with one degree of freedom, over 2: how much less likely the ends of an interval are.
const double allowed_loss = chi_squared_quantile(0.95, 1) / 2;
constexpr double least_exponent = 0.2, most_exponent = 10;
/// How far from the sizes a threshold is looked for, as a logarithm.
constexpr double beyond = 4;
constexpr double most_criterion = 6;

double below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double chance_of(Decision decision, double d_prime, double criterion) {
  switch (decision) {
    case Decision::interval_choice: return below(d_prime / std::numbers::sqrt2);
    case Decision::yes_no: return below(d_prime - criterion);
    default:
      return below((d_prime - criterion) / std::numbers::sqrt2) + below((-d_prime - criterion) / std::numbers::sqrt2);
  }
}

double density_at(double z) { return std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi); }

/// Its slopes along d' and the criterion.
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

bool has_criterion(Decision decision) { return decision != Decision::interval_choice; }

/// A threshold's logarithm and a criterion, and the likelihood there.
struct Own {
  double log = 0, criterion = 0, log_likelihood = -HUGE_VAL;
};

/// The likelihood of one observer's answers, given exponent and lapse rate.
class OneObserver {
 public:
  OneObserver(const ObserverAnswers& answers, Decision decision) : answers_(answers), decision_(decision) {
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

  const ObserverAnswers& answers() const { return answers_; }
  double low() const { return low_; }
  double high() const { return high_; }

  double log_likelihood(double log_threshold, double exponent, double lapse, double criterion) const {
    double sum = 0;
    for (std::size_t i = 0; i < logs_.size(); ++i) {
      const double d = std::exp(std::clamp(exponent * (logs_[i] - log_threshold), -50.0, 5.0));
      sum += term(answers_.levels[i].right, answers_.levels[i].trials,
                  lapse + (1 - 2 * lapse) * chance_of(decision_, d, criterion));
    }
    return sum + noise_term(lapse, criterion);
  }

  /// With the best criterion.
  double at(double log_threshold, double exponent, double lapse, double* best_criterion = nullptr) const {
    if (!has_criterion(decision_)) return log_likelihood(log_threshold, exponent, lapse, 0);
    const auto loss = [&](double criterion) { return -log_likelihood(log_threshold, exponent, lapse, criterion); };
    const double from = decision_ == Decision::yes_no ? -most_criterion : 0;
    const double found = valley(loss, from, most_criterion);
    if (best_criterion != nullptr) *best_criterion = found;
    return -loss(found);
  }

  /// The most likely threshold and criterion: by scoring from `near`, else from the best of a grid.
  Own best(double exponent, double lapse, const Own* near = nullptr) const {
    if (near != nullptr && std::isfinite(near->log_likelihood))
      if (const auto found = scored(*near, exponent, lapse)) return *found;
    const auto loss = [&](double log) { return -at(log, exponent, lapse); };
    Own found{.log = valley(loss, low_ - beyond, high_ + beyond)};
    found.log_likelihood = at(found.log, exponent, lapse, &found.criterion);
    if (const auto better = scored(found, exponent, lapse); better && better->log_likelihood > found.log_likelihood)
      return *better;
    return found;
  }

  /// The likelihood if nothing is felt.
  double nothing_felt(double lapse) const {
    std::size_t yes = answers_.false_alarms, trials = answers_.noises;
    for (const Level& each : answers_.levels) yes += each.right, trials += each.trials;
    if (!has_criterion(decision_)) return -static_cast<double>(trials) * std::numbers::ln2;
    const double share = static_cast<double>(yes) / static_cast<double>(trials);
    return term(yes, trials, std::clamp(share, lapse, 1 - lapse));
  }

 private:
  /// Fisher's scoring: the slope of the likelihood over its expected curvature, by steps that gain. Nothing if it leaves
  /// the range of thresholds or does not come to rest.
  std::optional<Own> scored(const Own& from, double exponent, double lapse) const {
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
      if (two) {
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
      if (now.log < low_ - beyond || now.log > high_ + beyond || std::abs(now.criterion) > most_criterion)
        return std::nullopt;
      if (most < 1e-6) return now;
    }
    return std::nullopt;
  }

  double noise_term(double lapse, double criterion) const {
    if (answers_.noises == 0) return 0;
    return term(answers_.false_alarms, answers_.noises,
                lapse + (1 - 2 * lapse) * chance_of(decision_, 0, criterion));
  }

  /// The lowest place of a function: the best of a few, then its valley.
  template <class Loss>
  static double valley(const Loss& loss, double from, double to) {
    constexpr int places = 16;
    int lowest = 0;
    double least = HUGE_VAL;
    for (int i = 0; i <= places; ++i)
      if (const double value = loss(from + (to - from) * i / places); value < least) least = value, lowest = i;
    const auto place = [&](int i) { return from + (to - from) * std::clamp(i, 0, places) / places; };
    return lowest_within(loss, place(lowest - 1), place(lowest + 1), 1e-6);
  }

  ObserverAnswers answers_;
  Decision decision_;
  std::vector<double> logs_;
  double low_ = 0, high_ = 0;
};

struct Shared {
  double exponent = 1, lapse = 0, log_likelihood = -HUGE_VAL;
};

class SensitivityFitter {
 public:
  SensitivityFitter(const std::vector<ObserverAnswers>& observers, const SensitivityOptions& options)
      : options_(options) {
    for (const ObserverAnswers& each : observers) observers_.emplace_back(each, options.decision);
    const auto few = [](const OneObserver& each) { return each.answers().levels.size() < 2; };
    if (!options.exponent && std::ranges::all_of(observers_, few)) options_.exponent = 1, held_ = true;
  }

  bool exponent_is_held() const { return held_; }
  const std::vector<OneObserver>& observers() const { return observers_; }

  /// The best exponent and lapse rate for the observers whose entry in `chosen` is set.
  Shared shared(const std::vector<bool>& chosen) const {
    std::vector<Own> own(observers_.size());
    const auto sum = [&](double exponent, double lapse) {
      double all = 0;
      for (std::size_t i = 0; i < observers_.size(); ++i) {
        if (!chosen[i]) continue;
        own[i] = observers_[i].best(exponent, lapse, &own[i]);
        all += own[i].log_likelihood;
      }
      return all;
    };
    return over_shared(sum);
  }

  /// The greatest of a likelihood over exponent and lapse rate.
  template <class Sum>
  Shared over_shared(const Sum& sum, const Shared* near = nullptr) const {
    Shared best;
    const auto from = [&](double exponent, double lapse, double step) {
      std::vector<double> start;
      if (!options_.exponent) start.push_back(std::log(exponent));
      // A squared sine, so that the rate 0 can be reached.
      if (!options_.lapse) start.push_back(std::asin(std::sqrt(lapse / options_.most_lapse)));
      const auto read = [&](const VectorXd& at) {
        Eigen::Index i = 0;
        Shared found;
        found.exponent = options_.exponent
                             ? *options_.exponent
                             : std::clamp(std::exp(at(i++)), least_exponent, most_exponent);
        found.lapse = options_.lapse ? *options_.lapse : options_.most_lapse * std::pow(std::sin(at(i++)), 2);
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
    return {std::exp(end(-1, observer.low() - beyond)), std::exp(end(1, observer.high() + beyond))};
  }

  Interval interval_of(std::size_t i, const ObserverSensitivity& own) const {
    return ends(observers_[i], std::log(own.law.threshold), own.log_likelihood,
                [&](double log) { return observers_[i].at(log, own.law.exponent, own.law.lapse); });
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
    if (log <= observer.low() - beyond + 1e-3 || !lost(observer.low() - beyond))
      return refusal("the answers are as good to the smallest size as to the largest: the threshold lies below the sizes",
                     "present smaller ones");
    return std::nullopt;
  }

  SensitivityOptions options_;
  bool held_ = false;
  std::vector<OneObserver> observers_;
};

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

/// The mean of the logarithms of the chosen observers' thresholds, and the variance of each observer's influence on it:
/// their own threshold, and their part in the common exponent and lapse rate, which move all thresholds (Huber 1967).
struct MeanLog {
  double mean = 0, error = 0;
};
MeanLog mean_log_of(const SensitivityFitter& fitter, const std::vector<bool>& chosen, const Shared& shared,
                    const SensitivityOptions& options) {
  std::vector<std::size_t> who;
  for (std::size_t i = 0; i < chosen.size(); ++i)
    if (chosen[i]) who.push_back(i);
  const auto n = static_cast<double>(who.size());
  std::vector<Own> middle;
  for (const std::size_t i : who) middle.push_back(fitter.observers()[i].best(shared.exponent, shared.lapse));
  MeanLog result;
  for (const Own& each : middle) result.mean += each.log / n;
  // A parameter at the end of its range is no estimate whose scatter could be told.
  constexpr double of_exponent = 0.02, of_lapse = 0.001;
  std::vector<std::array<double, 2>> ways;
  if (!options.exponent && !fitter.exponent_is_held() && shared.exponent > 1.05 * least_exponent &&
      shared.exponent < 0.95 * most_exponent)
    ways.push_back({of_exponent, 0});
  if (!options.lapse && shared.lapse > 1.5 * of_lapse && shared.lapse < options.most_lapse - 1.5 * of_lapse)
    ways.push_back({0, of_lapse});
  const auto count = static_cast<Eigen::Index>(ways.size());
  const auto at = [&](std::size_t k, const std::array<double, 2>& by) {
    return fitter.observers()[who[k]].best(shared.exponent * std::exp(by[0]), shared.lapse + by[1], &middle[k]);
  };
  Eigen::MatrixXd slopes(static_cast<Eigen::Index>(who.size()), count), curvature = Eigen::MatrixXd::Zero(count, count);
  VectorXd moves = VectorXd::Zero(count);  // of the mean
  for (Eigen::Index a = 0; a < count; ++a) {
    const auto& way = ways[static_cast<std::size_t>(a)];
    for (std::size_t k = 0; k < who.size(); ++k) {
      const Own up = at(k, way), down = at(k, {-way[0], -way[1]});
      slopes(static_cast<Eigen::Index>(k), a) = (up.log_likelihood - down.log_likelihood) / 2;
      moves(a) += (up.log - down.log) / 2 / n;
      curvature(a, a) -= up.log_likelihood + down.log_likelihood - 2 * middle[k].log_likelihood;
    }
  }
  if (count == 2)
    for (std::size_t k = 0; k < who.size(); ++k) {
      const auto both = [&](double e, double l) { return at(k, {e * of_exponent, l * of_lapse}).log_likelihood; };
      curvature(0, 1) -= (both(1, 1) - both(1, -1) - both(-1, 1) + both(-1, -1)) / 4;
      curvature(1, 0) = curvature(0, 1);
    }
  VectorXd pull = VectorXd::Zero(count);
  if (count > 0) {
    const Eigen::LDLT<Eigen::MatrixXd> solver(curvature);
    if (solver.info() == Eigen::Success && solver.isPositive()) pull = solver.solve(moves);
  }
  double squares = 0;
  for (std::size_t k = 0; k < who.size(); ++k) {
    double influence = (middle[k].log - result.mean) / n;
    if (count > 0) influence += slopes.row(static_cast<Eigen::Index>(k)).dot(pull);
    squares += influence * influence;
  }
  result.error = std::sqrt(squares * n / (n - 1));
  return result;
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
  Shared shared = fitter.shared(chosen);
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
    shared = fitter.shared(chosen);
  }
  fit.exponent = shared.exponent, fit.lapse = shared.lapse, fit.log_likelihood = shared.log_likelihood;
  fit.exponent_is_held = fitter.exponent_is_held();
  for (std::size_t i = 0; i < observers.size(); ++i) {
    // With the final exponent, one who was dropped may have a threshold; the rule was applied once.
    if (!chosen[i] && !fit.observers[i].refused)
      fit.observers[i].refused = refusal("the answers do not depend on the size beyond chance", "");
    if (options.intervals && chosen[i])
      fit.observers[i].interval = observers.size() == 1 ? fitter.interval_of_all(i, fit.observers[i])
                                                        : fitter.interval_of(i, fit.observers[i]);
  }
  const auto count = static_cast<std::size_t>(std::ranges::count(chosen, true));
  if (count < 2) return fit;
  const MeanLog mean = mean_log_of(fitter, chosen, shared, options);
  const double reach = t_quantile(0.975, static_cast<double>(count) - 1) * mean.error;
  fit.mean = SensitivityFit::Mean{std::exp(mean.mean), {std::exp(mean.mean - reach), std::exp(mean.mean + reach)}, count};
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
