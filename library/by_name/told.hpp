#pragma once

#include <string>
#include <vector>

#include "compiler/diagnostics/diagnostic.hpp"
#include "wale/library.hpp"

namespace wale {

/// The warnings among `diagnostics`, in the order of their places.
std::vector<Error> warnings_in(Diagnostics& diagnostics, const SourceSet& sources);

/// The first error among `diagnostics`, with the others and the warnings.
Error first_error(Diagnostics& diagnostics, const SourceSet& sources);

/// The same in the words of the interface: what the compiler calls by an option of the command line has the name of the
/// library's option.
Error in_own_words(Error error);

/// The same about an argument instead of a place in a text.
Error about(Error error, const Place& argument);

/// "no percept is called `rougness`", with the three nearest of `known`. If none is near, the mend lists some.
Error unknown(Code code, const std::string& argument, const std::string& name, const std::vector<std::string>& known);

/// The error for a device that nothing declares, where the owner's devices.wale may declare it and has this problem.
Error with_owners_problem(Error error, const Error& problem);

}  // namespace wale
