#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "calibration/analysis/distributions.hpp"
#include "calibration/fit/study_fit.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

using namespace analysis;

/// The share of right answers of two intervals at d' = 1.
const double right_at_one = normal_below(std::sqrt(0.5));

/// The size of the standard as the name of a presentation says it: 0.8 of "standard bench(amplitude: 0.8 N)".
std::optional<double> standard_in_name(std::string_view name, const std::string& argument, const std::string& unit) {
  const auto at = name.find(argument + ": ");
  if (at == std::string_view::npos) return std::nullopt;
  std::string_view rest = name.substr(at + argument.size() + 2);
  rest = rest.substr(0, rest.find_first_of(",)"));
  const auto space = rest.find(' ');
  const auto value = number_in(rest.substr(0, space));
  const std::string_view written = space == std::string_view::npos ? std::string_view() : rest.substr(space + 1);
  if (!value || (*value != 0 && written != unit)) return std::nullopt;
  return value;
}

Interval scaled(const Interval& interval, double by) { return {interval.low * by, interval.high * by}; }

/// The threshold at d' = 1 of answers in two intervals.
ObserverThreshold of_choices(const std::string& observer, const PsychometricFit& fit) {
  // The lapses are no part of what is felt.
  PsychometricFunction felt = fit.function;
  felt.lapse = 0;
  const double value = felt.size_at(right_at_one);
  return {observer, value, scaled(fit.threshold, value / felt.threshold), {}};
}

/// Where a line through the origin of d' over the differences is 1.
ObserverThreshold of_sensitivities(const std::string& observer,
                                   const std::vector<std::pair<double, Sensitivity>>& known) {
  double products = 0, squares = 0;
  for (const auto& [difference, each] : known) {
    if (!(each.error > 0)) continue;
    products += difference * each.d_prime / (each.error * each.error);
    squares += difference * difference / (each.error * each.error);
  }
  if (!(squares > 0) || !(products > 0)) return {observer, 0, {}, "d' does not grow with the difference"};
  const double slope = products / squares, error = 1 / std::sqrt(squares);
  const double high = slope + 1.959963984540054 * error, low = slope - 1.959963984540054 * error;
  return {observer, 1 / slope, {1 / high, low > 0 ? 1 / low : HUGE_VAL}, {}};
}

/// Trials about one standard.
struct About {
  double size = 0;
  std::map<double, std::map<std::uint32_t, Level>> levels;  ///< by difference and observer
};

std::string rounded(double value) { return fmt::format("{:.4g}", value); }

class ThresholdAnalyst {
 public:
  ThresholdAnalyst(const Study& study, const FitRequest& request, TrialColumns columns, StudyFit& fit)
      : study_(study), request_(request), columns_(std::move(columns)), fit_(fit) {}

  Result<> analyse() {
    columns_.answers = Answers::choices;
    if (columns_.answer == "response") columns_.answer = "correct";
    with_criterion_ = fit_.task != "two_interval";
    TrialColumns signals = columns_;
    if (with_criterion_) signals.keep.push_back({"target", "1", true});
    auto trials = read_trials(study_.tables, signals);
    if (!trials) return trials.error();
    fit_.trials = *std::move(trials);
    if (with_criterion_)
      if (const auto done = read_noises(); !done) return done;
    if (const auto done = find_over(); !done) return done;
    collect();
    for (auto& [name, about] : abouts_)
      if (const auto done = fit_one(name, about); !done) return done;
    return pool();
  }

 private:
  Error problem(std::string sentence, std::string mend) const {
    return {.code = Code::malformed_value,
            .sentence = std::move(sentence),
            .mend = std::move(mend),
            .place = {.name = study_.files.front().path}};
  }

  /// Trials with the standard alone, or with a pair that is the same.
  Result<> read_noises() {
    TrialColumns noises = columns_;
    noises.keep.push_back({"target", "0", true});
    noises.sizes.clear(), noises.factors.clear();
    const auto trials = read_trials(study_.tables, noises);
    if (!trials) return trials.error();
    for (std::size_t i = 0; i < trials->size(); ++i) {
      Answered& each = noises_[trials->observers[trials->observer[i]]];
      ++each.noises, ++all_noises_.noises;
      if (trials->answer[i] == 0) ++each.false_alarms, ++all_noises_.false_alarms;
    }
    return {};
  }

