#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "calibration/analysis/table.hpp"
#include "calibration/command/experiment_file.hpp"
#include "calibration/fit/plan.hpp"
#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/text/readable.hpp"
#include "compiler/text/resolver.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct ExperimentPlanOptions {
  Choice choice;
  std::string experiment, over, stimuli;
  std::optional<double> precision, share, exponent, spread, noise, threshold, threshold_spread, growth, lapse, criterion;
  std::optional<std::uint64_t> seed, studies, most;
  bool json = false;
};

/// The sizes of the stimuli in a table: the first column of numbers, or that of --over.
Result<std::vector<double>> sizes_in(const ExperimentPlanOptions& options, const CheckedExperiment& experiment) {
  auto file = read_file(options.stimuli);
  if (!file) return std::move(file).error();
  const auto table = analysis::read_table(options.stimuli, std::move(file->bytes));
  if (!table) return table.error();
  const auto names = table->column("stimulus");
  if (!names) return analysis::table_error(*table, 0, "the table of stimuli has no column `stimulus`", "");
  std::size_t column = table->columns().size();
  for (std::size_t i = table->columns().size(); i-- > 0;) {
    const std::string& name = table->columns()[i];
    if (i != *names && (options.over.empty() || name.substr(0, name.find(' ')) == options.over)) column = i;
  }
  if (column == table->columns().size())
    return analysis::table_error(
        *table, 0, fmt::format("the table of stimuli has no column `{}`", visible_text(options.over)), "");
  std::vector<double> sizes;
  for (const ExperimentStimulus& each : experiment.stimuli) {
    std::optional<double> value;
    for (std::size_t row = 0; row < table->rows(); ++row)
      if (table->cell(row, *names) == each.name) {
        value = analysis::number_in(table->cell(row, column));
        if (!value)
          return analysis::table_error(*table, row, "expected a number for the size", "", table->cell(row, column));
      }
    if (!value)
      return analysis::table_error(
          *table, 0, fmt::format("the table of stimuli has no stimulus `{}`", visible_text(each.name)), "");
    sizes.push_back(*value);
  }
  return sizes;
}

std::string json_of(const Plan& plan, const PlanRequest& request, const std::string& experiment) {
  nlohmann::ordered_json json = {
      {"experiment", experiment},
      {"sought", plan.sought},
      {"precision", request.precision},
      {"share", request.share},
      {"seed", request.seed},
      {"studies", request.studies},
      {"assumed",
       {{"exponent", request.exponent},
        {"spread", request.spread},
        {"noise", request.noise},
        {"threshold", request.threshold ? nlohmann::ordered_json(*request.threshold) : nlohmann::ordered_json(nullptr)},
        {"threshold_spread", request.threshold_spread},
        {"growth", request.growth},
        {"lapse", request.lapse},
        {"criterion", request.criterion}}},
      {"trials_of_one_person", plan.trials},
      {"people", plan.people ? nlohmann::ordered_json(*plan.people) : nlohmann::ordered_json(nullptr)}};
  json["steps"] = nlohmann::ordered_json::array();
  for (const PlanStep& each : plan.steps)
    json["steps"].push_back({{"people", each.people},
                             {"half_width", std::isfinite(each.half_width) ? nlohmann::ordered_json(each.half_width)
                                                                           : nlohmann::ordered_json(nullptr)},
                             {"precise", each.precise},
                             {"covered", each.covered}});
  return json.dump(2) + "\n";
}

int experiment_plan(const ExperimentPlanOptions& options) {
  const auto opened = open(options.choice);
  if (!opened) return opened.status();
  const auto found = experiment_in(*opened, options.experiment);
  if (!found) return refuse(found.error());
  const CheckedExperiment& experiment = **found;
  PlanRequest request;
  const bool is_law = experiment.task == TrialTask::magnitude_estimation;
  request.precision = options.precision.value_or(is_law ? 0.1 : 0.2);
  request.share = options.share.value_or(request.share);
  request.studies = options.studies.value_or(request.studies), request.most = options.most.value_or(request.most);
  request.seed = options.seed.value_or(request.seed);
  request.exponent = options.exponent.value_or(request.exponent),
  request.spread = options.spread.value_or(request.spread);
  request.noise = options.noise.value_or(request.noise), request.threshold = options.threshold;
  request.threshold_spread = options.threshold_spread.value_or(request.threshold_spread);
  request.growth = options.growth.value_or(request.growth), request.lapse = options.lapse.value_or(request.lapse);
  request.criterion = options.criterion.value_or(request.criterion);
  request.over = options.over;
  if (!options.stimuli.empty()) {
    auto sizes = sizes_in(options, experiment);
    if (!sizes) return refuse(sizes.error());
    request.sizes = *std::move(sizes);
  }
  auto plan = plan_experiment(experiment, request);
  if (!plan) {
    Error error = plan.error();
    if (error.place.name.empty()) error.place.name = experiment.name;
    return refuse(error);
  }
  if (options.json) {
    print_out(json_of(*plan, request, experiment.name));
    return plan->people ? done : refused;
  }
  print_out("{}", readable("{}: {}, {} trials a person; assumed: {}\n", experiment.name, plan->sought, plan->trials,
                           is_law ? readable("exponent {:.3g} ± {:.3g} between people, noise {:.3g} of log10 answers",
                                             request.exponent, request.spread, request.noise)
                                  : readable("threshold {}, {:.3g} of its logarithm between people; d' {}, lapse rate "
                                             "{:.3g}{}",
                                             request.threshold ? readable("{:.3g}", *request.threshold)
                                                               : "in the middle of the levels",
                                             request.threshold_spread,
                                             request.growth == 1 ? std::string("in proportion to the difference")
                                                                 : readable("as the difference to the power of {:.3g}",
                                                                            request.growth),
                                             request.lapse,
                                             experiment.task == TrialTask::two_interval
                                                 ? std::string()
                                                 : readable(", criterion {:.3g}", request.criterion))));
  auto steps = plan->steps;
  std::ranges::sort(steps, {}, &PlanStep::people);
  for (const PlanStep& each : steps)
    print_out("{}", readable("  {:>4} people: half width {:.3g} in {:.3g} % of studies; {:.3g} % are within {:.3g}, "
                             "{:.3g} % hold the truth\n",
                             each.people, each.half_width, 100 * request.share, 100 * each.precise, request.precision,
                             100 * each.covered));
  if (plan->people) {
    print_out("{}",
              readable("{} people are enough: the 95 % interval is within ± {:.3g}{} in at least {:.3g} % of studies\n",
                       *plan->people, request.precision, is_law ? "" : " of the logarithm", 100 * request.share));
    return done;
  }
  print_out("{}", readable("{} people are not enough\n", request.most));
  return refused;
}

