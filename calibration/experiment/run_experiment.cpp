#include "calibration/experiment/run_experiment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "compiler/text/readable.hpp"

namespace wale {
namespace {

using Json = nlohmann::ordered_json;

double steady_seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

Json levels_json(const CheckedExperiment& experiment, const ExperimentStimulus& stimulus) {
  Json levels = Json::object();
  for (std::size_t i = 0; i < stimulus.levels.size(); ++i) {
    if (!stimulus.levels[i]) continue;
    const ExperimentFactor& factor = experiment.factors[i];
    const ExperimentLevel& level = factor.levels[*stimulus.levels[i]];
    if (level.value) levels[factor.name] = {{"value", *level.value}, {"unit", factor.unit}, {"text", level.text}};
    else levels[factor.name] = {{"text", level.text}};
  }
  return levels;
}

/// Runs one session. Functions return an error that ends it.
class Run {
 public:
  Run(const ReadyExperiment& ready, TrialSession& session, SessionLog& log, Presenter& presenter,
      Participant& participant)
      : ready_(ready),
        experiment_(*ready.experiment),
        session_(session),
        log_(log),
        presenter_(presenter),
        participant_(participant) {}

  Result<> all() {
    if (const auto begun = begin(); !begun) return begun;
    rested_ = steady_seconds();
    if (experiment_.task == TrialTask::sorting) {
      while (const auto sort = session_.next_sort())
        if (const auto done = run(*sort); !done) return done;
    } else {
      while (const auto trial = session_.next_trial()) {
        if (const auto rested = rest_before(*trial); !rested) return rested;
        if (const auto done = run(*trial); !done) return done;
      }
    }
    return close();
  }

 private:
  Result<std::uint64_t> write(const SessionEvent& event) {
    const auto line = log_.append(event);
    if (line) session_.take({.number = *line, .time = {}, .seconds = 0, .event = event});
    return line;
  }
  Result<> note(const std::string& text) {
    const auto line = write(SessionNote{text});
    return line ? Result<>() : Result<>(line.error());
  }

  Result<> begin() {
    if (experiment_.masking_required || !experiment_.masking.empty())
      participant_.tell(experiment_.masking.empty()
                            ? "This experiment needs masking noise, and names no sound: play some in headphones now."
                            : fmt::format("Play {} in headphones now{}.", experiment_.masking,
                                          experiment_.masking_required ? ", which this experiment requires" : ""));
    if (!experiment_.grip.empty()) participant_.tell(fmt::format("Hold the handle so: {}.", experiment_.grip));
    for (const std::string& page : experiment_.instructions) {
      const auto read = participant_.say({.kind = Question::Kind::page, .says = page});
      if (!read) return read.error();
    }
    if (experiment_.consent.empty() || session_.has_consent()) return {};
    for (;;) {
      const auto said = participant_.say({.kind = Question::Kind::consent, .says = experiment_.consent});
      if (!said) return said.error();
      const auto agreed = checked_response(ResponseKind::yes_no, *said);
      if (!agreed) {
        participant_.refuse(agreed.error().sentence);
        continue;
      }
      if (const auto line = write(SessionAnswer{"consent", "session", *agreed}); !line) return line.error();
      if (*agreed == "yes") return {};
      return Error{.code = Code::stopped, .sentence = "the participant does not agree"};
    }
  }

  Result<> rest_before(const Trial& trial) {
    const bool new_block = trial.block > 1 && trial.block != block_ && block_ != 0;
    block_ = trial.block;
    const bool due = experiment_.pause_after > 0 ? steady_seconds() - rested_ >= experiment_.pause_after : new_block;
    if (experiment_.pause <= 0 || !due) return {};
    if (const auto noted = note("break"); !noted) return noted;
    const auto rested = participant_.say({.kind = Question::Kind::rest, .seconds = experiment_.pause});
    rested_ = steady_seconds();
    return rested ? Result<>() : Result<>(rested.error());
  }

