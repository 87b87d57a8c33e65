#pragma once

#include "wale/program.hpp"

namespace wale {

/// J, how far the potential of a bank's force can reach at most: what a hand may be given that was brought to its
/// lowest point, and goes to the next.
///
/// Of a program whose force at rest goes by the hand's place alone that is worked out along lines of the patch, 32 each
/// way: between any two points lies a way along one line each way, and from a point to the next line half their
/// distance, on which the force is at most the bank's limit. A detail between two of 512 points of a line counts by
/// what is seen of it. Of what has states, memories, or goes by time, acceleration, the button or the place on the
/// workspace, it is the limit all the way across the patch: there the potential changes by more than the hand's place.
///
/// Allocates, and takes as long as 32768 ticks in a batch; for the thread that builds the bank.
double potential_range(const Bank& bank);

}  // namespace wale
