#pragma once

#include <string>

#include "calibration/experiment/run_experiment.hpp"
#include "compiler/command/command.hpp"
#include "compiler/compile_experiment.hpp"

namespace wale::command {

/// The experiment of an opened file that an option names, or its first one. Errors: W0201; W0801 for a patch program.
Result<const CheckedExperiment*> experiment_in(const OpenedFile& opened, const std::string& name);

/// Builds the experiment for the device of `choice`. All diagnostics of the file and of its stimuli are printed; errors
/// end the command.
OrStatus<ReadyExperiment> ready_experiment(const OpenedFile& opened, const std::string& name, const Choice& choice);

}  // namespace wale::command
