#include "compiler/compile_experiment.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "schema/spelling.hpp"

namespace wale {

bool MadeExperiment::is_whole() const {
  const auto made = [](const MadeStimulus& each) { return each.program.has_value(); };
  return std::ranges::all_of(stimuli, made) && std::ranges::all_of(standards, made);
}

MadeExperiment compile_experiment(const CheckedExperiment& experiment, const CheckedModule& module,
                                  const std::string& device, const SourceSet& sources, SourceId source,
                                  Resolver& resolver) {
  MadeExperiment made;
  const auto make = [&](const ExperimentStimulus& stimulus) {
    Diagnostics diagnostics;
    CheckedMaterial material = *stimulus.material;
    material.name = stimulus.name, material.span = stimulus.span;
    auto program = compile_material(material, module, device, sources, source, resolver, diagnostics);
    return MadeStimulus{std::move(program), {diagnostics.all().begin(), diagnostics.all().end()}};
  };
  for (const ExperimentStimulus& each : experiment.stimuli) made.stimuli.push_back(make(each));
  for (const ExperimentStimulus& each : experiment.standards) made.standards.push_back(make(each));
  return made;
}

Result<const CheckedExperiment*> find_experiment(const CheckedModule& module, const std::string& name,
                                                 const std::string& file) {
  if (const CheckedExperiment* experiment = module.experiment(name)) return experiment;
  std::vector<std::string> candidates;
  for (const CheckedExperiment& each : module.experiments) candidates.push_back(each.name);
  const auto near = nearest_spelling(name, candidates);
  return Error{.code = Code::unknown_name,
               .sentence = name.empty() ? fmt::format("`{}` has no experiment", file)
                                        : fmt::format("`{}` has no experiment `{}`", file, name),
               .mend = near                 ? fmt::format("did you mean `{}`?", *near)
                       : candidates.empty() ? std::string("calibration/experiments has examples of them")
                                            : fmt::format("it has `{}`", fmt::join(candidates, "`, `")),
               .place = {.name = name.empty() ? "" : "--experiment", .text = name}};
}

}  // namespace wale
