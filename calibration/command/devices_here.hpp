#pragma once

#include <string>
#include <vector>

#include "compiler/text/resolver.hpp"
#include "schema/declared_device.hpp"

namespace wale::command {

/// The devices that a file in this folder would know, with imports looked for in `folders` and WALE_LIBRARY, and those
/// of `files` besides. Problems in their declarations are printed on standard error.
std::vector<DeclaredDevice> devices_here(const std::vector<std::string>& folders = {},
                                         const std::vector<ResolvedFile>& files = {});

}  // namespace wale::command
