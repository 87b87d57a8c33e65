#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "calibration/fit/study_fit.hpp"
#include "compiler/text/readable.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

using namespace analysis;
using Json = nlohmann::ordered_json;

std::string interval_text(const Coefficient& each) {
  if (!std::isfinite(each.low()) || !std::isfinite(each.high()))
    return readable("{:.4g}, not bounded: too few answers tell its error", each.value);
  return readable("{:.4g}, 95 % {:.4g} to {:.4g} (s.e. {:.3g}, {:.4g} degrees of freedom)", each.value, each.low(),
                  each.high(), each.error, each.freedom);
}

std::string model_words(FitModel model) {
  if (model == FitModel::mixed)
    return "linear mixed model of log10 answers, restricted maximum likelihood, Satterthwaite";
  return model == FitModel::thesis ? "means of log10 answers, least squares (Minsky 1995, section 5.3)"
                                   : "equalised means of log10 answers, least squares (Minsky 1995, section 5.3)";
}

void add_magnitudes(std::string& text, const MagnitudeAnalysis& analysis, FitModel model) {
  const auto line = [&](const char* name, const std::string& value) {
    text += fmt::format("  {:<14} {}\n", name, value);
  };
  const ChosenLaw law = chosen_law(analysis, model);
  line("model", model_words(model));
  line("exponent", interval_text(law.exponent));
  line("constant", fmt::format("{}, at 1 {}", interval_text(law.constant), visible_text(analysis.unit)));
  if (model != FitModel::mixed)
    line("mixed model", "exponent " + interval_text(analysis.exponent));
  else
    line("thesis's way", "exponent " + interval_text(analysis.thesis.regression.coefficients[1]));
  line("spread", analysis.spread > 0 ? readable("{:.3g} of the observers' exponents", analysis.spread) +
                                           (analysis.spread_interval
                                                ? readable(", 95 % {:.3g} to {:.3g}", analysis.spread_interval->low,
                                                           analysis.spread_interval->high)
                                                : "")
                                     : "none found of the observers' exponents");
  line("noise", readable("{:.3g} of log10 of single answers", analysis.noise) +
                    (analysis.noise_interval ? readable(", 95 % {:.3g} to {:.3g}", analysis.noise_interval->low,
                                                        analysis.noise_interval->high)
                                             : ""));
  line("scatter",
       readable("{:.3g} of the means of {} stimuli about the law", analysis.scatter, analysis.thesis.means.size()));
  line("numbers", readable("the observers' use of numbers differs by {:.3g} of log10, which is no feeling",
                           analysis.use_of_numbers));
  line("range", readable("{:.4g} to {:.4g} {}", analysis.low, analysis.high, visible_text(analysis.unit)));
  if (analysis.model.singular || !analysis.model.simplified.empty())
    line("singular", "the full model has a variance of zero; a simpler one was taken, see below");
  if (!analysis.alternatives.empty()) text += "  alternatives, by maximum likelihood, against the law:\n";
  for (const Alternative& each : analysis.alternatives)
    text += each.refused.empty() ? readable("    {:<44} chi-squared {:.3g} on {}, p = {:.3g}, AIC lower by {:.3g}\n",
                                            visible_text(each.name), each.comparison.chi_squared,
                                            each.comparison.freedom, each.comparison.p, each.akaike_gain)
                                 : fmt::format("    {:<44} not fitted: {}\n", visible_text(each.name), each.refused);
  if (analysis.lack_of_fit)
    line("fit", readable("any means of the stimuli against the law: chi-squared {:.3g} on {}, p = {:.3g}",
                         analysis.lack_of_fit->chi_squared, analysis.lack_of_fit->freedom, analysis.lack_of_fit->p));
  text += "  observers:\n";
  for (const ObserverLaw& each : analysis.observers)
    text += fmt::format("    {:<20} {}{}, {}\n", visible_text(each.observer),
                        std::isfinite(each.exponent) ? readable("exponent {:.3g}", each.exponent)
                                                     : std::string("no exponent: answers about one size"),
                        std::isfinite(each.error) ? readable(" (s.e. {:.2g})", each.error) : std::string(),
                        readable("{} answer{}", each.answers, each.answers == 1 ? "" : "s"));
}

