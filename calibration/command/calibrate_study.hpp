#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calibration/fit/study_fit.hpp"
#include "compiler/command/command.hpp"

namespace CLI {
class App;
}

namespace wale::command {

/// The words of `calibrate fit` and `calibrate report` that say which study it is and how it is read.
struct StudyChoice {
  std::vector<std::string> files, sizes, factors, keep, drop;
  std::string design, experiment, stimuli, codes, participant, answer, run, trial, task, model, over, about, carrier, name,
      domain;
  std::optional<double> standard;
  bool leave_out_nonpositive = false;
  Choice opened;  ///< of the design: folders and sandbox
};

void offer_study(CLI::App& verb, StudyChoice& choice);

/// A study that was read and fitted.
struct FittedStudy {
  Study study;
  FitRequest request;
  StudyFit fit;
  std::string record;                ///< as a Wale file; empty with `no_record`
  std::optional<Error> record_problem;  ///< why the record does not compile, and which option is at fault
  std::optional<OpenedFile> design;  ///< if it was named
};
OrStatus<FittedStudy> fitted_study(const StudyChoice& choice);

}  // namespace wale::command
