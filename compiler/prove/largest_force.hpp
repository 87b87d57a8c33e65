#pragma once

#include <vector>

#include "compiler/prove/slice.hpp"
#include "wale/program.hpp"

namespace wale {

/// The largest force that a search found, with its hand and parameters.
struct LargestForce {
  double newton = 0;
  Hand hand;
  std::vector<float> parameters;  ///< in the order of `PatchProgram::parameters`
  PatchSize size;
  bool after_a_stroke = false;  ///< with memory written on the way, and not just after entering
};

/// Searches for the largest |force| over hands, parameters and patch sizes within `domain`: many starts in blocks of
/// lanes, then ever smaller steps around the best of them. Programs with memory are also stroked tick by tick. The
/// result is the same everywhere. The search stops at `enough` (N), the proved bound. It takes some milliseconds,
/// counted in instructions and not by a clock, and tries at least three choices of parameters.
LargestForce largest_force(const Program& program, const ForceSlice& slice, const Domain& domain, double enough);

}  // namespace wale
