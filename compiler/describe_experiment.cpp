#include "compiler/describe_experiment.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compiler/check/check_experiment.hpp"
#include "compiler/compare/compare.hpp"
#include "compiler/text/json_text.hpp"
#include "compiler/text/readable.hpp"

namespace wale {
namespace {

constexpr std::size_t most_pairs_told = 8, most_unrendered_told = 8;

/// Warnings that say that a finished program is not what was asked for.
bool is_otherwise(Code code) {
  constexpr std::array codes = {Code::saturates,         Code::under_resolution, Code::lost_percept, Code::reduced_percept,
                                Code::delivered_otherwise, Code::too_fast_for_loop, Code::beyond_devices};
  return std::ranges::find(codes, code) != codes.end();
}

/// The number of trials after practice, or the most there may be.
std::size_t trials_after_practice(const CheckedExperiment& experiment) {
  const auto repetitions = static_cast<std::size_t>(experiment.repetitions);
  const bool moves = experiment.over && (experiment.method != TrialMethod::constant_stimuli ||
                                         experiment.task == TrialTask::adjustment);
  if (experiment.task == TrialTask::sorting) return repetitions * std::max<std::size_t>(1, experiment.groups.size());
  if (!moves) return repetitions * experiment.stimuli.size();
  const std::size_t tracks = experiment.stimuli.size() / experiment.factors[*experiment.over].levels.size();
  return repetitions * tracks *
         (experiment.task == TrialTask::adjustment ? 1 : static_cast<std::size_t>(experiment.trials));
}

double session_seconds(const CheckedExperiment& experiment, std::size_t trials) {
  const double answers =
      assumed_answer_seconds(experiment.task) + 4.0 * static_cast<double>(experiment.questions.size());
  double presentations = 1;
  if (experiment.task == TrialTask::two_interval || experiment.task == TrialTask::same_different) presentations = 2;
  if (experiment.task == TrialTask::adjustment) presentations = 10;
  if (experiment.task == TrialTask::sorting) presentations = 2.0 * static_cast<double>(experiment.stimuli.size());
  double seconds = static_cast<double>(trials) * (presentations * experiment.seconds + answers);
  if (experiment.pause > 0) {
    const double breaks = experiment.pause_after > 0 ? std::floor(seconds / experiment.pause_after)
                                                     : static_cast<double>(experiment.repetitions - 1);
    seconds += breaks * experiment.pause;
  }
  return seconds + 15.0 * static_cast<double>(experiment.closing.size());
}

}  // namespace

double assumed_answer_seconds(TrialTask task) {
  switch (task) {
    case TrialTask::description: return 20;
    case TrialTask::adjustment: return 20;
    case TrialTask::sorting: return 120;
    case TrialTask::two_interval:
    case TrialTask::one_interval:
    case TrialTask::same_different: return 2;
    default: return 4;
  }
}

ExperimentDescription describe_experiment(const CheckedExperiment& experiment, const MadeExperiment& made,
                                          const std::string& device, const Declarations& declarations) {
  ExperimentDescription described;
  described.name = experiment.name, described.documentation = experiment.documentation, described.device = device;
  described.task = trial_task_names[static_cast<std::size_t>(experiment.task)];
  if (experiment.method != TrialMethod::constant_stimuli)
    described.task += fmt::format(", {}", trial_method_names[static_cast<std::size_t>(experiment.method)]);
  described.stimuli = experiment.stimuli.size(), described.standards = experiment.standards.size();
  described.practice = static_cast<std::size_t>(experiment.practice);
  described.blocks = static_cast<std::size_t>(experiment.repetitions);
  described.at_most = experiment.method != TrialMethod::constant_stimuli;
  described.trials = described.practice + trials_after_practice(experiment);
  described.seconds = session_seconds(experiment, described.trials);
  described.presentation = experiment.seconds, described.to_and_fro = seconds_to_and_fro(declarations);
  for (const ExperimentFactor& factor : experiment.factors) {
    std::vector<std::string> levels;
    for (const ExperimentLevel& level : factor.levels) levels.push_back(level.text);
    if (levels.size() > 8)
      levels = {levels[0], levels[1], readable("… {} levels …", levels.size()), levels.back()};
    described.factors.push_back(fmt::format("{} {}", factor.name, fmt::join(levels, ", ")));
  }

  std::vector<std::optional<Cues>> cues;
  const auto take = [&](const std::vector<MadeStimulus>& all, const std::vector<ExperimentStimulus>& named) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const MadeStimulus& each = all[i];
      cues.emplace_back();
      if (each.program && !each.program->description().vibrates())
        cues.back() =
            cues_of(Bank(*each.program, each.program->default_parameters(), each.program->default_size()), declarations);
      const auto said = std::ranges::find_if(each.said, [&](const Diagnostic& diagnostic) {
        return each.program ? is_otherwise(diagnostic.code) : severity_of(diagnostic.code) == Severity::error;
      });
      if (said != each.said.end())
        described.unrendered.push_back({named[i].name, said->message, each.program.has_value()});
    }
  };
  take(made.stimuli, experiment.stimuli);
  take(made.standards, experiment.standards);
  const Comparer comparer(declarations, device);
  const auto compare = [&](std::size_t a, std::size_t b, const std::string& of_a, const std::string& of_b) {
    if (!cues[a] || !cues[b]) return;
    ++described.pairs;
    const Distance distance = comparer.distance(*cues[a], *cues[b]);
    if (distance.verdict != Verdict::alike) return;
    ++described.alike;
    described.nearest.push_back({of_a, of_b, distance.noticeable});
  };
  const std::size_t count = experiment.stimuli.size();
  for (std::size_t a = 0; a < count; ++a) {
    // Where there is a standard, only pairs with it are presented.
    if (const auto standard = experiment.stimuli[a].standard) {
      compare(a, count + *standard, experiment.stimuli[a].name, experiment.standards[*standard].name);
      continue;
    }
    for (std::size_t b = a + 1; b < count; ++b) compare(a, b, experiment.stimuli[a].name, experiment.stimuli[b].name);
  }
  std::ranges::stable_sort(described.nearest, {}, &AlikePair::noticeable);
  described.nearest.resize(std::min(described.nearest.size(), most_pairs_told));
  return described;
}

