#include "calibration/feel/rehearsal.hpp"

#include <utility>

#include "calibration/feel/felt_report.hpp"

namespace wale {

double seconds_needed(const FeltDevice& felt, const BlindMaterial& material, double usual, double most_newton,
                      const std::atomic<bool>& stop) {
  const auto& [program, parameters] = material;
  Stage stage(*felt.device, {.max_force = most_newton});
  Result<Patch> patch = stage.add(program);
  if (!patch) return usual;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (!patch->set(program.description().parameters[i].name, parameters[i])) return usual;
  const auto result = stage.run({.seconds = usual, .virtual_time = true, .stop = &stop});
  if (!result) return usual;
  RunManner manner = felt.manner();
  manner.most = most_newton;
  const FeltReport report = felt_report(*patch->bank(), *result, program.description().device, std::move(manner));
  const double needed = report.needed_seconds.value_or(usual);
  return needed > usual && needed <= longest_proposed_run ? needed : usual;
}

}  // namespace wale
