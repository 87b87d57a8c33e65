#include "compiler/prove/domain.hpp"

#include <limits>

#include "runtime/machine/inputs.hpp"

namespace wale {

Domain whole_domain(const PatchProgram& program) {
  const Envelope envelope(program.device);
  const auto either_way = [](float bound) { return Interval::between(-bound, bound); };
  Domain domain;
  for (const Input place : {Input::x, Input::y, Input::workspace_x, Input::workspace_y, Input::shape_edge}) {
    domain[place] = either_way(envelope.reach);
  }
  for (const Input speed : {Input::velocity_x, Input::velocity_y, Input::raw_velocity_x, Input::raw_velocity_y}) {
    domain[speed] = either_way(envelope.speed);
  }
  for (const Input acceleration :
       {Input::acceleration_x, Input::acceleration_y, Input::raw_acceleration_x, Input::raw_acceleration_y}) {
    domain[acceleration] = either_way(envelope.acceleration);
  }
  domain[Input::shape_edge_x] = domain[Input::shape_edge_y] = either_way(1);
  const float widest = static_cast<float>(program.device.widest_patch());
  domain[Input::patch_half_width] = domain[Input::patch_half_height] = Interval::between(0, 0.5f * widest);
  domain[Input::patch_rim] = Interval::between(0, 0.5f * widest);
  domain[Input::time] = Interval::between(0, std::numeric_limits<float>::max());
  domain[Input::button] = Interval::between(0, 1);
  domain[Input::probe] = Interval::everything(true);
  domain[Input::seconds_per_tick] = Interval::of(static_cast<float>(1 / program.device.rate));
  for (const Parameter& parameter : program.parameters) {
    domain.parameters.push_back(Interval::between(parameter.low, parameter.high));
  }
  for (const State& state : program.states) domain.states.push_back(Interval::between(state.low, state.high));
  for (const Grid& grid : program.grids) domain.cells.push_back(Interval::between(grid.low, grid.high));
  return domain;
}

Domain domain_at_defaults(const PatchProgram& program) {
  Domain domain = whole_domain(program);
  domain[Input::patch_half_width] = Interval::of(0.5f * program.patch_width);
  domain[Input::patch_half_height] = Interval::of(0.5f * program.patch_height);
  domain[Input::patch_rim] = Interval::of(program.patch_rim);
  domain[Input::shape_edge] = domain[Input::shape_edge_x] = domain[Input::shape_edge_y] =
      Interval::of(0);  // a rectangle
  for (std::size_t i = 0; i < program.parameters.size(); ++i) {
    domain.parameters[i] = Interval::of(program.parameters[i].value);
  }
  return domain;
}

Domain domain_of(const Bank& bank) {
  const PatchProgram& program = bank.program().description();
  Domain domain = domain_at_defaults(program);
  domain[Input::patch_half_width] = Interval::of(0.5f * bank.size().width);
  domain[Input::patch_half_height] = Interval::of(0.5f * bank.size().height);
  domain[Input::patch_rim] = Interval::of(bank.size().rim);
  for (std::size_t i = 0; i < program.parameters.size(); ++i)
    domain.parameters[i] = Interval::of(bank.registers()[program.first_parameter() + i]);
  return domain;
}

}  // namespace wale
