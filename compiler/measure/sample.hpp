#pragma once

#include <string>
#include <vector>

#include "wale/program.hpp"

namespace wale {

/// One hand of a trace, and what the program answers.
struct SampledHand {
  double time = 0;  ///< s
  Hand hand;        ///< m from the patch's centre, m/s
  Force force{0};   ///< N
};

/// Runs the program at each hand in turn, a tick each, with one memory: it enters when the hand comes inside, and
/// outside the patch nothing ticks or pushes. The patch is at the workspace's centre, time is that of the trace, and
/// accelerations and raw figures are the differences between one hand and the next over their times.
std::vector<SampledHand> sample(Bank bank, std::vector<SampledHand> hands);

/// A line a hand under a header with units, in the shortest digits that read back as the same numbers.
std::string samples_csv(const std::vector<SampledHand>& samples, bool vibrates = false);
/// An array of objects with t, x, y, vx, vy, fx, fy in SI units.
std::string samples_json(const std::vector<SampledHand>& samples, bool vibrates = false);

}  // namespace wale
