#pragma once

#include <vector>

#include "compiler/prove/domain.hpp"
#include "compiler/prove/look_up.hpp"
#include "wale/program.hpp"

namespace wale {

/// What is proved of a program, for all runs from one domain: in every section, in the order of its instructions, the
/// range of each result.
struct Proof {
  using Ranges = std::vector<ResultRanges>;

  Ranges setup, enter, tick, picture, frame;
  std::vector<Ranges> peaks, predictions;
  std::array<Interval, 2> force;      ///< x and y as commanded, N
  std::array<Interval, 2> unlimited;  ///< what the outputs' limits are given, N
  std::array<Interval, 2> ceiling;    ///< what they are limited by, N
  double bound_newton = 0;            ///< no |force| is larger, subnormals counting as zero

  /// Whether the limit of force x (0) or y (1) can change anything.
  bool limit_matters(std::size_t axis) const {
    return unlimited[axis].maybe_nan || unlimited[axis].largest() > ceiling[axis].low;
  }
};

/// Follows all sections of a program over ranges (`Interval`, `Enclosure`), in one pass each: a few microseconds for a
/// hundred instructions. Of the program nothing but what its file holds is used.
Proof prove(const Program& program, const Domain& domain);

/// For everything that the runtime lets a program see.
Proof prove(const Program& program);

}  // namespace wale