  const ExperimentStimulus& thing(const Presented& presented) const {
    return (presented.is_standard ? experiment_.standards : experiment_.stimuli)[presented.index];
  }
  const Program& program(const Presented& presented) const {
    return (presented.is_standard ? ready_.standards : ready_.stimuli)[presented.index];
  }

  Result<> present(const Presented& presented, std::uint32_t number, std::uint32_t interval, const std::string& label) {
    const std::string recording = presenter_.recording_of(
        program(presented), interval == 0 ? fmt::format("t{:04}", number) : fmt::format("t{:04}-{}", number, interval));
    const auto line = write(SessionShown{.what = presented.is_standard ? "standard" : "stimulus",
                                         .name = thing(presented).name,
                                         .label = label,
                                         .number = number,
                                         .interval = interval,
                                         .recording = recording});
    if (!line) return line.error();
    const auto felt = presenter_.present(program(presented), recording);
    if (!felt) return felt.error();
    participant_.felt(presented, *felt);
    return {};
  }

  Result<> present(const Trial& trial) {
    const int count = static_cast<int>(trial.intervals.size());
    for (int i = 0; i < count; ++i) {
      participant_.begin(trial, is_adaptive(experiment_) ? 0 : session_.known_trials(), i + 1, count);
      const auto felt = present(trial.intervals[static_cast<std::size_t>(i)], trial.number,
                                count > 1 ? static_cast<std::uint32_t>(i + 1) : 0, "");
      if (!felt) return felt;
    }
    return {};
  }

  Result<> run(const Trial& trial) {
    if (const auto felt = present(trial); !felt) return felt;
    for (;;) {
      const auto open = session_.open_questions(trial);
      if (open.empty()) return {};
      const Asked& asked = open.front();
      if (experiment_.task == TrialTask::adjustment && asked.name == "response") {
        if (const auto adjusted = adjust(trial); !adjusted) return adjusted;
        continue;
      }
      const auto said =
          participant_.say({.kind = Question::Kind::trial, .says = asked.says, .asked = &asked, .trial = &trial});
      if (!said) return said.error();
      if (*said == "again") {
        if (const auto felt = present(trial); !felt) return felt;
        continue;
      }
      if (*said == "back") {
        const auto lines = session_.latest_answers();
        if (lines.empty()) {
          participant_.refuse("there is no answer to take back");
          continue;
        }
        if (const auto line = write(SessionTakenBack{lines}); !line) return line.error();
        return {};  // the trial whose answers they were comes next
      }
      const auto response = checked_response(asked.kind, *said);
      if (!response) {
        participant_.refuse(response.error().sentence + "; `back` takes the last answer back, `again` feels it again");
        continue;
      }
      if (const auto line = write(SessionAnswer{asked.name, std::to_string(trial.number), *response}); !line)
        return line.error();
    }
  }

  /// Lets the participant move along the factor until the stimulus is like the standard. The answer is its level, SI.
  Result<> adjust(const Trial& trial) {
    const auto tracks = tracks_of(experiment_);
    const auto track = std::ranges::find_if(
        tracks, [&](const auto& each) { return std::ranges::find(each, trial.stimulus) != each.end(); });
    auto at = std::ranges::find(*track, trial.stimulus) - track->begin();
    const auto last = static_cast<std::ptrdiff_t>(track->size()) - 1;
    const std::ptrdiff_t leap = std::max<std::ptrdiff_t>(2, (last + 1) / 5);
    for (;;) {
      const auto said = participant_.say(
          {.kind = Question::Kind::adjust,
           .says = experiment_.ask.empty() ? "Make the second like the first: + more, - less, ++ or -- by much, again, done"
                                           : experiment_.ask,
           .trial = &trial});
      if (!said) return said.error();
      if (*said == "done") break;
      const auto before = at;
      if (*said == "+") ++at;
      else if (*said == "-") --at;
      else if (*said == "++") at += leap;
      else if (*said == "--") at -= leap;
      else if (*said != "again") {
        participant_.refuse("expected +, -, ++, --, again or done");
        continue;
      }
      at = std::clamp<std::ptrdiff_t>(at, 0, last);
      if (at == before && *said != "again") {
        participant_.refuse("there is no more in this direction; `done` takes it as it is");
        continue;
      }
      Trial now = trial;
      now.intervals.back() = {false, (*track)[static_cast<std::size_t>(at)]};
      if (const auto felt = present(now); !felt) return felt;
    }
    const std::size_t stimulus = (*track)[static_cast<std::size_t>(at)];
    const auto& factor = experiment_.factors[*experiment_.over];
    const double level = factor.levels[*experiment_.stimuli[stimulus].levels[*experiment_.over]].value.value_or(0);
    const auto line = write(SessionAnswer{"response", std::to_string(trial.number), fmt::format("{}", level)});
    return line ? Result<>() : Result<>(line.error());
  }

