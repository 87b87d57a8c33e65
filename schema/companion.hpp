#pragma once

#include <string>
#include <vector>

namespace wale {

/// Where to look for a program or a library that comes with Wale (`wale-keeper`, `wale-decoder`, `libwale_images.so`),
/// best first: where the installation has it, seen from the shared library that contains this code and from the running
/// program; in `libexec/wale` below the program; beside the program. Neither PATH nor the present folder is searched.
/// From any thread.
std::vector<std::string> companion_paths(const std::string& name);

}  // namespace wale
