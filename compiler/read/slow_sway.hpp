#pragma once

#include <optional>
#include <vector>

#include "compiler/read/slow_change.hpp"
#include "compiler/read/swing.hpp"

namespace wale {

/// A sway of few periods, and what is left without it.
struct PartedSway {
  double amplitude = 0;                  ///< N: the 99th percentile of the sway's size, where it is largest
  double frequency = 0;                  ///< Hz
  bool alone = false;                    ///< nothing comes or goes beside it
  std::optional<double> axis{};          ///< rad in [0, pi): as of `Swing`
  std::vector<std::vector<Force>> left;  ///< the forces without the sway, for each tick
};

/// What is slow in the forces on hands that hold still.
struct SlowParts {
  std::optional<PartedSway> sway;  ///< if one was parted from the rest
  SlowChange change;               ///< what comes or goes beside it
};

/// Parts a sway of few periods in the time of `felt` (`felt_at_rest`) from what comes or goes beside it, which no mean
/// over so few periods shows; tells its rate and size, also if a spectrum has shown none. It is the wave without which
/// the forces go the shortest way: what comes once goes its way once. A faster sway, and one beside a vibration, are
/// left as they are, and what comes is told by means.
SlowParts slow_parts(const Bank& bank, const std::vector<std::vector<Force>>& felt, Swing& sway,
                     const Swing& vibration);

}  // namespace wale
