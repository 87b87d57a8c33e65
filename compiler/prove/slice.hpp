#pragma once

#include <vector>

#include "compiler/prove/range_machine.hpp"

namespace wale {

/// The part of a program that its force depends on.
struct ForceSlice {
  std::vector<Instruction> setup, tick;         ///< in their order
  std::vector<std::vector<Instruction>> peaks;  ///< the code for the values of the peaks that are left
  /// quantities that are read and may change: inputs, states, then parameters
  std::vector<Quantity> quantities;
  /// The number of instructions without the points of peaks' lattices: the work of one evaluation over ranges.
  long instructions() const;
};

ForceSlice force_slice(const PatchProgram& program);

}  // namespace wale
