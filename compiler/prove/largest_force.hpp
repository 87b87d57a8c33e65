#pragma once

#include <vector>

#include "compiler/prove/slice.hpp"
#include "wale/program.hpp"

namespace wale {

/// The largest force that a search found, and where.
struct LargestForce {
  double newton = 0;
  Hand hand;
  std::vector<float> parameters;  ///< in the order of `PatchProgram::parameters`
  PatchSize size;
  bool after_a_stroke = false;  ///< with what the program remembered on the way, and not just after entering
};

/// Looks for the largest |force| over hands, parameters and patch sizes within `domain`: many starts by blocks of
/// lanes, then ever smaller steps around the best of them; programs that remember are also stroked tick by tick. The
/// same result everywhere. Ends where it has found `enough` (N): a search need not go on that has come to what is
/// proved. Some milliseconds, counted in instructions and not by a clock; three choices of parameters at least.
LargestForce largest_force(const Program& program, const ForceSlice& slice, const Domain& domain, double enough);

}  // namespace wale
