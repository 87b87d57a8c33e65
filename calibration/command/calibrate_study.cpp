#include "calibration/command/calibrate_study.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>
#include <utility>

#include "calibration/analysis/descriptions.hpp"
#include "calibration/command/experiment_file.hpp"
#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/compile.hpp"
#include "compiler/expression/checked_experiment.hpp"
#include "compiler/text/resolver.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

Error misspelt(const char* option, std::string sentence, std::string mend) {
  return {.code = Code::malformed_value,
          .sentence = std::move(sentence),
          .mend = std::move(mend),
          .place = {.name = option}};
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// A name of Wale, with dots between if `dotted`.
bool is_name(std::string_view text, bool dotted) {
  bool first = true;
  for (const char c : text) {
    if (c == '.' && dotted && !first) {
      first = true;
      continue;
    }
    if (!(is_letter(c) || (!first && is_digit(c)))) return false;
    first = false;
  }
  return !text.empty() && !first;
}

/// `amplitude`, `amplitude:N`, `amplitude=force_amp`, `amplitude=force_amp:N`.
Result<analysis::SizeColumn> size_column(const std::string& text) {
  analysis::SizeColumn column{.name = text, .column = {}, .unit = {}};
  if (const auto colon = column.name.rfind(':'); colon != std::string::npos)
    column.unit = column.name.substr(colon + 1), column.name.resize(colon);
  if (const auto equals = column.name.find('='); equals != std::string::npos)
    column.column = column.name.substr(equals + 1), column.name.resize(equals);
  if (is_name(column.name, false)) return column;
  return misspelt("--size", fmt::format("expected a name of Wale, found `{}`", visible_text(column.name)),
                  "write, for example, `--size amplitude=COLUMN:N`");
}

Result<analysis::Selection> selection(const char* option, const std::string& text, bool is) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    return misspelt(option, fmt::format("expected COLUMN=TEXT, found `{}`", visible_text(text)),
                    fmt::format("write, for example, `{} group=control`", option));
  return analysis::Selection{text.substr(0, equals), text.substr(equals + 1), is};
}

Result<FitRequest> request_of(const StudyChoice& choice) {
  FitRequest request;
  request.model = choice.model == "thesis"             ? FitModel::thesis
                  : choice.model == "thesis_equalised" ? FitModel::thesis_equalised
                                                       : FitModel::mixed;
  request.task = choice.task, request.over = choice.over, request.standard = choice.standard;
  for (const auto& [option, value, dotted] :
       {std::tuple("--of", &choice.about, false), std::tuple("--carrier", &choice.carrier, false),
        std::tuple("--name", &choice.name, true)})
    if (!value->empty() && !is_name(*value, dotted))
      return misspelt(option, fmt::format("expected a name of Wale, found `{}`", visible_text(*value)),
                      "a name has letters, digits and _");
  request.about = choice.about, request.carrier = choice.carrier, request.name = choice.name;
  if (!std::ranges::all_of(choice.domain,
                           [](char c) { return is_letter(c) || is_digit(c) || c == ' ' || c == ',' || c == '.'; }))
    return misspelt("--domain", fmt::format("expected words of a domain, found `{}`", visible_text(choice.domain)),
                    "write, for example, `--domain \"grating, one_dimensional, alone\"`");
  request.domain = choice.domain;
  if (!choice.participant.empty()) request.columns.observer = choice.participant;
  if (!choice.answer.empty()) request.columns.answer = choice.answer;
  request.columns.run = choice.run, request.columns.trial = choice.trial;
  request.columns.factors = choice.factors;
  request.columns.leave_out_nonpositive = choice.leave_out_nonpositive;
  for (const std::string& each : choice.sizes) {
    const auto column = size_column(each);
    if (!column) return column.error();
    request.columns.sizes.push_back(*column);
  }
  for (const auto& [texts, is] : {std::pair(&choice.keep, true), std::pair(&choice.drop, false)})
    for (const std::string& each : *texts) {
      const auto rule = selection(is ? "--keep" : "--drop", each, is);
      if (!rule) return rule.error();
      request.columns.keep.push_back(*rule);
    }
  return request;
}

DesignFacts facts_of(const CheckedExperiment& experiment) {
  DesignFacts facts{.experiment = experiment.name, .task = trial_task_names[static_cast<int>(experiment.task)]};
  for (const ExperimentFactor& each : experiment.factors) {
    const bool is_number = !each.levels.empty() && each.levels.front().value.has_value();
    (is_number ? facts.varied : facts.words).push_back(each.name);
    if (!each.unit.empty()) facts.units[each.name] = each.unit;
  }
  return facts;
}

