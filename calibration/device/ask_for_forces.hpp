#pragma once

#include <functional>
#include <iosfwd>
#include <span>
#include <vector>

#include "calibration/device/force_table.hpp"
#include "wale/result.hpp"

namespace wale {

/// One reading that is to be taken.
struct GaugeStep {
  Way way = Way::right;
  double command = 0;  ///< N
  int repeat = 1;
};

/// The readings of a whole calibration: for each way fourteen commands from none to `most`, N, upward in the first
/// round and downward in the second. Close together where a dead band ends.
std::vector<GaugeStep> force_steps(double most);

/// Asks a person for the reading of each step, in lines of text. `push` pushes for some seconds, and returns the
/// command that the motor took. An answer is a quantity with its unit, "2.31 N", after the first one also without.
/// `back` takes the answer before back and asks for it again, `again` pushes again, `skip` goes on with the next way,
/// and `q` or the end of the input ends: W0706. An answer that cannot be read is said, and asked for again.
Result<GaugeReadings> ask_for_forces(std::span<const GaugeStep> steps, std::istream& in, std::ostream& out,
                                     const std::function<Result<double>(const GaugeStep&)>& push);

}  // namespace wale