  std::string sort_words(const Sort& sort) const {
    std::string says = sort.groups ? fmt::format("Sort all into {} groups.", *sort.groups) : "Sort all into groups.";
    if (!experiment_.ask.empty()) says = experiment_.ask + " " + says;
    says += "\n ";
    for (std::size_t i = 0; i < sort.labels.size(); ++i) {
      const auto pile = sort.piles.find(i);
      says += fmt::format(" {}{}", sort.labels[i], pile == sort.piles.end() ? "" : fmt::format(":{}", pile->second));
    }
    return says + "\n  483: feel it; 483 2: into group 2 (0: into none); name 2 WORDS; done:";
  }

  Result<> run(const Sort& first) {
    const std::uint32_t number = first.number;
    SessionOrder labels{.what = "labels", .of = experiment_.name, .seed = number, .items = {}};
    for (std::size_t i = 0; i < first.labels.size(); ++i)
      labels.items.push_back({experiment_.stimuli[i].name, first.labels[i], {}});
    if (const auto line = write(labels); !line) return line.error();
    for (;;) {
      const auto sort = session_.next_sort();
      if (!sort || sort->number != number) return {};
      const auto said = participant_.say({.kind = Question::Kind::sort, .says = sort_words(*sort), .sort = &*sort});
      if (!said) return said.error();
      if (const auto done = obey(*sort, *said); !done) return done;
    }
  }

  Result<> obey(const Sort& sort, const std::string& said) {
    const auto space = said.find(' ');
    const std::string word = said.substr(0, space);
    const std::string rest = space == std::string::npos ? "" : said.substr(said.find_first_not_of(' ', space) == std::string::npos
                                                                                ? said.size()
                                                                                : said.find_first_not_of(' ', space));
    if (word == "done" && rest.empty()) return finish(sort);
    if (word == "name") {
      const auto next = rest.find(' ');
      const auto pile = pile_in(rest.substr(0, next));
      const auto text = next == std::string::npos ? Result<std::string>(Error{})
                                                  : checked_response(ResponseKind::text, rest.substr(next));
      if (!pile || *pile == 0 || !text) {
        participant_.refuse("expected the number of a group and what it is called, as in `name 2 quite rough`");
        return {};
      }
      const auto line = write(SessionAnswer{"label", std::to_string(*pile), *text});
      return line ? Result<>() : Result<>(line.error());
    }
    const auto label = std::ranges::find(sort.labels, word);
    if (label == sort.labels.end()) {
      participant_.refuse("expected one of the numbers above, `name`, or `done`");
      return {};
    }
    const auto index = static_cast<std::size_t>(label - sort.labels.begin());
    if (rest.empty()) {
      const Trial felt{sort.number, 1, index, {{false, index}}, 0};
      participant_.begin(felt, 0, 1, 1);
      return present({false, index}, 0, 0, word);
    }
    const auto pile = pile_in(rest);
    if (!pile || (sort.groups && *pile > *sort.groups)) {
      participant_.refuse(sort.groups ? fmt::format("expected a group from 1 to {}, or 0", *sort.groups)
                                      : std::string("expected the number of a group"));
      return {};
    }
    const auto line = write(SessionAnswer{"pile", experiment_.stimuli[index].name, std::to_string(*pile)});
    return line ? Result<>() : Result<>(line.error());
  }

