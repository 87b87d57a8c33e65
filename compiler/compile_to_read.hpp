#pragma once

#include "compiler/compile.hpp"
#include "compiler/read/read_again.hpp"

namespace wale {

/// `compile_material`, for who reads the program next and asks only whether there are errors, as an index does: `first`
/// gets what was measured on the way, for `read_again`, and may bring what was kept of other programs. The program is the
/// same, to the bit. Warnings that need measurements of their own are left out: of jumps, of forces that are huge, none, or
/// drive the hand away, of fast rates and of undeclared energy.
std::optional<Program> compile_to_read(const CheckedModule& module, const std::string& name, const std::string& device,
                                       const SourceSet& sources, SourceId source, Resolver& resolver,
                                       Diagnostics& diagnostics, ReadFirst& first);

}  // namespace wale
