#pragma once

#include <vector>

#include "compiler/prove/domain.hpp"
#include "compiler/prove/look_up.hpp"
#include "wale/program.hpp"

namespace wale {

/// The proved ranges of a program for all runs from one domain: for every section, the range of each result in the
/// order of its instructions.
struct Proof {
  using Ranges = std::vector<ResultRanges>;

  Ranges setup, enter, tick, picture, frame;
  std::vector<Ranges> peaks, predictions;
  std::array<Interval, 2> force;      ///< x and y as commanded, N
  std::array<Interval, 2> unlimited;  ///< the operands of the outputs' limits, N
  std::array<Interval, 2> ceiling;    ///< the ceilings of the outputs' limits, N
  double bound_newton = 0;            ///< no |force| is larger; subnormals count as zero

  /// Whether the limit of force x (0) or y (1) can change the force.
  bool limit_matters(std::size_t axis) const {
    return unlimited[axis].maybe_nan || unlimited[axis].largest() > ceiling[axis].low;
  }
};

/// Runs all sections of a program over ranges (`Interval`, `Enclosure`), in one pass each: a few microseconds for a
/// hundred instructions. It uses only what the program's file holds.
Proof prove(const Program& program, const Domain& domain);

/// The same for everything that the runtime allows.
Proof prove(const Program& program);

}  // namespace wale