  static std::optional<int> pile_in(const std::string& text) {
    int pile = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), pile);
    if (text.empty() || error != std::errc() || end != text.data() + text.size() || pile < 0 || pile > 1000)
      return std::nullopt;
    return pile;
  }

  Result<> finish(const Sort& sort) {
    std::map<int, SessionGroups::Group> groups;
    for (const auto& [stimulus, pile] : sort.piles) groups[pile].patches.push_back(experiment_.stimuli[stimulus].name);
    if (sort.piles.size() < experiment_.stimuli.size()) {
      participant_.refuse(fmt::format("{} are in no group yet", experiment_.stimuli.size() - sort.piles.size()));
      return {};
    }
    if (sort.groups && groups.size() != static_cast<std::size_t>(*sort.groups)) {
      participant_.refuse(fmt::format("expected {} groups, found {}", *sort.groups, groups.size()));
      return {};
    }
    SessionGroups done{.name = fmt::format("sort_{}", sort.number), .workspace = experiment_.name, .groups = {}};
    for (auto& [pile, group] : groups) {
      if (const auto says = sort.says.find(pile); says != sort.says.end()) group.says = says->second;
      done.groups.push_back(std::move(group));
    }
    const auto line = write(done);
    return line ? Result<>() : Result<>(line.error());
  }

  Result<> close() {
    for (;;) {
      const auto open = session_.open_closing();
      if (open.empty()) break;
      const Asked& asked = open.front();
      const auto said = participant_.say({.kind = Question::Kind::closing, .says = asked.says, .asked = &asked});
      if (!said) return said.error();
      const auto response = checked_response(asked.kind, *said);
      if (!response) {
        participant_.refuse(response.error().sentence);
        continue;
      }
      if (const auto line = write(SessionAnswer{asked.name, "session", *response}); !line) return line.error();
    }
    const auto line = write(SessionEnd{"done"});
    return line ? Result<>() : Result<>(line.error());
  }

  const ReadyExperiment& ready_;
  const CheckedExperiment& experiment_;
  TrialSession& session_;
  SessionLog& log_;
  Presenter& presenter_;
  Participant& participant_;
  double rested_ = 0;
  std::uint32_t block_ = 0;
};

}  // namespace

Result<> log_design(SessionLog& log, const ReadyExperiment& ready, std::uint32_t seed) {
  const CheckedExperiment& experiment = *ready.experiment;
  Json questions = Json::array(), closing = Json::array();
  for (const Asked& each : questions_of_trial(experiment)) questions.push_back({{"name", each.name}, {"says", each.says}});
  for (const Asked& each : closing_questions(experiment)) closing.push_back({{"name", each.name}, {"says", each.says}});
  Json design = {{"name", experiment.name},
                 {"task", trial_task_names[static_cast<std::size_t>(experiment.task)]},
                 {"method", trial_method_names[static_cast<std::size_t>(experiment.method)]},
                 {"questions", questions},
                 {"closing", closing},
                 {"presentation_seconds", experiment.seconds},
                 {"practice", experiment.practice}};
  if (!is_adaptive(experiment))
    design["block"] = experiment.task == TrialTask::adjustment ? tracks_of(experiment).size() : experiment.stimuli.size();
  if (experiment.modulus) design["modulus"] = *experiment.modulus;
  if (experiment.over) design["over"] = experiment.factors[*experiment.over].name;
  if (experiment.longest) design["longest"] = *experiment.longest;
  if (!experiment.grip.empty()) design["grip"] = experiment.grip;
  design["motion"] = experiment.motion;
  design["text"] = ready.text;
  const auto written = [&](const SessionEvent& event) -> Result<> {
    const auto line = log.append(event);
    return line ? Result<>() : Result<>(line.error());
  };
  if (const auto done = written(SessionOther{"design", design.dump(-1, ' ', false, Json::error_handler_t::replace)}); !done)
    return done;
  for (const bool standard : {false, true}) {
    const auto& things = standard ? experiment.standards : experiment.stimuli;
    const auto& programs = standard ? ready.standards : ready.stimuli;
    for (std::size_t i = 0; i < things.size(); ++i) {
      if (const auto done = written(SessionProgram{things[i].name, things[i].made_of, program_hash(programs[i])}); !done)
        return done;
      Json stimulus = {{"name", things[i].name}, {"levels", levels_json(experiment, things[i])}};
      if (things[i].standard) stimulus["standard"] = experiment.standards[*things[i].standard].name;
      if (const auto done = written(SessionOther{"stimulus", stimulus.dump()}); !done) return done;
    }
  }
  SessionOrder order{.what = "trials", .of = experiment.name, .seed = seed, .items = {}};
  for (const Trial& each : trial_order(experiment, seed)) {
    SessionItem item{experiment.stimuli[each.stimulus].name, {}, {}};
    if (each.intervals.size() > 1 || experiment.task == TrialTask::one_interval) item.label = std::to_string(each.target);
    order.items.push_back(std::move(item));
  }
  return order.items.empty() ? Result<>() : written(order);
}

