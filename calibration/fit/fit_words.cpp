// Fits of tasks without right answers and without numbers of feeling: adjustment, and free description.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "calibration/fit/study_fit.hpp"
#include "schema/visible_text.hpp"

namespace wale {
namespace {

using namespace analysis;

Error at_file(const Study& study, std::string sentence, std::string mend) {
  return {.code = Code::malformed_value,
          .sentence = std::move(sentence),
          .mend = std::move(mend),
          .place = {.name = study.files.front().path}};
}

/// The cell of the column `standard` in each trial; empty without one.
std::vector<std::string> standards_of(const Study& study, const Trials& trials) {
  std::map<std::pair<std::size_t, std::size_t>, std::string> of_lines;
  for (std::size_t file = 0; file < study.tables.size(); ++file) {
    const Table& table = study.tables[file];
    const auto column = table.column("standard");
    if (!column) continue;
    for (std::size_t row = 0; row < table.rows(); ++row)
      if (!is_missing(table.cell(row, *column))) of_lines[{file, table.line(row)}] = table.cell(row, *column);
  }
  std::vector<std::string> standards;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const auto found = of_lines.find({trials.file[i], trials.line[i]});
    standards.push_back(found == of_lines.end() ? std::string() : found->second);
  }
  return standards;
}

/// The column that was moved along: the one that is the answer itself in each trial.
const SizeValues* moved_along(const Trials& trials) {
  for (const SizeValues& each : trials.sizes) {
    bool is = true;
    for (std::size_t i = 0; i < trials.size() && is; ++i)
      is = std::abs(each.values[i] - trials.answer[i]) <= 1e-9 * std::abs(trials.answer[i]);
    if (is) return &each;
  }
  return nullptr;
}

}  // namespace

Result<> fit_settings(const Study& study, const FitRequest& request, StudyFit& fit) {
  const Trials& trials = fit.trials;
  const SizeValues* over = request.over.empty() ? moved_along(trials) : trials.size_named(request.over);
  if (!request.over.empty() && over == nullptr)
    return at_file(study, fmt::format("no size is called `{}`", visible_text(request.over)), "name a --size");
  fit.over = over != nullptr ? over->name : "response";
  fit.over_unit = over != nullptr ? over->unit : "";
  if (const auto unit = study.units.find("response"); fit.over_unit.empty() && unit != study.units.end())
    fit.over_unit = unit->second;
  const std::vector<std::string> stated = standards_of(study, trials);
  struct About {
    std::optional<double> size;
    std::map<std::uint32_t, ObserverSettings> observers;
  };
  std::map<std::string, About> abouts;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    std::optional<double> standard = request.standard;
    if (!standard) standard = standard_in_cell(stated[i], fit.over, fit.over_unit);
    std::string name = !stated[i].empty() ? stated[i]
                       : standard         ? fmt::format("standard {:.4g}", *standard)
                                          : std::string();
    for (const SizeValues& each : trials.sizes)
      if (&each != over)
        name += fmt::format("{}{} {:.4g}{}{}", name.empty() ? "" : ", ", each.name, each.values[i],
                            each.unit.empty() ? "" : " ", each.unit);
    for (const FactorValues& each : trials.factors)
      name += fmt::format("{}{} {}", name.empty() ? "" : ", ", each.name, each.levels[each.values[i]]);
    About& about = abouts[name];
    about.size = standard;
    ObserverSettings& own = about.observers[trials.observer[i]];
    own.observer = trials.observers[trials.observer[i]];
    own.settings.push_back(trials.answer[i]);
  }
  std::vector<Settings> all;
  for (auto& [name, about] : abouts) {
    std::vector<ObserverSettings> observers;
    for (auto& [number, each] : about.observers) observers.push_back(std::move(each));
    auto settings = analyse_settings(std::move(observers));
    if (!settings) return settings.error();
    all.push_back(*settings);
    if (settings->step)
      fit.notes.push_back(fmt::format(
          "{}{}all settings lie on steps of {:.3g} %: the intervals are wider by the error of a step, half of it / sqrt(3){}",
          visible_text(name), name.empty() ? "" : ": ", 100 * *settings->step,
          settings->scatter && *settings->scatter <= *settings->step
              ? "; they scatter by no more than a step, so finer steps would tell how much people notice"
              : ""));
    fit.settings.push_back({name, about.size, *std::move(settings)});
  }
  if (trials.observers.size() == 1)
    fit.notes.push_back("all settings are by one observer; the interval says how settings scatter and nothing of people");
  if (const auto pooled = pool_scatters(all); pooled) {
    fit.settings_scatter = pooled->first, fit.settings_interval = pooled->second;
    if (!(pooled->first > 0)) fit.no_record = "all settings are alike, so nothing tells what people notice";
  } else {
    fit.no_record = "nobody set one standard twice, so nothing tells how settings scatter";
  }
  return {};
}

Result<> fit_descriptions(const Study& study, const FitRequest& request, StudyFit& fit) {
  const Trials& trials = fit.trials;
  DescriptionFit described;
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < trials.size(); ++i) texts.push_back(trials.labels[static_cast<std::size_t>(trials.answer[i])]);
  described.stimuli = count_words(texts, trials.stimulus, trials.stimuli, request.codes);
  described.names.resize(trials.stimuli), described.trials.assign(trials.stimuli, trials.size());
  for (std::size_t i = trials.size(); i-- > 0;) described.trials[trials.stimulus[i]] = i;
  for (std::size_t number = 0; number < trials.stimuli; ++number) {
    const std::size_t i = described.trials[number];
    if (const FactorValues* names = trials.factor_named("stimulus")) {
      described.names[number] = names->levels[names->values[i]];
      continue;
    }
    std::string& name = described.names[number];
    for (const SizeValues& each : trials.sizes)
      name += fmt::format("{}{} {:.4g}{}{}", name.empty() ? "" : ", ", each.name, each.values[i],
                          each.unit.empty() ? "" : " ", each.unit);
    for (const FactorValues& each : trials.factors)
      name += fmt::format("{}{} {}", name.empty() ? "" : ", ", each.name, each.levels[each.values[i]]);
    if (name.empty()) name = "all";
  }
  described.is_coded = !request.codes.empty();
  for (const DescribedStimulus& each : described.stimuli) {
    for (const auto& [word, count] : each.words) described.all.words[word] += count;
    for (const auto& [code, count] : each.codes) described.all.codes[code] += count;
    described.all.descriptions += each.descriptions;
  }
  if (described.all.words.empty() && described.all.codes.empty())
    return at_file(study, "no answer has a word in it", "name the column of the descriptions with --answer");
  if (described.is_coded && described.all.codes.empty())
    return at_file(study, "no word of the table of codes is in any description", "look at the words that the table has");
  fit.descriptions = std::move(described);
  return {};
}

}  // namespace wale
