#pragma once

#include <vector>

#include "compiler/prove/range_machine.hpp"

namespace wale {

/// The part of a program that its force depends on.
struct ForceSlice {
  std::vector<Instruction> setup, tick;         ///< in their order
  std::vector<std::vector<Instruction>> peaks;  ///< of those peaks that are left, the code for their values
  std::vector<Quantity> quantities;             ///< that are read and may change: inputs, states, then parameters
  /// Instructions in all, each point of a peak's lattice left aside: the work of one evaluation over ranges.
  long instructions() const;
};

ForceSlice force_slice(const PatchProgram& program);

}  // namespace wale