Result<> is_same_design(const SessionRecord& record, const ReadyExperiment& ready, const std::string& file) {
  const auto differs = [&](std::string sentence) {
    return Error{.code = Code::wrong_moment,
                 .sentence = std::move(sentence),
                 .mend = "go on with the files that it was begun with, or begin a new session",
                 .place = {.name = file}};
  };
  const auto* begin = std::get_if<SessionBegin>(&record.entries.front().event);
  const CheckedExperiment& experiment = *ready.experiment;
  if (begin == nullptr || begin->experiment != experiment.name)
    return differs(fmt::format("this is no session of `{}`", experiment.name));
  std::size_t known = 0;
  bool has_design = false;
  std::map<std::string, std::uint64_t> hashes;
  for (const SessionEntry& entry : record.entries) {
    if (const auto* program = std::get_if<SessionProgram>(&entry.event)) hashes[program->patch] = program->hash;
    if (const auto* other = std::get_if<SessionOther>(&entry.event); other && other->event == "design") {
      has_design = true;
      const Json design = Json::parse(other->fields, nullptr, false);
      const auto text = design.find("text");
      if (text == design.end() || !text->is_string() || *text != ready.text)
        return differs("the design has changed since the session began");
    }
  }
  for (const bool standard : {false, true}) {
    const auto& things = standard ? experiment.standards : experiment.stimuli;
    const auto& programs = standard ? ready.standards : ready.stimuli;
    for (std::size_t i = 0; i < things.size(); ++i) {
      const auto found = hashes.find(things[i].name);
      if (found == hashes.end()) continue;
      ++known;
      if (found->second != program_hash(programs[i]))
        return differs(fmt::format("`{}` is another program than when the session began", things[i].name));
    }
  }
  if (!has_design || known < experiment.stimuli.size() + experiment.standards.size())
    return differs("the session was broken off before it had begun");
  return {};
}

Result<std::string> may_resume(const CheckedExperiment& experiment, double gap) {
  const InterruptedSession& allowed = experiment.interrupted;
  if (gap <= allowed.resume) return std::string("resume");
  if (gap <= allowed.repeat_practice) return std::string("practice");
  if (gap <= allowed.restart_block) return std::string("restart");
  return Error{.code = Code::wrong_moment,
               .sentence = allowed.restart_block > 0
                               ? readable("the session was broken off {:.0f} minutes ago, and may go on within {:.0f}",
                                          gap / 60, allowed.restart_block / 60)
                               : "a session of this experiment cannot go on after an interruption",
               .mend = "begin a new session"};
}

Result<ExperimentEnd> run_experiment(const ReadyExperiment& ready, TrialSession& session, SessionLog& log,
                                     Presenter& presenter, Participant& participant) {
  Run run(ready, session, log, presenter, participant);
  const auto done = run.all();
  ExperimentEnd end;
  (void)session.next_trial();
  end.trials = session.answered();
  if (done) return end;
  if (done.error().code != Code::stopped) return done.error();
  end.stopped = done.error();
  (void)log.append(SessionNote{"stopped: " + done.error().sentence});
  return end;
}

}  // namespace wale
