#pragma once

#include <cstddef>
#include <span>

#include "calibration/analysis/least_squares.hpp"
#include "wale/result.hpp"

namespace wale {

/// One tick of a run along one axis: where the handle was, and the force that was commanded then.
struct HandleTick {
  double position = 0;  ///< m
  double force = 0;     ///< N at the handle once it arrives
};

/// The handle's own figures, fitted to its motion under known forces.
struct HandleFit {
  analysis::Coefficient mass;      ///< kg
  analysis::Coefficient damping;   ///< N s/m
  analysis::Coefficient friction;  ///< N, Coulomb
  analysis::Coefficient delay;     ///< s, from a position to the force that answers it; a slow actuator counts as later
  double deviation = 0;            ///< N, of the force that is not accounted for
  std::size_t windows = 0;         ///< how many stretches of the run were compared
};

/// Fits mass x'' + damping x' + friction sign(x') = force(t - delay) to a run. Positions are never differentiated
/// twice: both sides are weighted by smooth windows and integrated by parts, so that an encoder's steps do little.
/// Stretches in which the handle stands still are left out, because friction may then be anything.
///
/// Errors (W0802): a handle that hardly moved, or in too few stretches; figures that no handle has.
Result<HandleFit> fit_handle(std::span<const HandleTick> ticks, double tick_seconds);

}  // namespace wale
