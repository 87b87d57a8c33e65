#pragma once

#include "compiler/extract/force_field.hpp"
#include "compiler/extract/slow_force.hpp"

namespace wale {

/// Static forces at two scales: over the whole patch, and where its texture is strongest.
struct StaticForce {
  ForceField whole;  ///< without its mean and slope, if these matter
  LinearField slope;
  double largest = 0;     ///< N: about the 99th percentile of the whole force
  double bent = 0;        ///< N: the largest force without mean and slope
  glm::dvec2 busiest{0};  ///< where the force varies most, m from the patch's centre
  ForceField close;       ///< around `busiest`; empty if the force is the same everywhere
  SlowForce slow;         ///< of `whole`

  explicit StaticForce(const Bank& bank);
};

}  // namespace wale
