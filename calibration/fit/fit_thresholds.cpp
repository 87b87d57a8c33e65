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
    decision_ = fit_.task == "two_interval"   ? Decision::interval_choice
                : fit_.task == "one_interval" ? Decision::yes_no
                                              : Decision::same_different_difference;
    TrialColumns signals = columns_;
    if (with_criterion_) signals.keep.push_back({"target", "1", true});
    auto trials = read_trials(study_.tables, signals);
    if (!trials) return trials.error();
    fit_.trials = *std::move(trials);
    if (with_criterion_)
      if (const auto done = read_noises(); !done) return done;
    if (const auto done = find_over(); !done) return done;
    if (const auto done = find_standards(); !done) return done;
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
    fit_.catch_trials = trials->size();
    fit_.trials.simulated |= trials->simulated, fit_.trials.ungraded |= trials->ungraded;
    fit_.notes.push_back(fmt::format("{} trials with nothing to find give how often people say that there is something",
                                     trials->size()));
    state_exclusions(*trials);
    return {};
  }

  /// Rows that are read as trials of one kind are excluded as the other kind, and are no exclusions of the study.
  void state_exclusions(const Trials& noises) {
    // The selection by target is the one behind those of the request, for signals and noises alike.
    const auto is_by_target = [&](const Exclusion& each) { return each.selection == columns_.keep.size(); };
    std::set<std::pair<std::size_t, std::size_t>> by_target;
    for (const Exclusion& each : fit_.trials.exclusions)
      if (is_by_target(each)) by_target.insert({each.file, each.line});
    std::vector<std::pair<Exclusion, std::string>> all;
    for (const Exclusion& each : fit_.trials.exclusions)
      if (!is_by_target(each)) all.emplace_back(each, fit_.trials.rules[each.rule]);
    for (const Exclusion& each : noises.exclusions) {
      if (!is_by_target(each))
        all.emplace_back(each, noises.rules[each.rule]);
      else if (by_target.contains({each.file, each.line}))
        all.emplace_back(each, "only rows whose target is 0 or 1");
    }
    std::ranges::stable_sort(all, {}, [](const auto& each) { return std::pair(each.first.file, each.first.line); });
    fit_.trials.exclusions.clear(), fit_.trials.rules.clear();
    std::set<std::pair<std::size_t, std::size_t>> stated;
    for (auto& [each, rule] : all) {
      if (!stated.insert({each.file, each.line}).second) continue;  // by a rule of the request, of both kinds
      auto at = std::ranges::find(fit_.trials.rules, rule);
      if (at == fit_.trials.rules.end()) at = fit_.trials.rules.insert(at, rule);
      each.rule = static_cast<std::size_t>(at - fit_.trials.rules.begin());
      fit_.trials.exclusions.push_back(each);
    }
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
    is_ratio_ = !request_.standard && over_->unit.empty() && low > 1 && stated_standards().empty();
    return {};
  }

  /// What the tables' own column says of each trial's standard; empty if it does not say it of all of them.
  std::vector<double> stated_standards() const {
    const Trials& trials = fit_.trials;
    std::map<std::pair<std::size_t, std::size_t>, double> of_lines;
    for (std::size_t file = 0; file < study_.tables.size(); ++file) {
      const Table& table = study_.tables[file];
      const auto column = table.column("standard");
      if (!column) return {};
      for (std::size_t row = 0; row < table.rows(); ++row)
        if (const auto value = standard_in_cell(table.cell(row, *column), over_->name, over_->unit))
          of_lines[{file, table.line(row)}] = *value;
    }
    std::vector<double> standards;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      const auto found = of_lines.find({trials.file[i], trials.line[i]});
      if (found == of_lines.end()) return {};
      standards.push_back(found->second);
    }
    return standards;
  }

  /// What each trial's size is compared with.
  Result<> find_standards() {
    const Trials& trials = fit_.trials;
    std::vector<double> stated = stated_standards();
    if (request_.standard) {
      const auto differs = std::ranges::find_if(stated, [&](double each) { return each != *request_.standard; });
      if (differs != stated.end())
        fit_.notes.push_back(fmt::format("the column `standard` says {}, and --standard {}: the latter was taken",
                                         rounded(*differs), rounded(*request_.standard)));
      standards_.assign(trials.size(), *request_.standard);
    } else if (is_ratio_) {
      standards_.assign(trials.size(), 1);
    } else if (!stated.empty()) {
      standards_ = std::move(stated);
    } else {
      return problem(fmt::format("nothing says which {} the others are compared with", visible_text(over_->name)),
                     "give it with --standard; 0 if it was told from nothing");
    }
    const auto [least, most] = std::ranges::minmax(standards_);
    if (!(least >= 0)) return problem("a standard is 0 or more", "give another --standard");
    if (least == 0 && most > 0)
      return problem("some trials have a standard and others are told from nothing", "analyse each kind alone, by --keep");
    fit_.is_fraction = least > 0;
    if (fit_.is_fraction && !is_ratio_) fit_.least_standard = least;
    const std::string which = is_ratio_       ? ""
                              : least == most ? ", " + rounded(least) + " " + over_->unit
                                              : fmt::format(", {} to {} {}", rounded(least), rounded(most), over_->unit);
    fit_.notes.push_back(fit_.is_fraction ? fmt::format("thresholds are fractions of the standard{}, at d' = 1", which)
                                          : fmt::format("thresholds are sizes that are told from nothing, at d' = 1"));
    for (std::size_t i = 0; i < trials.size(); ++i)
      if (!(over_->values[i] > standards_[i]))
        return Error{.code = Code::malformed_value,
                     .sentence = fmt::format("the {} is {}, not above the standard, {}", visible_text(over_->name),
                                             rounded(over_->values[i]), rounded(standards_[i])),
                     .mend = "leave such rows out by rule, as with --drop; thresholds are fitted to one side",
                     .place = trials.place(i)};
    return {};
  }

  void collect() {
    const Trials& trials = fit_.trials;
    const auto [least, most] = std::ranges::minmax(standards_);
    for (std::size_t i = 0; i < trials.size(); ++i) {
      std::string name;
      if (least < most)
        name = fmt::format("standard {}{}{}", rounded(standards_[i]), over_->unit.empty() ? "" : " ", over_->unit);
      for (const SizeValues* each : others_)
        name += fmt::format("{}{} {}{}{}", name.empty() ? "" : ", ", each->name, rounded(each->values[i]),
                            each->unit.empty() ? "" : " ", each->unit);
      for (const FactorValues& each : trials.factors)
        name += fmt::format("{}{} {}", name.empty() ? "" : ", ", each.name, each.levels[each.values[i]]);
      About& about = abouts_[name];
      about.size = is_ratio_ && others_.size() == 1 ? others_.front()->values[i] : is_ratio_ ? 0 : standards_[i];
      const double difference = standards_[i] > 0 ? over_->values[i] / standards_[i] - 1 : over_->values[i];
      Level& level = about.levels[difference][trials.observer[i]];
      level.size = difference;
      ++level.trials;
      if (trials.answer[i] == 1) ++level.right;
    }
  }

  /// d' of all answers to each difference, for the reader: with the rates of single levels, which the fit does not use.
  std::vector<std::pair<double, Sensitivity>> sensitivities_of(const std::vector<Level>& levels) const {
    std::vector<std::pair<double, Sensitivity>> known;
    for (const Level& each : levels) {
      Answered answered = all_noises_;
      answered.hits = each.right, answered.signals = each.trials;
      if (const auto d = sensitivity_of(decision_, answered)) known.emplace_back(each.size, *d);
    }
    return known;
  }

  Result<> fit_one(const std::string& name, const About& about) {
    ThresholdFit result{.standard = name, .size = about.size};
    std::map<std::uint32_t, ObserverAnswers> own;
    for (const auto& [difference, observers] : about.levels) {
      Level all{.size = difference};
      for (const auto& [observer, level] : observers) {
        all.right += level.right, all.trials += level.trials;
        own[observer].levels.push_back(level);
      }
      result.levels.push_back(all);
    }
    std::vector<ObserverAnswers> answers;
    for (auto& [observer, each] : own) {
      if (const auto noises = noises_.find(fit_.trials.observers[observer]); noises != noises_.end())
        each.false_alarms = noises->second.false_alarms, each.noises = noises->second.noises;
      answers.push_back(std::move(each));
    }
    const SensitivityOptions options{.decision = decision_};
    const auto fit = fit_sensitivity(answers, options);
    std::size_t at = 0;
    std::vector<std::string> without;
    for (const auto& [observer, each] : own) {
      const std::string& who = fit_.trials.observers[observer];
      ObserverThreshold threshold{who, 0, {}, fit ? "" : "the answers of no observer give a threshold of their own"};
      if (fit) {
        const ObserverSensitivity& found = fit->observers[at++];
        if (found.refused)
          threshold.refused = found.refused->sentence, without.push_back(visible_text(who));
        else
          threshold.value = found.law.threshold, threshold.interval = found.interval;
      }
      result.observers.push_back(std::move(threshold));
    }
    const std::string of = name.empty() ? "" : name + ": ";
    // A mean of the fewer would speak of those who happened to fit.
    if (fit && fit->mean && 2 * without.size() <= own.size()) {
      result.law = {decision_, fit->mean->threshold, fit->exponent, fit->lapse, 0};
      result.all = {"all", fit->mean->threshold, fit->mean->interval, {}};
      result.count = fit->mean->observers;
      result.how = fmt::format("geometric mean of the population of {} observers, profile likelihood as t on {} degrees of "
                               "freedom", fit->mean->observers, fit->mean->observers - 1);
      if (!without.empty()) {
        std::string names;
        for (std::size_t i = 0; i < without.size() && i < 5; ++i) names += (i == 0 ? "" : ", ") + without[i];
        if (without.size() > 5) names += fmt::format(" and {} more", without.size() - 5);
        result.how += fmt::format("; {} of {} observers {} left out", without.size(), own.size(),
                                  without.size() == 1 ? "is" : "are");
        fit_.notes.push_back(fmt::format(
            "{}{} {} no threshold of their own, by the rule that a threshold needs answers that depend on the size "
            "beyond chance (likelihood ratio 3.84) and bound it: the mean and its interval speak of the other {}",
            of, names, without.size() == 1 ? "has" : "have", fit->mean->observers));
      }
    } else if (fit && own.size() == 1) {
      const ObserverSensitivity& only = fit->observers.front();
      result.law = only.law;
      result.all = {"all", only.law.threshold, only.interval, {}};
      result.count = 1;
      result.how = "one observer; nothing tells how observers differ";
    } else {
      const auto together =
          own.size() > 1 ? fit_sensitivity_together(answers, options) : Result<ObserverSensitivity>(fit.error());
      if (!together) {
        Error error = together.error();
        if (own.size() > 1) error.sentence = of + error.sentence;
        if (error.place.name.empty()) error.place.name = study_.files.front().path;
        return error;
      }
      result.law = together->law;
      result.all = {"all", together->law.threshold, together->interval, {}};
      result.count = own.size();
      result.how = fmt::format(
          "all answers together, since {} of {} observers have a threshold of their own; the interval leaves out one "
          "observer at a time, t on {} degrees of freedom",
          fit ? own.size() - without.size() : 0, own.size(), own.size() - 1);
    }
    if (fit && fit->exponent_is_held)
      fit_.notes.push_back(of + "each observer felt one size, so d' is taken to be in proportion to it");
    if (with_criterion_) result.sensitivities = sensitivities_of(result.levels);
    const auto [low, high] = std::ranges::minmax(result.levels, {}, &Level::size);
    const bool is_outside = result.all.value < low.size || result.all.value > high.size;
    if (is_outside) fit_.notes.push_back(of + "the threshold lies outside of the sizes that were presented");
    if (!(result.all.interval.low > 0) || !std::isfinite(result.all.interval.high)) {
      const std::string why = of + "the answers do not bound the threshold on both sides";
      fit_.notes.push_back(why + ": more people would, or more answers of each");
      if (fit_.no_record.empty()) fit_.no_record = why;
    }
    if (!(fit && fit->exponent_is_held) && (result.law.exponent > 9.5 || result.law.exponent < 0.21))
      fit_.notes.push_back(of + "the exponent is at the end of its range, 0.2 to 10: the answers do not tell it");
    if (result.law.lapse > 0.098) {
      fit_.notes.push_back(of + "the lapse rate is at its upper limit: people may not have done the task");
      // Either alone may be: small thresholds are told from steep ends, and some people do not attend. Both together are
      // answers that hardly depend on the size.
      if (is_outside && fit_.no_record.empty())
        fit_.no_record = of + "the threshold lies outside of the sizes that were presented, with the lapse rate at its upper limit";
    }
    fit_.thresholds.push_back(std::move(result));
    return {};
  }

  Result<> pool() {
    std::ranges::sort(fit_.thresholds, {}, &ThresholdFit::size);
    if (!fit_.is_fraction || !fit_.no_record.empty()) return {};
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
  Decision decision_ = Decision::interval_choice;
  std::vector<double> standards_;  ///< of the trials; 1 for ratios, 0 for what is told from nothing
  std::map<std::string, Answered> noises_;
  Answered all_noises_;
  std::map<std::string, About> abouts_;
};

}  // namespace

std::optional<double> standard_in_cell(std::string_view cell, const std::string& argument, const std::string& unit) {
  if (const auto named = standard_in_name(cell, argument, unit)) return named;
  const auto space = cell.find(' ');
  if (space != std::string_view::npos && cell.substr(space + 1) != unit) return std::nullopt;
  return number_in(cell.substr(0, space));
}

Result<> fit_thresholds(const Study& study, const FitRequest& request, const TrialColumns& columns, StudyFit& fit) {
  return ThresholdAnalyst(study, request, columns, fit).analyse();
}

}  // namespace wale
