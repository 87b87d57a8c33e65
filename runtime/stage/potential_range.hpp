#pragma once

#include <atomic>
#include <optional>

#include "wale/program.hpp"

namespace wale {

/// J, an upper bound of the range of a bank's potential that costs nothing: the limit of its force times the patch's
/// diagonal.
double trivial_potential_range(const Bank& bank);

/// Whether sampling gives a lower bound than the trivial one: whether the program's force at rest depends only on the
/// hand's position. If it has states or grids, or depends on time, acceleration, the button or the workspace position,
/// the potential also changes while the hand is at rest.
bool has_sampled_range(const Program& program);

/// Whether its force depends on the edge of the patch's own shape. Then a sampled range holds for rectangles only.
bool reads_shape_edge(const Program& program);

/// J, an upper bound of the range of a bank's potential, from its lowest to its highest point: the most energy that its
/// force can give a hand.
///
/// The force is integrated along lines of the patch, 32 in each direction. A path along one line of each direction
/// joins any two points, except for half the lines' distance at each end, where the force is at most the bank's limit.
/// Lines have 512 points; finer detail counts as far as the points sample it. Lines on which the force is the same, bit
/// for bit, are computed once: those for which all that the tick computes without the position along the line, and then
/// joins with it, is equal. Without `has_sampled_range` it is the trivial bound.
///
/// The patch counts as a rectangle. Allocates, and takes as long as 32768 ticks in a batch if all lines differ; for a
/// thread that prepares banks. It runs on the calling thread alone. When `stop` becomes true, it gives nothing, within
/// the time of 512 ticks.
std::optional<double> potential_range(const Bank& bank, const std::atomic<bool>* stop);
double potential_range(const Bank& bank);

}  // namespace wale
