#include "calibration/command/experiment_file.hpp"

#include <fmt/format.h>

#include <utility>

#include "compiler/modules/load_modules.hpp"

namespace wale::command {

Result<const CheckedExperiment*> experiment_in(const OpenedFile& opened, const std::string& name) {
  if (opened.module) return find_experiment(*opened.module, name, opened.name);
  return Error{.code = Code::malformed_value,
               .sentence = fmt::format("expected a Wale file, found `{}`, a patch program", opened.name),
               .mend = "name the Wale file that declares the experiment"};
}

OrStatus<ReadyExperiment> ready_experiment(const OpenedFile& opened, const std::string& name, const Choice& choice) {
  const auto found = experiment_in(opened, name);
  if (!found) return refuse(found.error());
  const FileRequest request = choice.recording_request();
  const auto resolver = file_resolver(request.roots, request.looked_for, request.sandbox, request.devices);
  MadeExperiment made =
      compile_experiment(**found, *opened.module, request.device, opened.sources, opened.source, *resolver);
  Diagnostics diagnostics = opened.diagnostics;
  for (auto* part : {&made.stimuli, &made.standards})
    for (const MadeStimulus& each : *part)
      for (const Diagnostic& said : each.said)
        if (!each.program || severity_of(said.code) == Severity::error) diagnostics.report(said);
  print_diagnostics(stderr, diagnostics, opened.sources);
  if (!made.is_whole()) return refused;
  ReadyExperiment ready;
  ready.experiment = *found;
  ready.text = opened.sources[opened.source].text;
  for (MadeStimulus& each : made.stimuli) ready.stimuli.push_back(*std::move(each.program));
  for (MadeStimulus& each : made.standards) ready.standards.push_back(*std::move(each.program));
  return ready;
}

}  // namespace wale::command