Run declare_experiment_plan(CLI::App& verb) {
  const auto options = std::make_shared<ExperimentPlanOptions>();
  must_say(verb.add_option("FILE", options->choice.file, "the Wale file that declares the experiment"),
           "the path of a Wale file")
      ->required();
  must_say(verb.add_option("--experiment", options->experiment, "which experiment of the file (default: its first)")
               ->type_name("NAME"),
           "the name of an experiment");
  offer_number(verb, "--precision", options->precision, {.least = 1e-4, .most = 10, .example = 0.1},
               "half of the 95 % interval that is wanted: of an exponent (default: 0.1), or of the natural logarithm "
               "of a threshold (default: 0.2)");
  offer_number(verb, "--share", options->share, {.least = 0.01, .most = 0.99, .example = 0.8},
               "the share of studies that are to be so precise (default: 0.8)");
  offer_number(verb, "--exponent", options->exponent, {.least = -5, .most = 5, .example = 0.76},
               "the mean exponent of people (default: 0.76)");
  offer_number(verb, "--spread", options->spread, {.least = 0, .most = 5, .example = 0.2},
               "the standard deviation of exponents between people (default: 0.2)");
  offer_number(verb, "--noise", options->noise, {.least = 0, .most = 5, .example = 0.15},
               "the standard deviation of log10 of single answers (default: 0.15)");
  offer_number(
      verb, "--threshold", options->threshold, {.least = 1e-9, .most = 1e9, .example = 0.1},
      "the threshold: a size in SI, or a fraction where the factor is a ratio (default: the middle of the levels)");
  offer_number(verb, "--threshold-spread", options->threshold_spread, {.least = 0, .most = 5, .example = 0.3},
               "the standard deviation of its natural logarithm between people (default: 0.3)");
  offer_number(verb, "--growth", options->growth, {.least = 0.2, .most = 10, .example = 1.5},
               "how d' grows with the difference, as its power: 1 in proportion (default: 1)");
  offer_number(verb, "--lapse", options->lapse, {.least = 0, .most = 0.1, .example = 0.02},
               "how far answers about thresholds stay from 0 and 1 (default: 0.02)");
  offer_number(verb, "--criterion", options->criterion, {.least = -3, .most = 6, .example = 1},
               "of \"yes\", or half of that of \"different\", in units of d' (default: 1, \"yes\" to nothing in 16 %)");
  must_say(verb.add_option("--over", options->over,
                           "the factor that is sought (default: the first with quantities, or the method's)")
               ->type_name("NAME"),
           "the name of a factor");
  must_say(verb.add_option("--stimuli", options->stimuli,
                           "a table with a column `stimulus` and sizes, for designs without factors")
               ->type_name("FILE"),
           "the path of a table");
  offer_count(verb, "--studies", options->studies, {.least = 20, .most = 10000},
              "how many studies are simulated for each number of people (default: 200)");
  offer_count(verb, "--most", options->most, {.least = 3, .most = 1000}, "the most people (default: 100)");
  offer_count(verb, "--seed", options->seed, {.least = 0, .most = 4294967295u}, "of the simulation (default: 1)");
  offer_json(verb, options->json, "prints the plan as JSON");
  offer_library(verb, options->choice.folders);
  offer_sandbox(verb, options->choice.sandbox);
  verb.footer(
      "What people are like is assumed, and the answer is no better than that. Exit status 1: the most people are not "
      "enough.\n"
      "for example: wale experiment plan calibration/experiments/crossed.wale --precision 0.05 --spread 0.15");
  return [options] { return experiment_plan(*options); };
}

}  // namespace

extern const Verb experiment_plan_verb{"experiment-plan", "says by simulation how many people an experiment needs",
                                       declare_experiment_plan};

}  // namespace wale::command
