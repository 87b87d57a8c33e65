#pragma once

#include <string>
#include <vector>

#include "compiler/compile_experiment.hpp"

namespace wale {

/// Two stimuli of an experiment that people hardly tell apart.
struct AlikePair {
  std::string a, b;
  double noticeable = 0;  ///< in just noticeable differences at d' = 1, below 1
};

/// A stimulus that the device does not render as written, and why.
struct UnrenderedStimulus {
  std::string name, why;
  bool is_built = false;  ///< it can be presented, but is not what it says
};

/// An experiment on a device.
struct ExperimentDescription {
  std::string name, documentation, device, task;
  std::size_t stimuli = 0, standards = 0, practice = 0, blocks = 0;
  std::size_t trials = 0;    ///< practice included; of an adaptive method at most
  bool at_most = false;      ///< the answers decide how many there are
  double seconds = 0;        ///< that a session takes, breaks included, with the assumed times for answers
  double presentation = 0, to_and_fro = 0;  ///< s, of one presentation, and of one movement of the simulated hand
  bool is_short() const { return presentation < to_and_fro; }  ///< so that a hand passes over a part of it only
  std::vector<std::string> factors;  ///< "amplitude 0.2 N, 0.8 N, 2 N"
  std::size_t pairs = 0;             ///< that were compared
  std::size_t alike = 0;             ///< of them, under one just noticeable difference
  std::vector<AlikePair> nearest;    ///< the nearest of these
  std::vector<UnrenderedStimulus> unrendered;
};

/// s that a participant is assumed to take for an answer to a task, besides what is presented. No source.
double assumed_answer_seconds(TrialTask task);

/// Describes an experiment by its finished programs.
ExperimentDescription describe_experiment(const CheckedExperiment& experiment, const MadeExperiment& made,
                                          const std::string& device, const Declarations& declarations);

/// The description as text for people.
std::string experiment_text(const ExperimentDescription& description);
/// JSON: an object for one description, an array for several.
std::string experiments_json(const std::vector<ExperimentDescription>& descriptions);

}  // namespace wale
