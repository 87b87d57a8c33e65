#pragma once

#include <array>
#include <vector>

#include "compiler/prove/interval.hpp"
#include "schema/patch_program.hpp"

namespace wale {

/// What a program may find before it runs: a box of inputs, parameters, states and what memories hold.
struct Domain {
  std::array<Interval, first_constant> inputs;  ///< by register; those that are reserved are zero
  std::vector<Interval> parameters;             ///< in the order of `PatchProgram::parameters`
  std::vector<Interval> states;                 ///< in the order of `PatchProgram::states`
  std::vector<Interval> cells;                  ///< of the memories, in the order of `PatchProgram::grids`

  Interval& operator[](Input input) { return inputs[static_cast<RegisterNumber>(input)]; }
  const Interval& operator[](Input input) const { return inputs[static_cast<RegisterNumber>(input)]; }
};

/// All that the runtime lets a program see: the hand within the device's envelope, parameters in their hard ranges,
/// states in their bounds, a patch of any size up to the workspace's diameter, with any rim that leaves a middle, and
/// any float for the probe.
Domain whole_domain(const PatchProgram& program);

/// The same at the program's own patch size and its parameters' defaults.
Domain domain_at_defaults(const PatchProgram& program);

}  // namespace wale
