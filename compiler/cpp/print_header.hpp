#pragma once

#include <string>
#include <vector>

#include "wale/program.hpp"
#include "wale/result.hpp"

namespace wale {

/// What of a program stays adjustable in its header. Everything that depends on the rest only is computed when the
/// header is written.
struct LiveParts {
  std::vector<bool> parameters;  ///< by parameter; those beyond its end are not live
  bool size = false;             ///< of the patch

  bool any() const;
};

/// The parts with these names: parameters, `size` for the patch's size unless a parameter has that name, and `all`.
/// Error: W0801 for an unknown name, with the nearest.
Result<LiveParts> live_parts(const PatchProgram& program, const std::vector<std::string>& names);

/// A program as one C++17 header that needs no heap, no exceptions and no file of Wale: entering and the tick as
/// straight-line functions and, if something is live, setup. It gives the same bits as the machine, on any processor
/// with IEEE floats; the comment at its head says how to use it and what memory it needs.
///
/// Operations are written as in the column `meaning` of schema/include/wale/instruction.def. Pictures and predictions
/// are left out.
std::string print_header(const Program& program, const LiveParts& live);

}  // namespace wale
