#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/compile.hpp"

namespace wale {

/// A stimulus built for a device, and what the compiler says of it.
struct MadeStimulus {
  std::optional<Program> program;  ///< empty after an error
  std::vector<Diagnostic> said;
};

/// The stimuli and standards of an experiment, in their order.
struct MadeExperiment {
  std::vector<MadeStimulus> stimuli, standards;

  /// Whether all of them could be built.
  bool is_whole() const;
};

/// Builds all stimuli of an experiment for a device.
MadeExperiment compile_experiment(const CheckedExperiment& experiment, const CheckedModule& module,
                                  const std::string& device, const SourceSet& sources, SourceId source,
                                  Resolver& resolver);

/// The experiment that the option `--experiment` names, or with an empty name the first one of the file; W0201 if there
/// is none, whose mend has the nearest name or all of them. `file` is the file's name in the error.
Result<const CheckedExperiment*> find_experiment(const CheckedModule& module, const std::string& name,
                                                 const std::string& file);

}  // namespace wale
