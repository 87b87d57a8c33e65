#include "calibration/feel/own_force.hpp"

#include <cmath>
#include <vector>

#include "compiler/measure/rehearsal.hpp"

namespace wale {

std::optional<Felt> measured_of_program(const Bank& bank, const Record& record, const MeasureOptions& options) {
  if (options.vibrates || remembers(bank.program().description())) return std::nullopt;
  Record own = record;
  std::vector<Hand> hands;
  hands.reserve(own.ticks.size());
  for (const TickRecord& tick : own.ticks)
    hands.push_back({.position = tick.position, .velocity = tick.velocity, .time = tick.time});
  std::vector<Force> forces(hands.size());
  tick_all(bank, hands, forces);
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const bool pushes = own.ticks[i].inside && std::isfinite(forces[i].x) && std::isfinite(forces[i].y);
    own.ticks[i].force = pushes ? forces[i] : Force(0);
  }
  MeasureOptions at_once = options;
  at_once.bandwidth = {0, 0};
  return measure(own, at_once);
}

}  // namespace wale
