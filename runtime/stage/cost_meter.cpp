#include "runtime/stage/cost_meter.hpp"

namespace wale {

std::optional<TickCosts> CostMeter::summary() const {
  if (!reads_clock_) return std::nullopt;
  TickCosts costs{.whole = whole_.summary(), .of = {}};
  for (std::size_t step = 0; step < TickCosts::steps; ++step) costs.of[step] = steps_[step].summary();
  return costs;
}

std::string_view name_of(TickCosts::Step step) {
  switch (step) {
    case TickCosts::sample: return "sample";
    case TickCosts::find: return "find";
    case TickCosts::program: return "program";
    case TickCosts::guard: return "guard";
    case TickCosts::command: return "command";
    case TickCosts::record: return "record";
    case TickCosts::steps: break;
  }
  return {};
}

}  // namespace wale