std::string threshold_text(const ObserverThreshold& each) {
  if (!each.refused.empty()) return "none: " + each.refused;
  if (!(each.interval.low > 0) && !std::isfinite(each.interval.high))
    return readable("{:.4g}, not bounded by the answers", each.value);
  if (!(each.interval.low > 0)) return readable("{:.4g}, 95 % below {:.4g}", each.value, each.interval.high);
  if (!std::isfinite(each.interval.high)) return readable("{:.4g}, 95 % above {:.4g}", each.value, each.interval.low);
  return readable("{:.4g}, 95 % {:.4g} to {:.4g}", each.value, each.interval.low, each.interval.high);
}

void add_thresholds(std::string& text, const StudyFit& fit) {
  text += fmt::format("  {:<14} {}\n", "model",
                      fit.task == "two_interval"
                          ? "d' = (difference / threshold) ^ exponent of two intervals, maximum likelihood"
                          : fit.task == "one_interval"
                                ? "d' = (difference / threshold) ^ exponent with a criterion, maximum likelihood"
                                : "d' = (difference / threshold) ^ exponent of a difference beyond a criterion, maximum "
                                  "likelihood");
  for (const ThresholdFit& each : fit.thresholds) {
    text += fmt::format("  {:<14} {}; {}\n", each.standard.empty() ? "threshold" : visible_text(each.standard),
                        threshold_text(each.all), each.how);
    text += readable("    of the curve without lapses; {}: exponent {:.3g}, lapse rate {:.2g} (of 0 to 0.1); {} sizes\n",
                     each.observers.size() == 1 ? "the observer's" : "common to the observers", each.law.exponent,
                     each.law.lapse, each.levels.size());
    for (const ObserverThreshold& own : each.observers)
      text += fmt::format("    {:<20} {}\n", visible_text(own.observer), threshold_text(own));
  }
  if (fit.weber && fit.thresholds.size() > 1)
    text += readable("  {:<14} {:.4g} from {:.4g} to {:.4g}, equality chi-squared {:.3g}, p = {:.3g}\n", "fraction",
                     fit.weber->fraction, fit.weber->low, fit.weber->high, fit.weber->chi_squared, fit.weber->p);
}

void add_confidence(std::string& text, const ConfidenceAnalysis& analysis) {
  text += fmt::format("  {:<14} ratings from 0 to 100, linear in the sizes; mean of the observers' own regressions; ± is one "
                      "standard deviation of single ratings\n",
                      "model");
  text += readable(
      "  {:<14} {:.3g}, standard deviation {:.3g}; {:.3g} % of ratings at least 80, {:.3g} % of stimuli above 80\n",
      "ratings", analysis.mean, analysis.deviation, 100 * analysis.at_least_80, 100 * analysis.above_80);
  if (analysis.between_runs)
    text += readable("  {:<14} r = {:.3g}, 95 % {:.3g} to {:.3g}, {} pairs\n", "between runs", analysis.between_runs->r,
                     analysis.between_runs->low, analysis.between_runs->high, analysis.between_runs->pairs);
  if (analysis.regression)
    for (const Coefficient& each : analysis.regression->coefficients)
      text += fmt::format("  {:<14} {}{}\n", each.name, interval_text(each),
                          each.name == "constant" ? ", in points of the rating" : ", points for each 1 of its unit");
  if (!analysis.regression_refused.empty()) text += "  no regression: " + analysis.regression_refused + "\n";
  for (const RatedStimulus& each : analysis.stimuli)
    text += readable("    {:<32} {:.3g} ± {:.3g}, {} ratings\n", visible_text(each.name), each.mean, each.deviation,
                     each.ratings);
}

