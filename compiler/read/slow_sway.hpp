#pragma once

#include <optional>
#include <vector>

#include "compiler/read/swing.hpp"

namespace wale {

/// A sway and what comes or goes beside it, parted.
struct PartedSway {
  double amplitude = 0;                  ///< N: the 99th percentile of the sway's size, where it is largest
  double frequency = 0;                  ///< Hz
  std::vector<std::vector<Force>> left;  ///< the forces without the sway, for each tick
  bool alone = false;                    ///< nothing comes or goes beside it: too little is left
};

/// Parts a sway of few periods in the time of `felt` (`felt_at_rest`) from what comes or goes beside it, which no mean
/// over so few periods shows. It is the wave without which the forces go the shortest way: what comes once goes its way
/// once. Nothing if the sway is faster, or if what is left goes to and fro.
std::optional<PartedSway> parted_from_sway(const Bank& bank, const std::vector<std::vector<Force>>& felt,
                                           const Swing& sway);

}  // namespace wale