  /// The size that is compared, and what its levels are differences from.
  Result<> find_over() {
    const Trials& trials = fit_.trials;
    if (trials.sizes.empty()) return problem("no column has the sizes that were compared", "name one with --size");
    const auto count = [](const SizeValues& size) {
      return std::set<double>(size.values.begin(), size.values.end()).size();
    };
    over_ =
        request_.over.empty() ? &*std::ranges::max_element(trials.sizes, {}, count) : trials.size_named(request_.over);
    if (over_ == nullptr)
      return problem(fmt::format("no size is called `{}`", visible_text(request_.over)), "name a --size");
    for (const SizeValues& each : trials.sizes)
      if (&each != over_) others_.push_back(&each);
    fit_.over = over_->name, fit_.over_unit = over_->unit;
    const auto [low, high] = std::ranges::minmax(over_->values);
    if (request_.standard) {
      standard_ = *request_.standard;
    } else if (over_->unit.empty() && low > 1) {
      standard_ = 1, is_ratio_ = true;
    } else {
      for (const Table& table : study_.tables)
        if (const auto column = table.column("standard"); column && !standard_)
          for (std::size_t row = 0; row < table.rows() && !standard_; ++row)
            standard_ = standard_in_name(table.cell(row, *column), over_->name, over_->unit);
      if (!standard_)
        return problem(fmt::format("nothing says which {} the others are compared with", visible_text(over_->name)),
                       "give it with --standard; 0 if it was told from nothing");
    }
    if (!(*standard_ >= 0)) return problem("a standard is 0 or more", "give another --standard");
    fit_.is_fraction = *standard_ > 0;
    fit_.notes.push_back(fit_.is_fraction ? fmt::format("thresholds are fractions of the standard{}, at d' = 1",
                                                        is_ratio_ ? "" : ", " + rounded(*standard_) + " " + over_->unit)
                                          : fmt::format("thresholds are sizes that are told from nothing, at d' = 1"));
    for (std::size_t i = 0; i < trials.size(); ++i)
      if (!(over_->values[i] > *standard_))
        return Error{.code = Code::malformed_value,
                     .sentence = fmt::format("the {} is {}, not above the standard, {}", visible_text(over_->name),
                                             rounded(over_->values[i]), rounded(*standard_)),
                     .mend = "leave such rows out by rule, as with --drop; thresholds are fitted to one side",
                     .place = trials.place(i)};
    return {};
  }

