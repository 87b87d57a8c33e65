#pragma once

#include <string>
#include <vector>

#include "compiler/text/resolver.hpp"
#include "wale/declared_device.hpp"

namespace wale::command {

/// The devices that a file in the current folder knows, with imports from `folders` and WALE_LIBRARY, and the devices
/// of `files`. Prints errors in their declarations on standard error.
std::vector<DeclaredDevice> devices_here(const std::vector<std::string>& folders = {},
                                         const std::vector<ResolvedFile>& files = {});

}  // namespace wale::command
