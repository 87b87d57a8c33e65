#pragma once

#include "wale/program.hpp"

namespace wale {

/// J, an upper bound of the range of a bank's potential, from its lowest to its highest point: the most energy that its
/// force can give a hand.
///
/// If the program's force at rest depends only on the hand's position, the range is integrated along lines of the
/// patch, 32 in each direction. A path along one line of each direction joins any two points, except for half the
/// lines' distance at each end, where the force is at most the bank's limit. Lines have 512 points; finer detail counts
/// as far as the points sample it. If the program has states or grids, or depends on time, acceleration, the button or
/// the workspace position, the potential also changes while the hand is at rest; then the range is the limit times the
/// patch's diagonal.
///
/// Allocates, and takes as long as 32768 ticks in a batch; for the thread that builds the bank.
double potential_range(const Bank& bank);

}  // namespace wale
