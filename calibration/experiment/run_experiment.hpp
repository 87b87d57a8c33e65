#pragma once

#include <string>
#include <vector>

#include "calibration/experiment/participant.hpp"
#include "calibration/experiment/presenter.hpp"
#include "wale/session_log.hpp"

namespace wale {

/// An experiment with the finished programs of its stimuli and standards, in their order.
struct ReadyExperiment {
  const CheckedExperiment* experiment = nullptr;
  std::vector<Program> stimuli, standards;
  std::string text;  ///< the design as written, with the materials of its file
};

/// What the note in a log begins with that says which planted observer answers, before its laws.
inline constexpr const char* observer_note = "observer ";

/// Writes what a log needs besides its first line, so that it alone tells the study: the design, its stimuli with their
/// levels and programs, and the order. Error: `unwritable_file`.
Result<> log_design(SessionLog& log, const ReadyExperiment& ready, std::uint32_t seed);

/// Whether a log was made by this design, with the same programs. Error: `wrong_moment`, with what differs.
Result<> is_same_design(const SessionRecord& record, const ReadyExperiment& ready, const std::string& file);

/// What an experiment says about going on after so many seconds: "resume", "practice", "restart". Error:
/// `wrong_moment` if the session is too old.
Result<std::string> may_resume(const CheckedExperiment& experiment, double gap);

/// How a run ended.
struct ExperimentEnd {
  std::size_t trials = 0;         ///< that were answered, in all runs of the session
  std::optional<Error> stopped;   ///< why it ended before the last trial; the session may go on later
};

/// Runs the experiment to its end, or to that of the participant's patience. Each line is on the disk before the next
/// presentation. `session` has taken all lines of the log so far. Errors: those of the log and of the presenter.
Result<ExperimentEnd> run_experiment(const ReadyExperiment& ready, TrialSession& session, SessionLog& log,
                                     Presenter& presenter, Participant& participant);

}  // namespace wale
