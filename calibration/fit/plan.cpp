#include "calibration/fit/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "calibration/analysis/distributions.hpp"
#include "calibration/analysis/mixed_model.hpp"
#include "calibration/analysis/sensitivity_law.hpp"
#include "calibration/analysis/random.hpp"
#include "calibration/experiment/level_chooser.hpp"
#include "calibration/experiment/trial_order.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

using namespace analysis;

Error unfit(std::string sentence, std::string mend) {
  return {.code = Code::malformed_value, .sentence = std::move(sentence), .mend = std::move(mend)};
}

/// What one simulated study found: the half width of its interval, and whether that holds the truth.
struct Found {
  double half_width = HUGE_VAL;
  bool covered = false;
};

/// A study with so many people. Nothing if it does not determine what is sought.
using Simulate = std::function<std::optional<Found>(std::size_t people, Random& random)>;

/// Studies of magnitude estimation: each person has a law, and all trials a scatter.
class MagnitudeStudies {
 public:
  MagnitudeStudies(std::vector<double> logs, int repetitions, const PlanRequest& request)
      : logs_(std::move(logs)), repetitions_(repetitions), request_(request) {}

  std::optional<Found> operator()(std::size_t people, Random& random) const {
    const std::size_t each = logs_.size() * static_cast<std::size_t>(repetitions_), all = each * people;
    MixedData data{{{"constant", "log10 size"}, Eigen::MatrixXd::Ones(static_cast<Eigen::Index>(all), 2)},
                   {0, 1},
                   {},
                   people,
                   Eigen::VectorXd(static_cast<Eigen::Index>(all))};
    Eigen::Index row = 0;
    for (std::size_t person = 0; person < people; ++person) {
      const double exponent = request_.exponent + request_.spread * random.normal(),
                   level = request_.numbers * random.normal();
      for (int run = 0; run < repetitions_; ++run)
        for (const double log : logs_) {
          data.fixed.columns(row, 1) = log;
          data.y(row++) = level + exponent * log + request_.noise * random.normal();
          data.observer.push_back(static_cast<std::uint32_t>(person));
        }
    }
    const auto fit = fit_mixed_simplified(data, Criterion::restricted);
    if (!fit) return std::nullopt;
    const Coefficient& slope = fit->coefficients[1];
    return Found{(slope.high() - slope.low()) / 2,
                 slope.low() <= request_.exponent && request_.exponent <= slope.high()};
  }

 private:
  std::vector<double> logs_;  // of the stimuli, about their mean
  int repetitions_;
  const PlanRequest& request_;
};

/// People that are simulated once; each study of thresholds takes some of them, since tracks take long.
constexpr std::size_t pool = 1000;

/// Studies of thresholds: each person has a threshold, and a track or constant stimuli about it.
class ThresholdStudies {
 public:
  ThresholdStudies(const CheckedExperiment& experiment, std::vector<double> levels, bool is_ratio, double threshold,
                   const PlanRequest& request)
      : experiment_(experiment),
        levels_(std::move(levels)),
        is_ratio_(is_ratio),
        threshold_(threshold),
        request_(request),
        decision_(decision_of(experiment.task)),
        // Of a difference, a criterion is that of two intervals: "different" to what is the same in 16 % of the trials.
        criterion_(decision_ == Decision::same_different_difference ? 2 * request.criterion : request.criterion) {
    Random random(request.seed);
    for (std::size_t person = 0; person < pool; ++person)
      people_.push_back(answers_of(threshold * std::exp(request.threshold_spread * random.normal()), random));
  }

  std::optional<Found> operator()(std::size_t people, Random& random) const {
    std::vector<ObserverAnswers> answers;
    for (std::size_t person = 0; person < people; ++person) answers.push_back(people_[random.below(people_.size())]);
    // As the trials of a study are fitted.
    const auto fit = fit_sensitivity(answers, {.decision = decision_, .intervals = false});
    if (!fit || !fit->mean) return std::nullopt;
    const Interval& interval = fit->mean->interval;
    return Found{std::log(interval.high / interval.low) / 2, interval.holds(threshold_)};
  }

 private:
  static Decision decision_of(TrialTask task) {
    return task == TrialTask::two_interval   ? Decision::interval_choice
           : task == TrialTask::one_interval ? Decision::yes_no
                                             : Decision::same_different_difference;
  }

  double difference(std::size_t level) const { return is_ratio_ ? levels_[level] - 1 : levels_[level]; }

  bool answer(std::size_t level, double own, Random& random) const {
    const SensitivityLaw law{decision_, own, request_.growth, request_.lapse, criterion_};
    return random.uniform() < law.at(difference(level));
  }

  ObserverAnswers answers_of(double own, Random& random) const {
    std::map<std::size_t, Level> counts;
    ObserverAnswers answers;
    const auto present = [&](std::size_t level) {
      if (decision_ != Decision::interval_choice && random.uniform() < experiment_.catches) {
        const SensitivityLaw law{decision_, own, request_.growth, request_.lapse, criterion_};
        const bool alarm = random.uniform() < law.at(0);
        ++answers.noises, answers.false_alarms += alarm ? 1 : 0;
        return !alarm;
      }
      const bool right = answer(level, own, random);
      Level& each = counts[level];
      each.size = difference(level), ++each.trials, each.right += right ? 1 : 0;
      return right;
    };
    for (int run = 0; run < experiment_.repetitions; ++run) {
      if (!is_adaptive(experiment_)) {
        for (std::size_t level = 0; level < levels_.size(); ++level) present(level);
        continue;
      }
      const auto chooser = chooser_of(experiment_, levels_);
      while (!chooser->over()) {
        const std::size_t level = chooser->next();
        chooser->take(level, present(level));
      }
    }
    for (const auto& [level, each] : counts) answers.levels.push_back(each);
    return answers;
  }

