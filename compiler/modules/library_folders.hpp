#pragma once

#include <string>
#include <vector>

namespace wale {

/// The folders that are searched for imports after the file's own folder and its project: those given on the command
/// line, then those of the environment variable WALE_LIBRARY, separated by `:`. `variable` is its value and may be
/// null. Empty names are ignored.
std::vector<std::string> library_folders(std::vector<std::string> given, const char* variable);

}  // namespace wale
