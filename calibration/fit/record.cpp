#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "calibration/fit/study_fit.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

using namespace analysis;

/// The share of right answers at d' = 1: of two intervals, and of one.
constexpr double criterion_of_two = 76.0250, criterion_of_one = 69.1462;  // %

/// Text in a string of Wale, on one line.
std::string in_quotes(std::string_view text) {
  std::string safe = "\"";
  for (const char c : visible_text(text)) safe += c == '"' || c == '\\' ? '\'' : c;
  return safe + '"';
}

bool is_identifier(std::string_view text) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  return !text.empty() && letter(text.front()) &&
         std::ranges::all_of(text, [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

std::string identifier_of(std::string_view text, const char* otherwise) {
  std::string name;
  for (const char c : text) name += is_identifier(std::string("a") + c) ? c : '_';
  if (!name.empty() && name.front() >= '0' && name.front() <= '9') name.insert(0, "x");
  return name.empty() ? otherwise : name;
}

std::string number(double value) { return fmt::format("{:.6g}", value); }
std::string quantity(double value, const std::string& unit) {
  return unit.empty() ? number(value) : number(value) + " " + unit;
}
std::string range(double low, double high, const std::string& unit) {
  return quantity(low, unit) + " .. " + quantity(high, unit);
}

/// The ends of an interval in a comment, which has no infinite numbers.
std::string bounds_of(const Interval& interval) {
  const bool is_low = interval.low > 0, is_high = std::isfinite(interval.high);
  if (!is_low && !is_high) return "not bounded by the answers";
  if (!is_low) return fmt::format("95 % below {:.4g}", interval.high);
  return is_high ? fmt::format("95 % {:.4g} to {:.4g}", interval.low, interval.high)
                 : fmt::format("95 % above {:.4g}", interval.low);
}

/// A unit as Wale writes it: letters, digits, `/`, `^`, spaces and a sign.
bool is_unit(const std::string& unit) {
  return std::ranges::all_of(unit, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '/' || c == '^' ||
           c == ' ' || c == '-';
  });
}

std::string dimension_of(const std::string& unit) {
  static const std::pair<const char*, const char*> known[] = {
      {"", "number"},        {"N", "force"},         {"mN", "force"},
      {"m", "length"},       {"mm", "length"},       {"N/m", "stiffness"},
      {"N/mm", "stiffness"}, {"N s/m", "viscosity"}, {"m/s^2", "acceleration"},
      {"Hz", "frequency"},   {"kg", "mass"},         {"m/s", "velocity"},
      {"s", "time"}};
  for (const auto& [name, dimension] : known)
    if (unit == name) return dimension;
  return {};
}

class RecordWriter {
 public:
  RecordWriter(const Study& study, const StudyFit& fit, const FitRequest& request)
      : study_(study), fit_(fit), request_(request) {}

  Result<std::string> write() {
    for (const SizeValues& each : fit_.trials.sizes) {
      if (!is_unit(each.unit))
        return problem(fmt::format("`{}` is no unit of Wale", visible_text(each.unit)),
                       "name the unit, as in --size amplitude:N");
      if (!is_identifier(each.name))
        return problem(fmt::format("`{}` is no name in Wale", visible_text(each.name)),
                       "give the size a name of letters, as in --size amplitude=COLUMN");
    }
    provenance();
    const Result<> done = fit_.magnitudes ? map() : !fit_.thresholds.empty()  ? threshold()
                          : !fit_.settings.empty() ? adjusted()
                                                   : rule();
    if (!done) return done.error();
    return std::move(text_);
  }

 private:
  Error problem(std::string sentence, std::string mend) const {
    return {.code = Code::malformed_value,
            .sentence = std::move(sentence),
            .mend = std::move(mend),
            .place = {.name = study_.files.front().path}};
  }

  void comment(const std::string& line) {
    std::string rest = visible_text(line);
    while (!rest.empty()) {
      std::size_t end = rest.size();
      if (end > 110) {
        end = rest.rfind(' ', 110);
        if (end == std::string::npos || end == 0) end = rest.find(' ', 110);
        if (end == std::string::npos) end = rest.size();
      }
      text_ += "// " + rest.substr(0, end) + "\n";
      rest.erase(0, std::min(rest.size(), end + 1));
    }
  }

  void setting(const char* name, const std::string& value) { text_ += fmt::format("  {:<11} {}\n", name, value); }

  std::string days() const {
    if (study_.first_day.empty()) return {};
    return study_.first_day == study_.last_day ? study_.first_day : study_.first_day + " to " + study_.last_day;
  }

  std::string name_of_study() const { return study_.experiment.empty() ? "study" : study_.experiment; }

  void provenance() {
    text_ = "wale 1\n\n";
    comment(fmt::format("Fitted by `wale calibrate fit` to {} trials of {} observer{} in the experiment {}, task {}.",
                        fit_.trials.size(), fit_.trials.observers.size(), fit_.trials.observers.size() == 1 ? "" : "s",
                        name_of_study(), fit_.task));
    comment(fmt::format("Data of: {}. Device: {}. Software: {}.", days().empty() ? "an unknown day" : days(),
                        device().empty() ? "not stated" : device(), versions()));
    for (const StudyFile& each : study_.files)
      comment(fmt::format("Trials: {}, {:016x}", each.path.substr(each.path.find_last_of('/') + 1), each.hash));
    std::string programs;
    for (const std::uint64_t each : study_.programs) programs += fmt::format(" {:016x}", each);
    if (!programs.empty()) comment("Programs felt:" + programs);
    for (std::size_t rule = 0; rule < fit_.trials.rules.size(); ++rule)
      comment(fmt::format("Excluded: {} rows, {}", std::ranges::count(fit_.trials.exclusions, rule, &Exclusion::rule),
                          fit_.trials.rules[rule]));
    comment(fmt::format("Evidence: {}, since {}.", fit_.evidence, fit_.evidence_reason));
  }

  std::string versions() const {
    std::string all;
    for (const std::string& each : study_.versions) all += (all.empty() ? "" : ", ") + each;
    return all.empty() ? "not stated" : all;
  }
  std::string device() const { return fit_.trials.device.empty() ? study_.device : fit_.trials.device; }
  std::string on() const { return identifier_of(device(), "unknown_device"); }

  void source() {
    setting("source", in_quotes(fmt::format("{} trials of {}{}", fit_.trials.size(), name_of_study(),
                                            days().empty() ? "" : ", " + days())));
  }

  /// The ranges of sizes besides the first, as conditions.
  std::string conditions(const std::string& but) const {
    std::string text;
    for (const SizeValues& each : fit_.trials.sizes) {
      if (each.name == but) continue;
      const auto [low, high] = std::ranges::minmax(each.values);
      text += fmt::format(", {} {}", each.name, range(low, high, each.unit));
    }
    return text;
  }

  Result<> map() {
    const MagnitudeAnalysis& analysis = *fit_.magnitudes;
    if (analysis.unit.empty())
      return problem(fmt::format("the unit of {} is not known", visible_text(analysis.size)),
                     fmt::format("name it, as in --size {}:N", visible_text(analysis.size)));
    const ChosenLaw law = chosen_law(analysis, request_.model);
    comment(request_.model == FitModel::mixed
                ? fmt::format(
                      "Model: mixed, restricted maximum likelihood; exponent {:.4g}, 95 % {:.4g} to {:.4g} on {:.4g} "
                      "degrees of freedom.",
                      law.exponent.value, law.exponent.low(), law.exponent.high(), law.exponent.freedom)
                : fmt::format(
                      "Model: {}, least squares of the means; exponent {:.4g}, 95 % {:.4g} to {:.4g} on {:.4g} degrees "
                      "of freedom.",
                      fit_model_name(request_.model), law.exponent.value, law.exponent.low(), law.exponent.high(),
                      law.exponent.freedom));
    if (!analysis.region.empty()) {
      std::string corners = "Presented, corners of the convex region:";
      for (const auto& corner : analysis.region)
        corners += fmt::format(" ({}, {})", quantity(corner[0], fit_.trials.sizes[0].unit),
                               quantity(corner[1], fit_.trials.sizes[1].unit));
      comment(corners);
    }
    const std::string carrier = request_.carrier.empty() ? analysis.size : request_.carrier;
    const std::string percept = request_.about.empty() ? "roughness" : request_.about;
    text_ += fmt::format("\n/// {}: magnitude estimates of {} observers.\nexport map {} from {} {{\n", name_of_study(),
                         fit_.trials.observers.size(), percept, carrier);
    setting("name", request_.name.empty()
                        ? fmt::format("{}.{}", identifier_of(name_of_study(), "study"), fit_model_name(request_.model))
                        : request_.name);
    setting("law",
            fmt::format("log10(magnitude) = {} * log10({} / 1 {}) {} {}", number(law.exponent.value), carrier,
                        analysis.unit, law.constant.value < 0 ? "-" : "+", number(std::abs(law.constant.value))));
    setting("valid", fmt::format("{} {}{}", carrier, range(analysis.low, analysis.high, analysis.unit),
                                 conditions(analysis.size)));
    if (!request_.domain.empty()) setting("domain", request_.domain);
    // The means of two stimuli have no scatter about a line.
    setting("scatter", std::isfinite(analysis.scatter) ? number(std::max(analysis.scatter, 1e-6)) : "assumed 0.1");
    if (std::isfinite(law.exponent.error)) setting("slope_error", number(law.exponent.error));
    if (analysis.spread > 0) setting("spread", number(analysis.spread));
    if (analysis.noise > 0) setting("noise", number(analysis.noise));
    setting("observers", std::to_string(fit_.trials.observers.size()));
    setting("stimuli", std::to_string(fit_.trials.stimuli));
    setting("evidence", fmt::format("slope {0}, anchor {0}, handle {0}", fit_.evidence));
    setting("on", on());
    source();
    text_ += "}\n";
    return {};
  }

  Result<> threshold() {
    const std::string dimension = dimension_of(fit_.over_unit);
    const SizeValues* over = fit_.trials.size_named(fit_.over);
    // The ratio of a design is a change of what it refers to.
    const SizeValues* of = over;
    if (over->unit.empty() && fit_.trials.sizes.size() == 2)
      of = &fit_.trials.sizes[&fit_.trials.sizes[0] == over ? 1 : 0];
    const std::string cue = !request_.about.empty() ? request_.about : of->name == "reference" ? "amplitude" : of->name;
    const std::string quantity_name = dimension_of(of->unit);
    if (quantity_name.empty())
      return problem(fmt::format("`{}` is the unit of no quantity of thresholds", visible_text(of->unit)),
                     "convert the sizes to SI");
    for (const ThresholdFit& each : fit_.thresholds)
      comment(fmt::format("{}{:.4g}, {}; {}", each.standard.empty() ? "At d' = 1: " : each.standard + ": ", each.all.value,
                          bounds_of(each.all.interval), each.how));
    text_ += fmt::format("\n/// {}: {} trials of {} observers.\nexport threshold {} {{\n", name_of_study(),
                         fit_.trials.size(), fit_.trials.observers.size(), cue);
    setting("quantity", quantity_name);
    const auto [low, high] = std::ranges::minmax(over->values);
    if (fit_.is_fraction && !fit_.weber) return problem("there is no threshold: " + fit_.no_record, "");
    if (fit_.is_fraction) {
      setting("weber", number(fit_.weber->fraction));
    } else {
      setting("weber", "assumed 1");
    }
    const bool two = fit_.task != "one_interval";
    setting("task", two ? "forced_choice" : "one_interval");
    setting("criterion", fmt::format("{:.5g} %", two ? criterion_of_two : criterion_of_one));
    if (!fit_.is_fraction) setting("floor", quantity(fit_.thresholds.front().all.value, fit_.over_unit));
    if (of == over && fit_.is_fraction && over->unit.empty()) {
      // A plain ratio of something that the trials do not say.
    } else if (of == over) {
      setting("valid", range(std::min(low, fit_.least_standard.value_or(low)), high, over->unit));
    } else {
      setting("valid", range(fit_.weber->low, fit_.weber->high * high, of->unit));
    }
    setting("observers", std::to_string(std::ranges::min(fit_.thresholds, {}, &ThresholdFit::count).count));
    setting("evidence", fmt::format("slope {0}, handle {0}", fit_.evidence));
    setting("on", on());
    source();
    text_ += "}\n";
    return {};
  }

  /// What a setting is told from equality by, and what nothing is told from.
  Result<> adjusted() {
    const SizeValues* over = fit_.trials.size_named(fit_.over);
    const std::string quantity_name = dimension_of(fit_.over_unit);
    if (quantity_name.empty() || !is_identifier(fit_.over))
      return problem(fmt::format("`{}` is the unit of no quantity of thresholds", visible_text(fit_.over_unit)),
                     "name the column of the settings and its unit, as in --size amplitude=response:N");
    double low = HUGE_VAL, high = 0;
    for (const SettingsFit& each : fit_.settings) {
      comment(fmt::format("Like {}: {:.4g}, {}, {} observers.", each.standard.empty() ? "the standard" : each.standard,
                          each.settings.equal, bounds_of(each.settings.equal_interval), each.settings.observers.size()));
      low = std::min(low, each.size.value_or(each.settings.equal)), high = std::max(high, each.size.value_or(each.settings.equal));
    }
    comment(fmt::format("Weber fraction: the standard deviation of the natural logarithm of one observer's settings, 95 % {:.4g} to "
                        "{:.4g}.", fit_.settings_interval.low, fit_.settings_interval.high));
    const std::string cue = !request_.about.empty() ? request_.about : over != nullptr ? over->name : fit_.over;
    text_ += fmt::format("\n/// {}: {} settings of {} observers.\nexport threshold {} {{\n", name_of_study(),
                         fit_.trials.size(), fit_.trials.observers.size(), cue);
    setting("quantity", quantity_name);
    setting("weber", number(*fit_.settings_scatter));
    setting("task", "adjustment");
    setting("criterion", "84.134 %");  // one standard deviation of a normal distribution
    if (low > 0 && high > low) setting("valid", range(low, high, fit_.over_unit));
    setting("observers", std::to_string(fit_.trials.observers.size()));
    setting("evidence", fmt::format("slope {0}, handle {0}", fit_.evidence));
    setting("on", on());
    source();
    text_ += "}\n";
    return {};
  }

  /// What tells the stimulus of a trial from others: the ranges of its sizes halfway to their neighbours by ratio, or
  /// its name.
  Result<std::string> conditions_of(std::size_t trial) const {
    const Trials& trials = fit_.trials;
    std::string text;
    for (const SizeValues& each : trials.sizes) {
      const std::set<double> known(each.values.begin(), each.values.end());
      const auto at = known.find(each.values[trial]);
      const auto halfway = [](double a, double b) { return a > 0 ? std::sqrt(a * b) : (a + b) / 2; };
      const bool first = at == known.begin(), last = std::next(at) == known.end();
      if (first && last) continue;
      const std::string below = last ? "" : quantity(halfway(*at, *std::next(at)), each.unit);
      const std::string above = first ? "" : quantity(halfway(*std::prev(at), *at), each.unit);
      text += fmt::format(", assumed {} {}", each.name,
                          first  ? "below " + below
                          : last ? "above " + above
                                 : above + " .. " + below);
    }
    std::string kind;
    for (const FactorValues& each : trials.factors) {
      if (each.name == "stimulus" && !trials.sizes.empty()) continue;
      if (!kind.empty()) return problem("a rule tells stimuli by their sizes and one word", "choose one with --factor");
      kind = each.levels[each.values[trial]];
      text += ", kind " + identifier_of(kind, "nameless");
    }
    return text;
  }

  Result<> rule() {
    std::vector<std::string> cases;
    if (fit_.confidence) {
      std::vector<RatedStimulus> stimuli = fit_.confidence->stimuli;
      std::ranges::sort(stimuli, {}, &RatedStimulus::trial);
      for (const RatedStimulus& each : stimuli) {
        const auto conditions = conditions_of(each.trial);
        if (!conditions) return conditions.error();
        cases.push_back(
            fmt::format("{}{}, confidence {:.4g} %{}", in_quotes(each.name), *conditions, each.mean,
                        std::isfinite(each.deviation) ? fmt::format(", spread {:.4g} %", each.deviation) : ""));
      }
    } else if (fit_.descriptions) {
      const DescriptionFit& described = *fit_.descriptions;
      for (std::size_t i = 0; i < described.stimuli.size(); ++i) {
        const auto conditions = conditions_of(described.trials[i]);
        if (!conditions) return conditions.error();
        const auto words = by_frequency(described.is_coded ? described.stimuli[i].codes : described.stimuli[i].words);
        if (words.empty()) continue;
        std::string says;
        for (std::size_t k = 0; k < std::min<std::size_t>(5, words.size()); ++k)
          says += fmt::format("{}{} {}", k == 0 ? "" : ", ", words[k].first, words[k].second);
        cases.push_back(fmt::format("{}{}, says {}", in_quotes(words.front().first), *conditions,
                                    in_quotes(fmt::format("{} of {} descriptions", says, described.stimuli[i].descriptions))));
      }
    } else {
      const SortingFit& sorting = *fit_.sorting;
      comment(fmt::format(
          "{} sorts; single linkage cut into {} groups; mean adjusted Rand index of the sorts with them {:.3g}.",
          sorting.groupings.size(), sorting.groups, sorting.agreement));
      for (std::size_t i = 0; i < sorting.stimuli.size(); ++i) {
        const auto conditions = conditions_of(sorting.trials[i]);
        if (!conditions) return conditions.error();
        cases.push_back(fmt::format("\"group {}\"{}", sorting.clusters[i] + 1, *conditions));
      }
    }
    const std::string name = !request_.about.empty() ? request_.about : identifier_of(name_of_study(), "study");
    text_ += fmt::format("\n/// {}: {} of {} observers.\nexport rule {} {{\n", name_of_study(),
                         fit_.confidence ? "ratings" : fit_.descriptions ? "descriptions" : "sorts", fit_.trials.observers.size(), name);
    for (const std::string& each : cases) setting("case", each);
    setting("evidence", fit_.evidence);
    setting("on", on());
    source();
    text_ += "}\n";
    return {};
  }

  const Study& study_;
  const StudyFit& fit_;
  const FitRequest& request_;
  std::string text_;
};

}  // namespace

Result<std::string> record_of(const Study& study, const StudyFit& fit, const FitRequest& request) {
  return RecordWriter(study, fit, request).write();
}

}  // namespace wale