/// What the words of descriptions mean, by a table.
Result<std::vector<analysis::WordCode>> read_codes(const std::string& path) {
  auto file = read_file(path);
  if (!file) return std::move(file).error();
  const auto table = analysis::read_table(path, std::move(file->bytes));
  if (!table) return table.error();
  const auto word = table->column("word"), code = table->column("code");
  if (!word || !code)
    return analysis::table_error(*table, 0, fmt::format("the table of codes has no column `{}`", word ? "code" : "word"),
                                 "it has a word, or several, and what they are counted as");
  std::vector<analysis::WordCode> codes;
  for (std::size_t row = 0; row < table->rows(); ++row) {
    analysis::WordCode each{analysis::words_in(table->cell(row, *word)), std::string(table->cell(row, *code))};
    if (each.words.empty() || analysis::is_missing(each.code))
      return analysis::table_error(*table, row, "expected a word and its code", "fill both cells, or leave the row out");
    for (const analysis::WordCode& before : codes)
      if (before.words == each.words && before.code != each.code)
        return analysis::table_error(*table, row, "this word has another code above", "keep one of them",
                                     table->cell(row, *word));
    codes.push_back(std::move(each));
  }
  return codes;
}

/// A row that makes no sense is an error that was found, and no word of the command.
int refuse_study(const Error& error) {
  const int status = refuse(error);
  return error.place.number ? refused : status;
}

/// The option that gave what is wrong at a place of a record; empty if none did.
std::string option_at(std::string_view line, std::string_view wrong, const StudyChoice& choice, const FitRequest& request) {
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  const auto is_about = [&](const char* word) { return line.starts_with(word); };
  if (is_about("domain")) return "--domain";
  if (is_about("name")) return "--name";
  const bool is_size = is_about("law") || is_about("valid") || is_about("quantity") || is_about("floor") ||
                       std::ranges::any_of(request.columns.sizes, [&](const auto& each) { return each.name == wrong; });
  if (!choice.carrier.empty() && (is_size || wrong == choice.carrier)) return "--carrier";
  if (is_size) return choice.sizes.empty() ? "" : "--size";
  return is_about("export") && !choice.about.empty() ? "--of" : "";
}

/// The first error in a record as the compiler finds it.
std::optional<Error> problem_of(const std::string& record, const StudyChoice& choice, const FitRequest& request) {
  SourceSet sources;
  Diagnostics diagnostics;
  const auto resolver = file_resolver({});
  check_source(sources, sources.add("the record", record), *resolver, diagnostics);
  for (const Diagnostic& each : diagnostics.all()) {
    if (severity_of(each.code) != Severity::error) continue;
    const std::string option = option_at(sources.line(each.span), sources.text(each.span), choice, request);
    return Error{.code = each.code,
                 .sentence = "the record does not compile: " + each.message,
                 .mend = each.help,
                 .place = {.name = option.empty() ? choice.files.front() : option}};
  }
  return std::nullopt;
}

}  // namespace

