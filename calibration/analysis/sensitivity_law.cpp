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

  /// The likelihoods of thresholds at the places of a grid, with the best criterion for each.
  void along(const std::vector<double>& grid, double exponent, double lapse, std::vector<double>& result) const {
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
  std::optional<Own> scored(const Own& from, double exponent, double lapse, bool criterion_only = false) const {
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

class SensitivityFitter;

/// Observers whose thresholds' logarithms are spread normally. To estimate exponent and lapse rate with a threshold for
/// each observer instead would make the exponent too large, and much so with the few answers of an adaptive track
/// (Neyman and Scott 1948): thresholds are integrated over.
class Population {
 public:
  /// exponent's logarithm, lapse rate, mean and logarithm of the spread of the thresholds' logarithms
  using Place = std::array<double, 4>;

  Population(const SensitivityFitter& fitter, const std::vector<bool>& chosen);
  Shared best();
  /// Of each chosen observer, in their order.
  std::vector<double> log_likelihoods(const Place& at);
  const Place& place() const { return place_; }
  /// Which of the four are estimated and away from the ends of their range.
  std::vector<std::size_t> inner() const;
  static constexpr Place steps = {0.02, 0.001, 0.01, 0.02};

 private:
  double sum(const Place& at);

  const SensitivityFitter* fitter_;
  std::vector<const OneObserver*> observers_;
  std::vector<double> grid_;
  void along_choices(double exponent, double lapse);

  std::vector<std::vector<double>> along_;  ///< of each observer at the grid, for `known_`
  std::vector<double> sizes_;               ///< logarithms of all sizes, rising
  struct Counts {
    std::size_t size;
    double right, wrong;
  };
  std::vector<std::vector<Counts>> counts_;  ///< of each observer
  std::array<double, 2> known_ = {HUGE_VAL, HUGE_VAL};
  Place place_{};
};

constexpr double least_spread = 0.03, most_spread = 3;

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

Shared SensitivityFitter::shared(const std::vector<bool>& chosen, std::optional<Population>* keep) const {
  if (std::ranges::count(chosen, true) == 1)
    return shared_by_one(static_cast<std::size_t>(std::ranges::find(chosen, true) - chosen.begin()));
  Population population(*this, chosen);
  const Shared shared = population.best();
  if (keep != nullptr) *keep = std::move(population);
  return shared;
}

Population::Population(const SensitivityFitter& fitter, const std::vector<bool>& chosen) : fitter_(&fitter) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (!chosen[i]) continue;
    observers_.push_back(&fitter.observers()[i]);
    low = std::min(low, observers_.back()->low()), high = std::max(high, observers_.back()->high());
  }
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
  if (has_criterion(fitter.options().decision)) return;
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
  const SensitivityOptions& options = fitter_->options();
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
    if (!options.exponent) start.push_back(std::log(exponent)), steps.push_back(0.3);
    // A squared sine, so that the rate 0 can be reached.
    if (!options.lapse) start.push_back(std::asin(std::sqrt(lapse / options.most_lapse))), steps.push_back(0.3);
    const auto read = [&](const VectorXd& at) {
      Eigen::Index i = 2;
      Place place{0, 0, std::clamp(at(0), grid_.front(), grid_.back()),
                  std::clamp(at(1), std::log(least_spread), std::log(most_spread))};
      place[0] = options.exponent ? std::log(*options.exponent)
                                  : std::clamp(at(i++), std::log(least_exponent), std::log(most_exponent));
      place[1] = options.lapse ? *options.lapse : options.most_lapse * std::pow(std::sin(at(i++)), 2);
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
  for (const double exponent : options.exponent ? std::vector<double>{*options.exponent} : std::vector<double>{1, 2.5})
    from(exponent, options.lapse.value_or(0.2 * options.most_lapse));
  return best;
}

std::vector<std::size_t> Population::inner() const {
  const SensitivityOptions& options = fitter_->options();
  const auto is_inside = [](double value, double low, double high, double step) {
    return value > low + 1.5 * step && value < high - 1.5 * step;
  };
  std::vector<std::size_t> result;
  if (!options.exponent && is_inside(place_[0], std::log(least_exponent), std::log(most_exponent), steps[0])) result.push_back(0);
  if (!options.lapse && is_inside(place_[1], 0, options.most_lapse, steps[1])) result.push_back(1);
  result.push_back(2);
  if (is_inside(place_[3], std::log(least_spread), std::log(most_spread), steps[3])) result.push_back(3);
  return result;
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

/// The mean of the logarithms of the chosen observers' thresholds, and the variance of each observer's influence on it:
/// their own threshold, and their part in the common exponent and lapse rate, which move all thresholds (Huber 1967).
struct MeanLog {
  double mean = 0, error = 0;
};
MeanLog mean_log_of(const SensitivityFitter& fitter, const std::vector<bool>& chosen, const Shared& shared,
                    Population& population) {
  std::vector<std::size_t> who;
  for (std::size_t i = 0; i < chosen.size(); ++i)
    if (chosen[i]) who.push_back(i);
  const auto n = static_cast<double>(who.size());
  std::vector<Own> middle;
  for (const std::size_t i : who) middle.push_back(fitter.observers()[i].best(shared.exponent, shared.lapse));
  MeanLog result;
  for (const Own& each : middle) result.mean += each.log / n;
  const auto moved = [&](std::initializer_list<std::pair<std::size_t, double>> by) {
    Population::Place place = population.place();
    for (const auto& [i, times] : by) place[i] += times * Population::steps[i];
    return place;
  };
  const std::vector<std::size_t> inner = population.inner();
  const auto count = static_cast<Eigen::Index>(inner.size());
  Eigen::MatrixXd slopes(static_cast<Eigen::Index>(who.size()), count), curvature(count, count);
  VectorXd moves = VectorXd::Zero(count);  // of the mean
  const auto total = [&](const Population::Place& at) {
    double sum = 0;
    for (const double each : population.log_likelihoods(at)) sum += each;
    return sum;
  };
  const double here = total(population.place());
  for (Eigen::Index a = 0; a < count; ++a) {
    const std::size_t i = inner[static_cast<std::size_t>(a)];
    const auto up = population.log_likelihoods(moved({{i, 1}})), down = population.log_likelihoods(moved({{i, -1}}));
    curvature(a, a) = 2 * here;
    for (std::size_t k = 0; k < who.size(); ++k) {
      slopes(static_cast<Eigen::Index>(k), a) = (up[k] - down[k]) / 2;
      curvature(a, a) -= up[k] + down[k];
    }
    if (i < 2)
      for (std::size_t k = 0; k < who.size(); ++k) {
        const auto log_at = [&](double times) {
          const auto place = moved({{i, times}});
          return fitter.observers()[who[k]].best(std::exp(place[0]), place[1], &middle[k]).log;
        };
        moves(a) += (log_at(1) - log_at(-1)) / 2 / n;
      }
    for (Eigen::Index b = 0; b < a; ++b) {
      const std::size_t j = inner[static_cast<std::size_t>(b)];
      curvature(a, b) = curvature(b, a) = -(total(moved({{i, 1}, {j, 1}})) - total(moved({{i, 1}, {j, -1}})) -
                                            total(moved({{i, -1}, {j, 1}})) + total(moved({{i, -1}, {j, -1}}))) / 4;
    }
  }
  VectorXd pull = VectorXd::Zero(count);
  const Eigen::LDLT<Eigen::MatrixXd> solver(curvature);
  if (solver.info() == Eigen::Success && solver.isPositive()) pull = solver.solve(moves);
  double squares = 0;
  for (std::size_t k = 0; k < who.size(); ++k) {
    const double influence =
        (middle[k].log - result.mean) / n + slopes.row(static_cast<Eigen::Index>(k)).dot(pull);
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
  const MeanLog mean = mean_log_of(fitter, chosen, shared, *population);
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