void add_sorting(std::string& text, const SortingFit& sorting) {
  text += fmt::format("  {:<14} single linkage of the times that two were apart, as the thesis has it\n", "model");
  text += readable("  {:<14} {} sorts of {} stimuli; {} groups; mean adjusted Rand index {:.3g}\n", "sorts",
                   sorting.groupings.size(), sorting.stimuli.size(), sorting.groups, sorting.agreement);
  for (std::size_t group = 0; group < sorting.groups; ++group) {
    text += fmt::format("    group {}:", group + 1);
    for (std::size_t i = 0; i < sorting.stimuli.size(); ++i)
      if (sorting.clusters[i] == group) text += " " + visible_text(sorting.stimuli[i]);
    text += "\n";
  }
  for (const GroupsFit& each : sorting.by_groups) {
    std::map<std::size_t, std::size_t> counts;
    for (const std::size_t distance : each.distances) ++counts[distance];
    std::string told;
    for (const auto& [distance, count] : counts)
      told += readable("{}{} sort{} {} away", told.empty() ? "" : ", ", count, count == 1 ? "" : "s", distance);
    text += readable("  {:<14} of the sorts into {}: {}\n", readable("{} groups", each.groups), each.groups, told);
    for (std::size_t group = 0; group < each.groups; ++group) {
      text += fmt::format("    group {}:", group + 1);
      for (std::size_t i = 0; i < sorting.stimuli.size(); ++i)
        if (each.clusters[i] == group) text += " " + visible_text(sorting.stimuli[i]);
      text += "\n";
    }
  }
  if (sorting.map)
    text += readable("  {:<14} ordinal scaling in two dimensions, stress-1 {:.3g}; {} of {} starts end there\n", "map",
                     sorting.map->stress, sorting.map->near_best, sorting.map->starts);
  else
    text += fmt::format("  {:<14} none: {}\n", "map", sorting.map_refused);
  for (const auto& [name, merges] : {std::pair("average", &sorting.average), std::pair("complete", &sorting.complete)})
    text += fmt::format("  {:<14} {}\n", name,
                        adjusted_rand_index(cut(*merges, sorting.groups), sorting.clusters) == 1
                            ? "linkage gives the same groups"
                            : "linkage gives other groups");
}

std::string interval_words(const Interval& each) {
  if (!(each.low > 0) && !std::isfinite(each.high)) return "not bounded by the answers";
  return readable("95 % {:.4g} to {:.4g}", each.low, each.high);
}

void add_settings(std::string& text, const StudyFit& fit) {
  text += fmt::format("  {:<14} geometric means of settings of {}{}; Student's t over observers\n", "model",
                      visible_text(fit.over), fit.over_unit.empty() ? "" : ", " + visible_text(fit.over_unit));
  for (const SettingsFit& each : fit.settings) {
    const Settings& settings = each.settings;
    text += fmt::format("  {:<14} {}, {}, like {}{}\n", "equal",  readable("{:.4g}", settings.equal),
                        interval_words(settings.equal_interval),
                        each.standard.empty() ? "the standard" : visible_text(each.standard),
                        each.size && *each.size > 0
                            ? readable(": {:+.3g} % from it", 100 * (settings.equal / *each.size - 1))
                            : std::string());
    for (const ObserverSettings& own : settings.observers)
      text += readable("    {:<20} {:.4g}, {} setting{}\n", visible_text(own.observer), own.equal, own.settings.size(),
                       own.settings.size() == 1 ? "" : "s");
  }
  if (fit.settings_scatter)
    text += readable("  {:<14} {:.4g} of the natural logarithm of one observer's settings, 95 % {:.4g} to {:.4g}\n", "scatter",
                     *fit.settings_scatter, fit.settings_interval.low, fit.settings_interval.high);
}

std::string counted(const std::map<std::string, std::size_t>& counts, std::size_t most) {
  std::string text;
  const auto sorted = by_frequency(counts);
  for (std::size_t i = 0; i < std::min(most, sorted.size()); ++i)
    text += readable("{}{} {}", i == 0 ? "" : ", ", visible_text(sorted[i].first), sorted[i].second);
  if (sorted.size() > most) text += readable(" and {} more", sorted.size() - most);
  return text.empty() ? "none" : text;
}

void add_descriptions(std::string& text, const DescriptionFit& described) {
  text += fmt::format("  {:<14} in how many descriptions a word is\n", "model");
  for (std::size_t i = 0; i < described.stimuli.size(); ++i) {
    const DescribedStimulus& each = described.stimuli[i];
    text += readable("    {:<32} {} description{}; {}\n", visible_text(described.names[i]), each.descriptions,
                     each.descriptions == 1 ? "" : "s", described.is_coded ? counted(each.codes, 8) : counted(each.words, 8));
  }
  text += fmt::format("  {:<14} {}\n", described.is_coded ? "codes" : "words",
                      counted(described.is_coded ? described.all.codes : described.all.words, 12));
  if (described.is_coded) text += fmt::format("  {:<14} {}\n", "without a code", counted(described.all.words, 12));
}

Json json_of(const Coefficient& each) {
  return {{"value", each.value},
          {"error", each.error},
          {"freedom", each.freedom},
          {"low", each.low()},
          {"high", each.high()}};
}
Json json_of(const Interval& each) {
  const auto end = [](double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); };
  return Json::array({end(each.low), end(each.high)});
}
Json json_of(const ObserverThreshold& each) {
  if (!each.refused.empty()) return {{"observer", each.observer}, {"refused", each.refused}};
  return {{"observer", each.observer}, {"value", each.value}, {"interval", json_of(each.interval)}};
}