void offer_study(CLI::App& verb, StudyChoice& choice) {
  must_say(verb.add_option(
               "TRIALS", choice.files,
               "logs of `wale experiment run`, tables of `wale experiment export` (_beh.tsv, with the .json beside), "
               "or other tables with a header, as PsychoPy's wide CSV"),
           "the path of a file of trials")
      ->required();
  must_say(
      verb.add_option("--design", choice.design,
                      "the Wale file that declares the experiment: its task and units, where the files do not say them")
          ->type_name("FILE"),
      "the path of a Wale file");
  must_say(verb.add_option("--experiment", choice.experiment,
                           "which experiment of --design (default: that of the trials, else its first)")
               ->type_name("NAME"),
           "the name of an experiment");
  must_say(verb.add_option("--stimuli", choice.stimuli,
                           "a table with a column `stimulus` and the sizes of each, for designs whose stimuli are "
                           "named and have no factors")
               ->type_name("FILE"),
           "the path of a table");
  must_say(verb.add_option("--codes", choice.codes,
                           "a table with the columns `word` and `code`: the words of descriptions that mean one thing are "
                           "counted as their code")
               ->type_name("FILE"),
           "the path of a table");
  offer_name(verb, "--model", choice.model, {"mixed", "thesis", "thesis_equalised"},
             "where a map's law comes from (default: mixed); thesis is least squares of means, as Minsky 1995 has it");
  offer_name(verb, "--task", choice.task, {std::begin(trial_task_names), std::end(trial_task_names)},
             "what the participants did, if neither trials nor design say it");
  verb.add_option("--size", choice.sizes,
                  "a size that was varied, as NAME, NAME:UNIT, NAME=COLUMN or NAME=COLUMN:UNIT; may be repeated "
                  "(default: those of the design)")
      ->type_name("NAME=COLUMN:UNIT");
  verb.add_option("--factor", choice.factors, "a column of words that was varied; may be repeated")
      ->type_name("COLUMN");
  must_say(verb.add_option("--participant", choice.participant, "the column of the participant (default: participant)")
               ->type_name("COLUMN"),
           "the name of a column");
  must_say(
      verb.add_option("--answer", choice.answer, "the column of the answer (default: response; correct for thresholds)")
          ->type_name("COLUMN"),
      "the name of a column");
  must_say(verb.add_option("--run", choice.run, "the column of the run (default: run, if there is one)")
               ->type_name("COLUMN"),
           "the name of a column");
  must_say(
      verb.add_option("--trial", choice.trial, "the column of the trial's number (default: trial, if there is one)")
          ->type_name("COLUMN"),
      "the name of a column");
  verb.add_option("--keep", choice.keep, "only rows whose column has this text, COLUMN=TEXT; may be repeated")
      ->type_name("COLUMN=TEXT");
  verb.add_option("--drop", choice.drop, "no rows whose column has this text, COLUMN=TEXT; may be repeated")
      ->type_name("COLUMN=TEXT");
  verb.add_flag("--leave-out-nonpositive", choice.leave_out_nonpositive,
                "excludes magnitudes of zero and below, which are otherwise refused; the report says how many");
  must_say(verb.add_option("--over", choice.over,
                           "the size that is sought (default: of maps the first, of thresholds that with most levels)")
               ->type_name("NAME"),
           "the name of a size");
  offer_number(
      verb, "--standard", choice.standard, {.least = 0, .most = 1e9, .example = 0.8},
      "what the sizes of a threshold are compared with, in their unit; 0: nothing (default: as the trials say)");
  must_say(verb.add_option("--of", choice.about,
                           "the percept of a map (default: roughness), the cue of a threshold, the name of a rule")
               ->type_name("NAME"),
           "a name");
  must_say(verb.add_option("--carrier", choice.carrier, "the argument of the map's percept (default: the size's name)")
               ->type_name("NAME"),
           "a name");
  must_say(verb.add_option("--name", choice.name, "the name of the map (default: EXPERIMENT.MODEL)")->type_name("NAME"),
           "a name");
  must_say(verb.add_option("--domain", choice.domain,
                           "the kind of the stimuli, as in \"grating, one_dimensional, alone\" (default: not stated)")
               ->type_name("WORDS"),
           "words of a domain");
  offer_library(verb, choice.opened.folders);
  offer_sandbox(verb, choice.opened.sandbox);
}

OrStatus<FittedStudy> fitted_study(const StudyChoice& choice) {
  FittedStudy made;
  auto request = request_of(choice);
  if (!request) {
    refuse(request.error());
    return misused;
  }
  made.request = *std::move(request);
  if (!choice.codes.empty()) {
    auto codes = read_codes(choice.codes);
    if (!codes) return refuse_study(codes.error());
    made.request.codes = *std::move(codes);
  }
  auto study = read_study(choice.files, choice.stimuli);
  if (!study) return refuse_study(study.error());
  made.study = *std::move(study);
  if (!choice.design.empty()) {
    Choice opened = choice.opened;
    opened.file = choice.design;
    auto file = open(opened);
    if (!file) return file.status();
    auto found = experiment_in(*file, choice.experiment.empty() ? made.study.experiment : choice.experiment);
    if (!found) return refuse(found.error());
    add_design(made.study, facts_of(**found));
    if (made.study.design.empty()) made.study.design = file->sources[file->source].text;
    made.design = *std::move(file);
  }
  auto fit = fit_study(made.study, made.request);
  if (!fit) {
    Error error = fit.error();
    if (error.place.name.empty()) error.place.name = choice.files.front();  // of what all trials together do not say
    return refuse_study(error);
  }
  made.fit = *std::move(fit);
  if (!made.fit.no_record.empty()) return made;
  auto record = record_of(made.study, made.fit, made.request);
  if (!record) return refuse_study(record.error());
  made.record = *std::move(record);
  made.record_problem = problem_of(made.record, choice, made.request);
  return made;
}

}  // namespace wale::command
