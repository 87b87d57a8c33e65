#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>

#include "calibration/command/experiment_file.hpp"
#include "calibration/command/feel_run.hpp"
#include "calibration/command/interrupt.hpp"
#include "calibration/command/trusted_here.hpp"
#include "calibration/experiment/planted_observer.hpp"
#include "calibration/experiment/terminal_participant.hpp"
#include "compiler/command/options.hpp"
#include "compiler/command/print.hpp"
#include "compiler/declarations/declared_devices.hpp"
#include "compiler/text/readable.hpp"
#include "schema/spelling.hpp"
#include "schema/visible_text.hpp"

namespace wale::command {
namespace {

struct ExperimentRunOptions {
  Choice choice;
  std::string experiment, participant, device, observer, log;
  std::vector<std::string> trusted;
  std::optional<std::uint64_t> seed;
  std::optional<double> max_force;
  bool resume = false, unrecorded = false;
};

constexpr std::string_view planted = "planted:";

/// Checks an identifier: it becomes a part of file names, and of BIDS labels.
Result<> is_identifier(const std::string& text) {
  const auto plain = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  if (text.size() <= 64 && std::ranges::all_of(text, plain)) return {};
  return Error{.code = Code::malformed_value,
               .sentence = fmt::format("an identifier has at most 64 letters and digits, found `{}`", visible_text(text)),
               .mend = "write, for example, `--participant S48`; not the person's name",
               .place = {.name = "--participant"}};
}

/// Who answers: a planted observer, if one was asked for.
Result<std::optional<PlantedLaw>> planted_law(const std::string& observer) {
  if (observer.empty()) return std::optional<PlantedLaw>();
  if (observer != "planted" && !observer.starts_with(planted))
    return Error{.code = Code::malformed_value,
                 .sentence = fmt::format("expected `planted` or `planted:…`, found `{}`", visible_text(observer)),
                 .mend = "write, for example, `--observer planted:exponent=0.55,noise=0.2`",
                 .place = {.name = "--observer"}};
  const auto law = read_planted_law(observer == "planted" ? "" : std::string_view(observer).substr(planted.size()));
  if (!law) return law.error();
  return std::optional(*law);
}

/// The log to go on in, or a new one, and where the session stands.
struct BegunSession {
  SessionLog log;
  TrialSession session;
  std::uint32_t seed;
};

Result<BegunSession> begin_anew(const ExperimentRunOptions& options, const ReadyExperiment& ready, const std::string& path,
                                const std::string& device, const std::string& grade) {
  SessionBegin begin;
  begin.participant = options.participant;
  begin.seed = options.seed ? static_cast<std::uint32_t>(*options.seed) : std::random_device{}();
  begin.device = device;
  begin.file = options.choice.file;
  begin.versions = {{"wale", WALE_VERSION}};
  begin.experiment = ready.experiment->name;
  begin.grade = grade;
  auto log = SessionLog::create(path, begin);
  if (!log) {
    Error error = log.error();
    if (error.code == Code::unwritable_file && std::filesystem::exists(path))
      error.mend = "`--resume` goes on in it if it was broken off; otherwise give another name with --log";
    return error;
  }
  if (const auto written = log_design(*log, ready, begin.seed); !written) {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);  // nothing has been felt or answered yet
    return written.error();
  }
  if (!options.observer.empty())
    if (const auto noted = log->append(SessionNote{observer_note + options.observer}); !noted) return noted.error();
  return BegunSession{*std::move(log), TrialSession(*ready.experiment, begin.seed), begin.seed};
}

Result<BegunSession> go_on(const ExperimentRunOptions& options, const ReadyExperiment& ready, const std::string& path,
                           const std::string& device, const std::string& grade) {
  auto resumed = SessionLog::resume(path);
  if (!resumed) return resumed.error();
  const SessionRecord& record = resumed->record;
  if (const auto same = is_same_design(record, ready, path); !same) return same.error();
  const auto& begin = std::get<SessionBegin>(record.entries.front().event);
  const auto differs = [&](const char* what, const std::string& then, const std::string& now) {
    return Error{.code = Code::wrong_moment,
                 .sentence = fmt::format("the session was begun with the {} `{}`, not `{}`", what, visible_text(then), now),
                 .mend = "go on as it was begun, or begin a new session",
                 .place = {.name = path}};
  };
  if (begin.participant != options.participant) return differs("participant", begin.participant, options.participant);
  if (begin.device != device) return differs("device", begin.device, device);
  if (begin.grade != grade) return differs("grade", begin.grade, grade);
  if (options.seed && *options.seed != begin.seed)
    return differs("seed", std::to_string(begin.seed), std::to_string(*options.seed));
  std::string observer;
  for (const SessionEntry& each : record.entries)
    if (const auto* note = std::get_if<SessionNote>(&each.event); note && note->text.starts_with(observer_note))
      observer = note->text.substr(std::char_traits<char>::length(observer_note));
  if (observer != options.observer)
    return differs("observer", observer.empty() ? "none" : observer, options.observer.empty() ? "none" : options.observer);
  const auto how = may_resume(*ready.experiment, resumed->gap);
  if (!how) {
    Error error = how.error();
    error.place.name = path;
    return error;
  }
  BegunSession begun{std::move(resumed->log), TrialSession(*ready.experiment, begin.seed), begin.seed};
  for (const SessionEntry& each : record.entries) begun.session.take(each);
  const auto write = [&](const SessionEvent& event) -> Result<> {
    const auto line = begun.log.append(event);
    if (!line) return line.error();
    begun.session.take({.number = *line, .time = {}, .seconds = 0, .event = event});
    return {};
  };
  if (const auto done = write(SessionResumed{resumed->gap, *how}); !done) return done.error();
  if (*how != "resume") {
    const auto lines = begun.session.answers_of_block(*how == "practice" ? 0 : begun.session.block());
    if (!lines.empty())
      if (const auto done = write(SessionTakenBack{lines}); !done) return done.error();
  }
  return begun;
}

std::string log_path(const ExperimentRunOptions& options, const CheckedExperiment& experiment) {
  return options.log.empty() ? fmt::format("{}-{}.trials", experiment.name, options.participant) : options.log;
}

int experiment_run(const ExperimentRunOptions& options) {
  const std::atomic<bool>& stop = stop_on_signals();
  if (const auto fit = is_identifier(options.participant); !fit) return refuse(fit.error());
  const auto law = planted_law(options.observer);
  if (!law) return refuse(law.error());
  const bool is_planted = law->has_value();
  auto trusted = trusted_here(options.trusted);
  if (!trusted) return refuse(trusted.error());
  warn_of_unused(*trusted);
  Choice built = options.choice;
  built.device.clear(), built.device_option.clear();
  built.devices = trusted->files, built.knows_owners = false;
  const auto opened = open(built);
  if (!opened) return opened.status();
  if (const auto found = experiment_in(*opened, options.experiment); !found) return refuse(found.error());
  const auto known = declared_devices(opened->module->declarations());
  auto chosen = device_to_feel({.spelling = options.device.empty() ? (is_planted ? "simulated" : "auto") : options.device,
                                .built_for = {},
                                .transport = {},
                                .only_simulated = is_planted,
                                .only_in_program = {}},
                               known, trusted->devices, std::nullopt, say, stop);
  if (!chosen) return refuse(chosen.error());
  const ChosenDevice& device = chosen->chosen;
  if (trusted->owners_problem && device.plugged) return refuse(*trusted->owners_problem);
  if (!device.said.empty()) say(device.said);
  built.device = device.declared ? device.declared->profile.name : default_device;
  const auto ready = ready_experiment(*opened, options.experiment, built);
  if (!ready) return ready.status();
  const CheckedExperiment& experiment = *ready->experiment;

  // Only people on a plugged device that is felt, by a declaration that its owner trusts, give evidence about people.
  const bool is_felt = device.plugged && device.plugged->driver->is_felt && device.trusted && !is_planted;
  const std::string grade = is_felt ? "measured" : "simulated";
  const std::string path = log_path(options, experiment);
  auto begun = options.resume ? go_on(options, *ready, path, built.device, grade)
                              : begin_anew(options, *ready, path, built.device, grade);
  if (!begun) return refuse(begun.error());

  const HandDeclaration* person = declared_everywhere()->declarations.hands.find("normal");
  const FeltOptions how{.hand = experiment.motion == "circular" ? "circular" : "lateral",
                        .virtual_time = is_planted,
                        .transport = {},
                        .most_newton = options.max_force.value_or(HUGE_VAL)};
  const std::filesystem::path file(path);
  DevicePresenter presenter(
      [&](const Program& program) { return open_to_feel(*chosen, program.description(), *person, how, say, stop); },
      {.seconds = experiment.seconds,
       .virtual_time = is_planted,
       .most_newton = how.most_newton,
       .folder = file.parent_path().string(),
       .recordings = options.unrecorded ? "" : file.filename().string() + ".recordings",
       .stop = &stop});
  std::unique_ptr<Participant> participant;
  if (is_planted) participant = std::make_unique<PlantedObserver>(experiment, **law, begun->seed);
  else participant = std::make_unique<TerminalParticipant>(std::cin, std::cerr, isatty(fileno(stdin)));
  const auto end = run_experiment(*ready, begun->session, begun->log, presenter, *participant);
  if (!end) return refuse(end.error());
  if (end->stopped) {
    Error error = *end->stopped;
    error.sentence = readable("the session ended after {} trial{}: {}", end->trials, end->trials == 1 ? "" : "s",
                              error.sentence);
    error.mend = fmt::format("the same command with --resume goes on in {}", visible_text(path));
    return refuse(error);
  }
  print_out("{}: {} answered, {}; {} is the log\n", experiment.name,
            experiment.task == TrialTask::sorting ? readable("{} sorts", std::max<std::size_t>(1, experiment.groups.size()))
                                                  : readable("{} trials", end->trials),
            grade, visible_text(path));
  return done;
}

Run declare_experiment_run(CLI::App& verb) {
  const auto options = std::make_shared<ExperimentRunOptions>();
  must_say(verb.add_option("FILE", options->choice.file, "the Wale file that declares the experiment"),
           "the path of a Wale file")
      ->required();
  must_say(verb.add_option("--experiment", options->experiment, "which experiment of the file (default: its first)")
               ->type_name("NAME"),
           "the name of an experiment");
  must_say(verb.add_option("--participant", options->participant,
                           "an identifier of letters and digits, as in S48; not the person's name")
               ->type_name("ID"),
           "an identifier")
      ->required();
  verb.add_option("--device", options->device,
                  "where it is felt, as for `wale feel`: auto (default), the best joystick plugged in, else a simulated "
                  "one; simulated; simulated:falcon; a device of `wale devices`, of --devices or of the file itself")
      ->type_name("NAME");
  offer_trusted_files(verb, options->trusted);
  propose(must_say(verb.add_option("--observer", options->observer,
                                   "a simulated participant on a simulated device, in virtual time: planted, or with "
                                   "laws of its own (exponent, threshold, noise, waveform, period, carry, lapse, modulus; "
                                   "feels=interaction or actuator), as in planted:exponent=0.55,noise=0.2")
                       ->type_name("OBSERVER"),
                   "planted, or planted: and its laws"),
          {"planted"});
  offer_count(verb, "--seed", options->seed, {.least = 0, .most = 4294967295u},
              "gives the orders of an earlier session again (default: new ones)");
  offer_force(verb, "--max-force", options->max_force,
              "the largest force at the handle, as in \"3 N\" (default: the device's own)");
  must_say(verb.add_option("--log", options->log,
                           "the log of the session, a new file (default: EXPERIMENT-ID.trials in the current folder); "
                           "recordings of all presentations lie in LOG.recordings beside it")
               ->type_name("FILE"),
           "the path of a file");
  verb.add_flag("--resume", options->resume, "goes on in the log of a session that was broken off");
  verb.add_flag("--unrecorded", options->unrecorded, "records no presentation");
  offer_library(verb, options->choice.folders);
  offer_sandbox(verb, options->choice.sandbox);
  verb.footer(
      "Each answer is on the disk before the next presentation. At a question, `back` takes the last answer back, `again`\n"
      "feels the trial again, and `q` ends the session, which --resume goes on with.\n"
      "for example: wale experiment run calibration/experiments/crossed.wale --participant S48;\n"
      "             wale experiment run calibration/experiments/crossed.wale --participant P1 --observer planted");
  return [options] { return status_after_signals(experiment_run(*options)); };
}

}  // namespace

extern const Verb experiment_run_verb{"experiment-run", "runs an experiment with a participant, and logs all answers",
                                      declare_experiment_run};

}  // namespace wale::command