Json json_of(const MagnitudeAnalysis& analysis, FitModel model) {
  const ChosenLaw law = chosen_law(analysis, model);
  Json json = {{"model", fit_model_name(model)},
               {"size", analysis.size},
               {"unit", analysis.unit},
               {"exponent", json_of(law.exponent)},
               {"constant", json_of(law.constant)},
               {"mixed_exponent", json_of(analysis.exponent)},
               {"thesis_exponent", json_of(analysis.thesis.regression.coefficients[1])},
               {"spread", analysis.spread},
               {"spread_interval", analysis.spread_interval ? json_of(*analysis.spread_interval) : Json(nullptr)},
               {"noise", analysis.noise},
               {"scatter", analysis.scatter},
               {"use_of_numbers", analysis.use_of_numbers},
               {"valid", Json::array({analysis.low, analysis.high})},
               {"singular", analysis.model.singular},
               {"simplified", analysis.model.simplified}};
  json["alternatives"] = Json::array();
  for (const Alternative& each : analysis.alternatives) {
    Json one = {{"name", each.name}};
    if (!each.refused.empty())
      one["refused"] = each.refused;
    else
      one.update({{"chi_squared", each.comparison.chi_squared},
                  {"freedom", each.comparison.freedom},
                  {"p", each.comparison.p},
                  {"aic_gain", each.akaike_gain}});
    json["alternatives"].push_back(std::move(one));
  }
  json["observers"] = Json::array();
  for (const ObserverLaw& each : analysis.observers)
    json["observers"].push_back({{"observer", each.observer},
                                 {"exponent", std::isfinite(each.exponent) ? Json(each.exponent) : Json(nullptr)},
                                 {"answers", each.answers}});
  return json;
}

}  // namespace

std::string fit_text(const Study& study, const StudyFit& fit, const FitRequest& request) {
  std::string text =
      readable("{}: {}, {} trials of {} observer{} in {} file{}\n",
               study.experiment.empty() ? "study" : visible_text(study.experiment), fit.task, fit.trials.size(),
               fit.trials.observers.size(), fit.trials.observers.size() == 1 ? "" : "s", study.files.size(), study.files.size() == 1 ? "" : "s");
  if (fit.magnitudes) add_magnitudes(text, *fit.magnitudes, request.model);
  if (!fit.thresholds.empty()) add_thresholds(text, fit);
  if (fit.confidence) add_confidence(text, *fit.confidence);
  if (fit.sorting) add_sorting(text, *fit.sorting);
  if (!fit.settings.empty()) add_settings(text, fit);
  if (fit.descriptions) add_descriptions(text, *fit.descriptions);
  text += fmt::format("  {:<14} {}: {}\n", "evidence", fit.evidence, fit.evidence_reason);
  text += readable("  {:<14} {} rows\n", "excluded", fit.trials.exclusions.size());
  for (std::size_t rule = 0; rule < fit.trials.rules.size(); ++rule) {
    const auto of_rule = [&](const Exclusion& each) { return each.rule == rule; };
    const auto first = std::ranges::find_if(fit.trials.exclusions, of_rule);
    text +=
        readable("    {} by the rule: {}; the first is {}:{}\n", std::ranges::count_if(fit.trials.exclusions, of_rule),
                 visible_text(fit.trials.rules[rule]), visible_text(fit.trials.files[first->file]), first->line);
  }
  std::vector<std::string> notes = fit.notes;
  if (fit.magnitudes) notes.insert(notes.end(), fit.magnitudes->notes.begin(), fit.magnitudes->notes.end());
  if (fit.confidence) notes.insert(notes.end(), fit.confidence->notes.begin(), fit.confidence->notes.end());
  for (const std::string& note : notes) text += "  note: " + note + "\n";
  return text;
}