std::string experiment_text(const ExperimentDescription& description) {
  std::string text = fmt::format("experiment {} on {}\n", description.name, description.device);
  if (!description.documentation.empty()) text += fmt::format("  {}\n", description.documentation);
  text += readable("  stimuli   {}{}\n", description.stimuli,
                   description.standards > 0 ? readable(", compared with {} standard{}", description.standards,
                                                        description.standards == 1 ? "" : "s")
                                             : std::string());
  for (const std::string& each : description.factors) text += fmt::format("  factor    {}\n", each);
  text += fmt::format("  task      {}\n", description.task);
  text += readable("  trials    {}{}, of which {} practice, in {} block{}\n", description.at_most ? "at most " : "",
                   description.trials, description.practice, description.blocks, description.blocks == 1 ? "" : "s");
  text += readable("  time      {}{:.0f} minutes, with the assumed time for answers\n",
                   description.at_most ? "at most " : "about ", std::ceil(description.seconds / 60));
  if (description.is_short())
    text += readable("  short     a presentation takes {:.3g} s, and a hand moves to and fro once in {:.3g} s\n",
                     description.presentation, description.to_and_fro);
  if (description.pairs > 0)
    text += description.alike == 0
                ? readable("  pairs     none of {} is known to be under one just noticeable difference\n", description.pairs)
                : readable("  pairs     {} of {} are under one just noticeable difference:\n", description.alike,
                           description.pairs);
  for (const AlikePair& each : description.nearest)
    text += readable("            {:.2f}  {} and {}\n", each.noticeable, each.a, each.b);
  if (description.alike > description.nearest.size())
    text += readable("            and {} more\n", description.alike - description.nearest.size());
  for (std::size_t i = 0; i < std::min(description.unrendered.size(), most_unrendered_told); ++i) {
    const UnrenderedStimulus& each = description.unrendered[i];
    text += fmt::format("  {}  {}: {}\n", each.is_built ? "otherwise" : "cannot  ", each.name, each.why);
  }
  if (description.unrendered.size() > most_unrendered_told)
    text += readable("            and {} more\n", description.unrendered.size() - most_unrendered_told);
  if (description.unrendered.empty()) text += "  device    renders all of them\n";
  return text;
}

std::string experiments_json(const std::vector<ExperimentDescription>& descriptions) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const ExperimentDescription& each : descriptions) {
    nlohmann::ordered_json nearest = nlohmann::ordered_json::array(), unrendered = nlohmann::ordered_json::array();
    for (const AlikePair& pair : each.nearest)
      nearest.push_back({{"a", pair.a}, {"b", pair.b}, {"noticeable", pair.noticeable}});
    for (const UnrenderedStimulus& stimulus : each.unrendered)
      unrendered.push_back({{"stimulus", stimulus.name}, {"built", stimulus.is_built}, {"why", stimulus.why}});
    all.push_back({{"experiment", each.name},
                   {"documentation", each.documentation},
                   {"device", each.device},
                   {"task", each.task},
                   {"stimuli", each.stimuli},
                   {"standards", each.standards},
                   {"factors", each.factors},
                   {"trials", each.trials},
                   {"trials_at_most", each.at_most},
                   {"practice", each.practice},
                   {"blocks", each.blocks},
                   {"seconds", each.seconds},
                   {"presentation_seconds", each.presentation},
                   {"presentation_is_short", each.is_short()},
                   {"pairs", each.pairs},
                   {"pairs_alike", each.alike},
                   {"nearest", nearest},
                   {"unrendered", unrendered}});
  }
  return json_lines(all.size() == 1 ? all.front() : all);
}

}  // namespace wale
