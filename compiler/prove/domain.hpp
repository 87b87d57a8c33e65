#pragma once

#include <array>
#include <vector>

#include "compiler/prove/interval.hpp"
#include "wale/patch_program.hpp"
#include "wale/program.hpp"

namespace wale {

/// The values that a program may start from: a box of inputs, parameters, states and memory cells.
struct Domain {
  std::array<Interval, first_constant> inputs;  ///< by register; reserved ones are zero
  std::vector<Interval> parameters;             ///< in the order of `PatchProgram::parameters`
  std::vector<Interval> states;                 ///< in the order of `PatchProgram::states`
  std::vector<Interval> cells;                  ///< of the memories, in the order of `PatchProgram::grids`

  Interval& operator[](Input input) { return inputs[static_cast<RegisterNumber>(input)]; }
  const Interval& operator[](Input input) const { return inputs[static_cast<RegisterNumber>(input)]; }
};

/// Everything that the runtime allows: the hand within the device's envelope, parameters in their hard ranges, states
/// in their bounds, a patch of any size up to the workspace's diameter with any rim that leaves a middle, and any float
/// for the probe.
Domain whole_domain(const PatchProgram& program);

/// The same at the program's own patch size and its parameters' defaults.
Domain domain_at_defaults(const PatchProgram& program);
/// The same with the bank's size and parameters.
Domain domain_of(const Bank& bank);

}  // namespace wale