  void collect() {
    const Trials& trials = fit_.trials;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      std::string name;
      for (const SizeValues* each : others_)
        name += fmt::format("{}{} {}{}{}", name.empty() ? "" : ", ", each->name, rounded(each->values[i]),
                            each->unit.empty() ? "" : " ", each->unit);
      for (const FactorValues& each : trials.factors)
        name += fmt::format("{}{} {}", name.empty() ? "" : ", ", each.name, each.levels[each.values[i]]);
      About& about = abouts_[name];
      about.size = is_ratio_ && others_.size() == 1 ? others_.front()->values[i] : is_ratio_ ? 0 : *standard_;
      const double difference = *standard_ > 0 ? over_->values[i] / *standard_ - 1 : over_->values[i];
      Level& level = about.levels[difference][trials.observer[i]];
      level.size = difference;
      ++level.trials;
      if (trials.answer[i] == 1) ++level.right;
    }
  }

  PsychometricOptions options() const { return {.shape = Sigmoid::weibull, .guess = 0.5, .lapse = {}}; }

  Result<ObserverThreshold> threshold_of(const std::string& observer, const std::vector<Level>& levels,
                                         const Answered& noises, ThresholdFit* keep) const {
    if (!with_criterion_) {
      const auto fitted = fit_psychometric(levels, options());
      if (!fitted) return fitted.error();
      if (keep != nullptr) keep->function = *fitted;
      return of_choices(observer, *fitted);
    }
    std::vector<std::pair<double, Sensitivity>> known;
    for (const Level& each : levels) {
      Answered answered = noises;
      answered.hits = each.right, answered.signals = each.trials;
      const auto d = sensitivity_of(
          fit_.task == "one_interval" ? Decision::yes_no : Decision::same_different_difference, answered);
      if (!d) return d.error();
      known.emplace_back(each.size, *d);
    }
    if (keep != nullptr) keep->sensitivities = known;
    return of_sensitivities(observer, known);
  }

  Result<> fit_one(const std::string& name, const About& about) {
    ThresholdFit result{.standard = name, .size = about.size};
    std::map<std::uint32_t, std::vector<Level>> own;
    for (const auto& [difference, observers] : about.levels) {
      Level all{.size = difference};
      for (const auto& [observer, level] : observers) {
        all.right += level.right, all.trials += level.trials;
        own[observer].push_back(level);
      }
      result.levels.push_back(all);
    }
    double sum = 0, squares = 0;
    std::size_t fitted = 0;
    for (const auto& [observer, levels] : own) {
      const std::string& who = fit_.trials.observers[observer];
      const auto noises = noises_.find(who);
      const auto threshold = threshold_of(who, levels, noises == noises_.end() ? Answered() : noises->second, nullptr);
      result.observers.push_back(threshold ? *threshold : ObserverThreshold{who, 0, {}, in_words(threshold.error())});
      if (!result.observers.back().refused.empty()) continue;
      const double log = std::log(result.observers.back().value);
      sum += log, squares += log * log, ++fitted;
    }
    auto all = threshold_of("all", result.levels, all_noises_, &result);
    if (!all) return all.error();
    if (!all->refused.empty())
      return problem(name + (name.empty() ? "" : ": ") + all->refused, "look at the raw trials");
    result.all = *all;
    if (fitted == own.size() && fitted >= 2) {
      const auto n = static_cast<double>(fitted);
      const double mean = sum / n, deviation = std::sqrt(std::max(0.0, (squares - n * mean * mean) / (n - 1)));
      const double reach = t_quantile(0.975, n - 1) * deviation / std::sqrt(n);
      result.all = {"all", std::exp(mean), {std::exp(mean - reach), std::exp(mean + reach)}, {}};
      result.how = fmt::format("geometric mean of {} observers, t on {} degrees of freedom", fitted, fitted - 1);
    } else {
      result.how = fitted < 2
                       ? "all answers together; nothing tells how observers differ"
                       : fmt::format("all answers together, since {} of {} observers have no threshold of their own",
                                     own.size() - fitted, own.size());
    }
    if (result.function)
      for (const std::string& note : result.function->notes)
        fit_.notes.push_back((name.empty() ? "" : name + ": ") + note);
    fit_.thresholds.push_back(std::move(result));
    return {};
  }

  Result<> pool() {
    std::ranges::sort(fit_.thresholds, {}, &ThresholdFit::size);
    if (!fit_.is_fraction) return {};
    std::vector<WeberFraction> fractions;
    for (const ThresholdFit& each : fit_.thresholds)
      fractions.push_back({each.size, each.all.value, each.all.interval});
    if (fractions.size() == 1) {
      fit_.weber =
          WeberRange{.fraction = fractions[0].fraction, .low = fractions[0].standard, .high = fractions[0].standard};
      return {};
    }
    const auto pooled = pool_fractions(fractions);
    if (!pooled) return pooled.error();
    fit_.weber = *pooled;
    if (!pooled->note.empty()) fit_.notes.push_back(pooled->note);
    return {};
  }

  const Study& study_;
  const FitRequest& request_;
  TrialColumns columns_;
  StudyFit& fit_;
  bool with_criterion_ = false, is_ratio_ = false;
  const SizeValues* over_ = nullptr;
  std::vector<const SizeValues*> others_;
  std::optional<double> standard_;
  std::map<std::string, Answered> noises_;
  Answered all_noises_;
  std::map<std::string, About> abouts_;
};

}  // namespace

Result<> fit_thresholds(const Study& study, const FitRequest& request, const TrialColumns& columns, StudyFit& fit) {
  return ThresholdAnalyst(study, request, columns, fit).analyse();
}

}  // namespace wale
