#pragma once

#include <cstddef>
#include <vector>

#include "wale/program.hpp"

namespace wale {

/// The force that a program asks for where its device gives less, N along an axis.
struct CutForce {
  float asked = 0;  ///< the largest; 0 if the device gives all that is asked for
  float given = 0;  ///< by the device
};

/// Runs the program at this bank's parameters under hands at rest all over the patch, and under hands that move at up
/// to `speed` (m/s), and finds where its last limit cuts the force. A program that remembers is run as it begins.
/// Deterministic; microseconds if no limit can matter, otherwise a millisecond. A pad's program asks for no force.
CutForce cut_force(const Bank& bank, float speed);

/// The values of one parameter at which the device's limit cuts the force.
struct CutRange {
  bool above = false;  ///< from `value` to the end of the range; otherwise from its beginning to `value`
  float value = 0;     ///< SI, to a thousandth of the range
};

/// Searches the values of a parameter at which `cut_force` finds more than the device gives, with the other parameters
/// as they are: at most a range at either end. None if no value is cut, or all are.
std::vector<CutRange> cut_ranges(const Bank& bank, std::size_t parameter, float speed);

/// Whether a fate is that of the force that an author wrote.
inline bool is_of_force(const FateRecord& fate) { return !fate.percept && fate.name == "force"; }

/// The fate of the force that an author wrote: kept, or saturated where the device gives less than its formulas ask
/// for.
FateRecord fate_of_force(FateRecord force, const Bank& bank, float speed);

}  // namespace wale
