#pragma once

#include <string>
#include <vector>

namespace wale {

/// The folders in which imports are looked for after the file's own and its project's: those given on the command line
/// and then those of the environment variable WALE_LIBRARY, separated by `:`. Empty ones count for nothing; `variable`
/// may be null.
std::vector<std::string> library_folders(std::vector<std::string> given, const char* variable);

}  // namespace wale
