#include "calibration/fit/study_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "schema/visible_text.hpp"

namespace wale {
namespace {

using namespace analysis;

Error unknown(std::string sentence, std::string mend, const Study& study) {
  return {.code = Code::malformed_value,
          .sentence = std::move(sentence),
          .mend = std::move(mend),
          .place = {.name = study.files.front().path}};
}

/// Whether a column has one value in all rows that have any.
bool is_constant(const Study& study, const std::string& name) {
  std::optional<std::string_view> first;
  for (const Table& table : study.tables) {
    const auto column = table.column(name);
    if (!column) return false;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const std::string_view cell = table.cell(row, *column);
      if (is_missing(cell)) continue;
      if (first && *first != cell) return false;
      first = cell;
    }
  }
  return true;
}

/// The columns to read: those of the request, else what the study varied.
TrialColumns columns_of(const Study& study, const FitRequest& request, StudyFit& fit) {
  TrialColumns columns = request.columns;
  const bool found = columns.sizes.empty() && columns.factors.empty();
  if (found) {
    const auto varies = [&](const std::string& name) {
      if (!is_constant(study, name)) return true;
      fit.notes.push_back(fmt::format("the column `{}` is the same in all rows, and is left out", visible_text(name)));
      return false;
    };
    for (const std::string& name : study.varied)
      if (varies(name))
        columns.sizes.push_back({.name = name.substr(0, name.find_first_of(" ([")), .column = name, .unit = {}});
    for (const std::string& name : study.words)
      if (varies(name)) columns.factors.push_back(name);
  }
  for (SizeColumn& each : columns.sizes) {
    const auto unit = study.units.find(each.column.empty() ? each.name : each.column);
    if (each.unit.empty() && unit != study.units.end()) each.unit = unit->second;
  }
  return columns;
}

void grade(const Study& study, StudyFit& fit) {
  if (fit.trials.simulated || study.simulated) {
    fit.evidence = "simulated", fit.evidence_reason = "some answers come from no person on a real device";
  } else if (!fit.trials.ungraded) {
    fit.evidence = "measured", fit.evidence_reason = "people on a plugged device that its owner has declared";
  } else {
    fit.evidence = "estimated", fit.evidence_reason = "the files do not say who answered on which device";
  }
}

Result<> fit_sorts(const Study& study, StudyFit& fit) {
  const Trials& trials = fit.trials;
  const FactorValues* names = trials.factor_named("stimulus");
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::map<std::uint32_t, std::size_t>> sorts;
  SortingFit sorting;
  sorting.trials.assign(names->levels.size(), trials.size());
  sorting.stimuli = names->levels;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    auto& sort = sorts[{trials.observer[i], trials.run[i]}];
    const std::uint32_t stimulus = names->values[i];
    if (!sort.try_emplace(stimulus, static_cast<std::size_t>(trials.answer[i])).second)
      return Error{.code = Code::malformed_value,
                   .sentence = fmt::format("`{}` is there twice in one sort", visible_text(names->levels[stimulus])),
                   .mend = "keep one of the rows, or name the column of the run",
                   .place = trials.place(i)};
    sorting.trials[stimulus] = std::min(sorting.trials[stimulus], i);
  }
  std::map<std::size_t, std::size_t> sizes;
  for (const auto& [of, sort] : sorts) {
    if (sort.size() != names->levels.size())
      return unknown(fmt::format("a sort by {} has {} of {} stimuli", visible_text(trials.observers[of.first]),
                                 sort.size(), names->levels.size()),
                     "leave the sort out by rule, as with --drop", study);
    Grouping grouping;
    std::set<std::size_t> groups;
    for (const auto& [stimulus, group] : sort) grouping.push_back(group), groups.insert(group);
    ++sizes[groups.size()];
    sorting.groupings.push_back(std::move(grouping));
  }
  if (names->levels.size() < 3) return unknown("a sort needs three stimuli at least", "", study);
  const Eigen::MatrixXd apart = times_apart(sorting.groupings);
  sorting.single = cluster(apart, Linkage::single);
  sorting.average = cluster(apart, Linkage::average);
  sorting.complete = cluster(apart, Linkage::complete);
  // Of equally many, the finest.
  for (const auto& [groups, count] : sizes)
    if (count >= sizes[sorting.groups]) sorting.groups = std::clamp<std::size_t>(groups, 1, names->levels.size());
  sorting.clusters = cut(sorting.single, sorting.groups);
  for (const Grouping& each : sorting.groupings)
    sorting.agreement += adjusted_rand_index(each, sorting.clusters) / static_cast<double>(sorting.groupings.size());
  for (const auto& [groups, count] : sizes) {
    if (groups < 2 || groups >= names->levels.size()) continue;
    GroupsFit each{.groups = groups, .sorts = count};
    std::vector<Grouping> alike;
    for (const Grouping& sort : sorting.groupings)
      if (std::set<std::size_t>(sort.begin(), sort.end()).size() == groups) alike.push_back(sort);
    each.clusters = cut(cluster(times_apart(alike), Linkage::single), groups);
    for (const Grouping& sort : alike) each.distances.push_back(distance_from_prototype(sort, each.clusters));
    sorting.by_groups.push_back(std::move(each));
  }
  if (auto map = scale(apart)) sorting.map = *std::move(map);
  else sorting.map_refused = map.error().sentence;
  constexpr double degenerate = 0.02;  // below what smacof's authors call perfect
  if (sorting.map && sorting.map->stress < degenerate)
    fit.notes.push_back("the stress of the map is near zero: with so few or so similar sorts, stimuli fall together on points, "
                        "and the distances between these say little");
  fit.sorting = std::move(sorting);
  return {};
}

