#pragma once

#include <string>
#include <vector>

#include "wale/program.hpp"

namespace wale {

/// One hand of a trace, and the program's force on it.
struct SampledHand {
  double time = 0;  ///< s
  Hand hand;        ///< m from the patch's centre, m/s
  Force force{0};   ///< N
};

/// Runs the program for each hand in turn, one tick each, with one memory. The program is entered when the hand comes
/// onto the patch; outside there are no ticks and no force. The patch is at the workspace's centre, and time is that of
/// the trace. Accelerations and raw figures are differences between successive hands over their times.
std::vector<SampledHand> sample(Bank bank, std::vector<SampledHand> hands);

/// Comma-separated values: a header with units, then one line per hand. Numbers have the fewest digits that preserve
/// them.
std::string samples_csv(const std::vector<SampledHand>& samples, bool vibrates = false);
/// JSON: an array of objects with t, x, y, vx, vy, fx, fy in SI units.
std::string samples_json(const std::vector<SampledHand>& samples, bool vibrates = false);

}  // namespace wale