  const CheckedExperiment& experiment_;
  std::vector<double> levels_;
  bool is_ratio_;
  double threshold_;
  const PlanRequest& request_;
  Decision decision_;
  double criterion_;
  std::vector<ObserverAnswers> people_;  // the pool
};

PlanStep step_of(std::size_t people, const Simulate& simulate, const PlanRequest& request) {
  PlanStep step{.people = people};
  std::vector<double> widths;
  Random random(request.seed * 1000003 + people);
  std::size_t covered = 0, precise = 0;
  for (std::size_t study = 0; study < request.studies; ++study) {
    const Found found = simulate(people, random).value_or(Found());
    widths.push_back(found.half_width);
    covered += found.covered ? 1 : 0;
    precise += found.half_width <= request.precision ? 1 : 0;
  }
  std::ranges::sort(widths);
  const auto n = static_cast<double>(request.studies);
  step.half_width = widths[std::min(widths.size() - 1, static_cast<std::size_t>(std::ceil(request.share * n)) - 1)];
  step.precise = static_cast<double>(precise) / n, step.covered = static_cast<double>(covered) / n;
  return step;
}

/// Doubles the people until they are enough, then halves the gap.
void search(Plan& plan, const Simulate& simulate, const PlanRequest& request) {
  const auto is_enough = [&](std::size_t people) {
    plan.steps.push_back(step_of(people, simulate, request));
    return plan.steps.back().precise >= request.share;
  };
  std::size_t few = 2, many = 3;
  while (!is_enough(many)) {
    if (many == request.most) return;
    few = many, many = std::min(request.most, many * 2);
  }
  while (many - few > 1) {
    const std::size_t middle = (few + many) / 2;
    (is_enough(middle) ? many : few) = middle;
  }
  plan.people = many;
}

/// The factor that is sought.
Result<std::size_t> factor_of(const CheckedExperiment& experiment, const std::string& named) {
  if (named.empty() && experiment.over) return *experiment.over;
  for (std::size_t i = 0; i < experiment.factors.size(); ++i) {
    const ExperimentFactor& each = experiment.factors[i];
    const bool is_number =
        std::ranges::all_of(each.levels, [](const ExperimentLevel& level) { return level.value.has_value(); });
    if (named.empty() ? is_number : each.name == named) {
      if (is_number) return i;
      return unfit(fmt::format("the factor `{}` has words for levels", each.name), "name one with quantities");
    }
  }
  return unfit(named.empty() ? "the experiment has no factor with quantities"
                             : fmt::format("the experiment has no factor `{}`", visible_text(named)),
               named.empty() ? "give the sizes of its stimuli in a table, with --stimuli" : "name one of its factors");
}

}  // namespace

Result<Plan> plan_experiment(const CheckedExperiment& experiment, const PlanRequest& request) {
  Plan plan;
  std::vector<double> values;
  std::string name = "size";
  std::size_t factor = 0;
  if (request.sizes.empty()) {
    const auto found = factor_of(experiment, request.over);
    if (!found) return found.error();
    factor = *found, name = experiment.factors[factor].name;
    for (const ExperimentStimulus& each : experiment.stimuli)
      if (each.levels[factor]) values.push_back(*experiment.factors[factor].levels[*each.levels[factor]].value);
  } else {
    values = request.sizes;
  }
  if (values.empty() || *std::ranges::min_element(values) <= 0)
    return unfit(fmt::format("the {} of some stimuli is zero or below, or not known", name),
                 "a law needs sizes above zero");
  if (experiment.task == TrialTask::magnitude_estimation) {
    double mean = 0;
    for (double& each : values) each = std::log10(each), mean += each / static_cast<double>(values.size());
    for (double& each : values) each -= mean;
    plan.sought = "exponent of " + name;
    plan.trials = values.size() * static_cast<std::size_t>(experiment.repetitions);
    const auto [low, high] = std::ranges::minmax(values);
    if (!(high > low))
      return Error{.code = Code::not_measured,
                   .sentence = "all stimuli have one size, so no study finds an exponent",
                   .mend = "vary it"};
    search(plan, MagnitudeStudies(values, experiment.repetitions, request), request);
    return plan;
  }
  if (experiment.task != TrialTask::two_interval && experiment.task != TrialTask::one_interval &&
      experiment.task != TrialTask::same_different) {
    const std::string task = trial_task_names[static_cast<int>(experiment.task)];
    return unfit(fmt::format("`{}` seeks neither an exponent nor a threshold, whose precision could be planned", task),
                 experiment.task == TrialTask::adjustment
                     ? "the precision of a mean setting is its scatter between people over the root of their number"
                     : "plan magnitude_estimation, two_interval, one_interval or same_different");
  }
  std::ranges::sort(values);
  values.erase(std::unique(values.begin(), values.end()), values.end());
  const bool is_ratio = request.sizes.empty() && experiment.factors[factor].unit.empty() && values.front() > 1;
  const double first = is_ratio ? values.front() - 1 : values.front(),
               last = is_ratio ? values.back() - 1 : values.back();
  const double threshold = request.threshold.value_or(std::sqrt(first * last));
  plan.sought = "threshold of " + name;
  plan.trials = (is_adaptive(experiment) ? static_cast<std::size_t>(experiment.trials) : values.size()) *
                static_cast<std::size_t>(experiment.repetitions);
  search(plan, ThresholdStudies(experiment, values, is_ratio, threshold, request), request);
  return plan;
}

}  // namespace wale