Result<> fit_magnitudes(const Study& study, const FitRequest& request, StudyFit& fit) {
  if (fit.trials.sizes.empty())
    return unknown("no column has the sizes of the stimuli",
                   "name one with --size, or a table of the stimuli with --stimuli", study);
  if (fit.trials.observers.size() < 2)
    return Error{.code = Code::not_measured,
                 .sentence = fmt::format("all answers are by one observer, {}, so nothing tells how people differ",
                                         visible_text(fit.trials.observers.front())),
                 .mend = "name the trials of more observers",
                 .place = {.name = study.files.front().path}};
  auto analysis = analyse_magnitudes(fit.trials, {.size = request.over});
  if (!analysis) return analysis.error();
  fit.magnitudes = *std::move(analysis);
  if (const Coefficient exponent = chosen_law(*fit.magnitudes, request.model).exponent; !(exponent.p() < 0.05))
    fit.no_record = fmt::format("the exponent does not differ from zero beyond chance (p = {:.2g})", exponent.p());
  if (request.model == FitModel::thesis_equalised && !fit.magnitudes->equalised)
    return unknown("the observers' means cannot be equalised", "take --model thesis", study);
  return {};
}

}  // namespace

const char* fit_model_name(FitModel model) {
  return model == FitModel::mixed ? "mixed" : model == FitModel::thesis ? "thesis" : "thesis_equalised";
}

ChosenLaw chosen_law(const MagnitudeAnalysis& analysis, FitModel model) {
  if (model == FitModel::mixed) return {analysis.exponent, analysis.constant};
  const Regression& regression =
      (model == FitModel::thesis_equalised && analysis.equalised ? *analysis.equalised : analysis.thesis).regression;
  return {regression.coefficients[1], regression.coefficients[0]};
}

Result<StudyFit> fit_study(const Study& study, const FitRequest& request) {
  StudyFit fit;
  fit.task = request.task.empty() ? study.task : request.task;
  fit.notes = study.notes;
  TrialColumns columns = columns_of(study, request, fit);
  const auto add_stimulus = [&] {
    const bool has =
        std::ranges::all_of(study.tables, [](const Table& each) { return each.column("stimulus").has_value(); });
    if (has && std::ranges::find(columns.factors, "stimulus") == columns.factors.end())
      columns.factors.push_back("stimulus");
    return has;
  };
  const auto read = [&]() -> Result<> {
    auto trials = read_trials(study.tables, columns);
    if (!trials) return trials.error();
    fit.trials = *std::move(trials);
    grade(study, fit);
    return {};
  };
  if (fit.task == "magnitude_estimation") {
    columns.answers = Answers::magnitudes;
    if (const auto done = read(); !done) return done.error();
    if (const auto done = fit_magnitudes(study, request, fit); !done) return done.error();
  } else if (fit.task == "confidence" || fit.task == "rating") {
    columns.answers = Answers::ratings;
    if (columns.sizes.empty()) add_stimulus();
    if (const auto done = read(); !done) return done.error();
    auto analysis = analyse_confidence(fit.trials);
    if (!analysis) return analysis.error();
    fit.confidence = *std::move(analysis);
    if (!(fit.confidence->deviation > 0)) fit.no_record = "all ratings are the same, so they tell no stimulus from another";
  } else if (fit.task == "sorting") {
    columns.answers = Answers::labels;
    if (!add_stimulus()) return unknown("there is no column `stimulus`", "name the stimuli in one of that name", study);
    if (const auto done = read(); !done) return done.error();
    if (const auto done = fit_sorts(study, fit); !done) return done.error();
  } else if (fit.task == "adjustment") {
    columns.answers = Answers::magnitudes;
    if (const auto done = read(); !done) return done.error();
    if (const auto done = fit_settings(study, request, fit); !done) return done.error();
  } else if (fit.task == "description") {
    columns.answers = Answers::labels;
    if (columns.sizes.empty()) add_stimulus();
    if (const auto done = read(); !done) return done.error();
    if (const auto done = fit_descriptions(study, request, fit); !done) return done.error();
  } else if (fit.task == "two_interval" || fit.task == "one_interval" || fit.task == "same_different") {
    if (const auto done = fit_thresholds(study, request, columns, fit); !done) return done.error();
    grade(study, fit);
  } else if (fit.task.empty()) {
    return unknown("the files do not say what the task was", "name it with --task, or the design with --design", study);
  } else {
    return unknown(fmt::format("nothing is fitted to trials of the task `{}`", visible_text(fit.task)),
                   "magnitude_estimation gives a map; two_interval, one_interval, same_different and adjustment a "
                   "threshold; confidence, rating, sorting and description a rule",
                   study);
  }
  fit.notes.insert(fit.notes.end(), fit.trials.notes.begin(), fit.trials.notes.end());
  return fit;
}

}  // namespace wale