std::string fit_json(const Study& study, const StudyFit& fit, const FitRequest& request, const std::string& record) {
  Json json = {
      {"experiment", study.experiment}, {"task", fit.task},
      {"trials", fit.trials.size()},    {"observers", fit.trials.observers.size()},
      {"evidence", fit.evidence},       {"device", fit.trials.device.empty() ? study.device : fit.trials.device}};
  json["files"] = Json::array();
  for (const StudyFile& each : study.files)
    json["files"].push_back({{"path", each.path}, {"form", each.form}, {"hash", fmt::format("{:016x}", each.hash)}});
  if (fit.magnitudes) json["magnitudes"] = json_of(*fit.magnitudes, request.model);
  for (const ThresholdFit& each : fit.thresholds) {
    Json one = {{"standard", each.standard}, {"threshold", json_of(each.all)}, {"how", each.how},
                {"exponent", each.law.exponent},  {"lapse", each.law.lapse}};
    for (const ObserverThreshold& own : each.observers) one["observers"].push_back(json_of(own));
    json["thresholds"].push_back(std::move(one));
  }
  if (fit.weber)
    json["weber"] = {{"fraction", fit.weber->fraction}, {"low", fit.weber->low}, {"high", fit.weber->high}};
  if (fit.confidence) {
    json["confidence"] = {
        {"mean", fit.confidence->mean},
        {"deviation", fit.confidence->deviation},
        {"between_runs", fit.confidence->between_runs ? Json(fit.confidence->between_runs->r) : Json(nullptr)}};
    for (const RatedStimulus& each : fit.confidence->stimuli)
      json["confidence"]["stimuli"].push_back({{"name", each.name}, {"mean", each.mean}, {"ratings", each.ratings}});
  }
  if (fit.sorting) {
    json["sorting"] = {{"groups", fit.sorting->groups},
                       {"sorts", fit.sorting->groupings.size()},
                       {"agreement", fit.sorting->agreement},
                       {"clusters", Json::object()}};
    for (std::size_t i = 0; i < fit.sorting->stimuli.size(); ++i)
      json["sorting"]["clusters"][fit.sorting->stimuli[i]] = fit.sorting->clusters[i] + 1;
  }
  if (fit.sorting) {
    for (const GroupsFit& each : fit.sorting->by_groups) {
      Json one = {{"groups", each.groups}, {"sorts", each.sorts}, {"distances", each.distances}, {"clusters", Json::object()}};
      for (std::size_t i = 0; i < fit.sorting->stimuli.size(); ++i)
        one["clusters"][fit.sorting->stimuli[i]] = each.clusters[i] + 1;
      json["sorting"]["by_groups"].push_back(std::move(one));
    }
    json["sorting"]["stress"] = fit.sorting->map ? Json(fit.sorting->map->stress) : Json(nullptr);
    json["sorting"]["map"] = Json::object();
    if (fit.sorting->map)
      for (std::size_t i = 0; i < fit.sorting->stimuli.size(); ++i)
        json["sorting"]["map"][fit.sorting->stimuli[i]] = {fit.sorting->map->points(static_cast<Eigen::Index>(i), 0),
                                                           fit.sorting->map->points(static_cast<Eigen::Index>(i), 1)};
  }
  for (const SettingsFit& each : fit.settings) {
    Json one = {{"standard", each.standard},
                {"size", each.size ? Json(*each.size) : Json(nullptr)},
                {"equal", each.settings.equal},
                {"interval", json_of(each.settings.equal_interval)},
                {"scatter", each.settings.scatter ? Json(*each.settings.scatter) : Json(nullptr)}};
    for (const ObserverSettings& own : each.settings.observers)
      one["observers"].push_back({{"observer", own.observer}, {"equal", own.equal}, {"settings", own.settings}});
    json["settings"].push_back(std::move(one));
  }
  if (fit.settings_scatter)
    json["scatter"] = {{"value", *fit.settings_scatter}, {"interval", json_of(fit.settings_interval)}};
  if (fit.descriptions)
    for (std::size_t i = 0; i < fit.descriptions->stimuli.size(); ++i) {
      const DescribedStimulus& each = fit.descriptions->stimuli[i];
      json["descriptions"].push_back({{"stimulus", fit.descriptions->names[i]},
                                      {"descriptions", each.descriptions},
                                      {"words", each.words},
                                      {"codes", each.codes}});
    }
  json["exclusions"] = Json::array();
  for (const Exclusion& each : fit.trials.exclusions)
    json["exclusions"].push_back(
        {{"file", fit.trials.files[each.file]}, {"row", each.line}, {"rule", fit.trials.rules[each.rule]}});
  json["notes"] = fit.notes;
  if (fit.magnitudes)
    for (const std::string& note : fit.magnitudes->notes) json["notes"].push_back(note);
  json["record"] = fit.no_record.empty() ? Json(record) : Json(nullptr);
  if (!fit.no_record.empty()) json["no_record"] = fit.no_record;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace wale
